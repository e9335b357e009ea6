#pragma once
/// Edits for tests, and the small world that they are made in.

#include <functional>
#include <string>
#include <vector>

#include "test/support/world.hpp"

namespace desert_sim::test {

/// 20 × 16 cells of half a metre with the corner at (100, −50); two metres of sand on rock at 30 m, and
/// `more` steps.
std::string edit_world(const std::string& boundary, const std::string& more = "");

/// A metre of sand, added around the centre of the cell (x, y) of that world.
command::EditTerrain edit_at(int x, int y, BrushShape shape);

/// Each shape, turned and with a falloff where it has one, in the lower left part of that world.
std::vector<command::EditTerrain> one_of_each_shape();
/// The same edit elsewhere; distances in metres.
command::EditTerrain shifted(command::EditTerrain edit, double dx, double dy);
/// Turned by a quarter to the left around (x, y).
command::EditTerrain quarter_turned(command::EditTerrain edit, double x, double y);

/// Why the edit is refused; a failure if it is not, or if it changed something.
std::string refusal(Simulation& simulation, const command::EditTerrain& edit);

}  // namespace desert_sim::test
