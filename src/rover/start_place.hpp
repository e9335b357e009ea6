#pragma once
/// Where a rover can start: a place that it can drive off from.

#include <optional>
#include <string>

#include "src/rover/rover.hpp"

namespace desert_sim {

/// Why a rover that is put there could not drive off; empty if it can. A copy of it stands there, and drives
/// some of its lengths ahead and, from the same place, back: nothing may stop it, and it may not slide where
/// it stands.
std::string start_problem(const Rover& rover, double x, double y, double yaw, const GroundSource& ground);

/// Rectangle of the terrain's frame in which a start is looked for [m].
struct StartArea {
  double x = 0, y = 0;  ///< its middle
  double width = 0, height = 0;
};

struct StartPlace {
  double x = 0, y = 0;  ///< [m]
  double room = 0;      ///< so far around it the ground is free [m]
};

/// The place nearest to the middle of the area from which the rover can drive off, on a raster whose spacing
/// is the rover's length. Around it the ground is known, dry, no steeper than 20 degrees and without
/// obstacles for ten lengths of the rover; where there is no such place, for one. None if there is none.
std::optional<StartPlace> nearest_start(const Rover& rover, const StartArea& area, double yaw,
                                        const GroundSource& ground);

/// Where a rover starts, and what there is to say about it.
struct Start {
  StartPlace place;
  std::string remark;   ///< empty: nothing
  bool is_bad = false;  ///< it may not be able to drive off
};

/// At (x, y), where one that is left out is that of the area's middle; where both are, at nearest_start().
Start choose_start(const Rover& rover, const StartArea& area, std::optional<double> x,
                   std::optional<double> y, double yaw, const GroundSource& ground);

}  // namespace desert_sim
