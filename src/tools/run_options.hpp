#pragma once
/// The command line of desert_run: its options by topic.

#include "src/command_line/options.hpp"

namespace desert_sim {

Options run_options();

}  // namespace desert_sim
