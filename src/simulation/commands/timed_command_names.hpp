#pragma once
/// The commands that run.timeline takes, by name.

#include "src/simulation/commands/command.hpp"

namespace desert_sim {

constexpr const char* timed_command_names[] = {command::SetWind::name, command::SetWindSchedule::name,
                                               command::EditWind::name, command::EditTerrain::name,
                                               command::EditPlants::name};

}  // namespace desert_sim
