#pragma once
/// The commands of run.timeline: set_wind, set_wind_schedule, edit_wind, edit_terrain and edit_plants, with
/// the keys and defaults that the journal has (src/simulation/commands/command.hpp).
///
///     {time: 600, command: edit_terrain, layer: sand, x: 40, y: 50, radius: 6, value: 0.2}
///     {time: 900, command: set_wind_schedule, regime: rose, hold_time: 20, segments: [{direction_deg: 0},
///      {direction_deg: 90}]}

#include <optional>
#include <vector>

#include "src/scenario/scenario.hpp"
#include "src/simulation/commands/command.hpp"

namespace desert_sim {

/// The command of each entry of the scenario's timeline; none of those that set parameters. Throws
/// ConfigError that lists all which could never be applied, each with its entry: unknown commands and keys,
/// values out of range, points that make no shape, unknown species. Whether there are the layer, the cells
/// and the room that a command needs is asked when it is due.
std::vector<std::optional<Command>> read_timed_commands(const Scenario& scenario);

}  // namespace desert_sim
