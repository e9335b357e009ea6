#pragma once
/// What a brush paints later: its requests as entries of run.timeline, with the keys and defaults of the
/// commands' parameter tables.

#include <desert_sim/EditPlants.h>
#include <desert_sim/EditTerrain.h>

#include <string>

#include "src/rviz/brush.hpp"

namespace desert_sim {

/// `now`: the simulated time from which Brush::Later counts [s].
std::string timeline_entry(const Brush::Later& later, double now, const EditTerrain::Request& request);
std::string timeline_entry(const Brush::Later& later, double now, const EditPlants::Request& request);

}  // namespace desert_sim
