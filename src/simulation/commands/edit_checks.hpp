#pragma once
/// What an edit must be before it is looked at any further.

#include "src/scenario/scenario.hpp"
#include "src/simulation/commands/command.hpp"
#include "src/terrain/terrain.hpp"

namespace desert_sim {

class ValidationErrors;

/// Throws ConfigError that names every parameter which is out of range, a layer that cannot be edited, points
/// and patches that do not make a shape.
void check_edit(const command::EditTerrain& edit);
/// Throws ConfigError if the terrain does not have the edit's layer.
void require_layer(const command::EditTerrain& edit, const Terrain& terrain);
/// Throws ConfigError if the edit is one of the density of still plants where plants live.
void require_still_plants(const command::EditTerrain& edit, const Scenario& scenario);

/// Adds an error if the points are not those of such a shape.
void check_points(BrushShape shape, const std::vector<command::Point>& points, ValidationErrors& errors);

}  // namespace desert_sim
