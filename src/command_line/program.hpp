#pragma once
/// What the main() of every program has in common.

#include <functional>

#include "src/command_line/options.hpp"

namespace desert_sim {

/// Reads the command line, prints what --help asks for or calls `body`, and returns the exit status of the
/// program: that of `body`, 2 for ConfigError, 3 for anything else that is thrown or if the standard output
/// could not be written. Errors are printed to stderr after the name of the program.
///
/// Before that, a program that was started without OMP_WAIT_POLICY and GOMP_SPINCOUNT is executed anew with
/// the values of launch/desert_sim.launch: threads that wait for others then soon leave the processor to
/// other programs. OpenMP reads these variables before main() begins.
int run_main(Options options, int argc, char** argv, const std::function<int(const Options&)>& body);

}  // namespace desert_sim
