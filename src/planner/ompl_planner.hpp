#pragma once
/// A free path by OMPL's RRT* over HeadingCosts: positions in the plane, and a motion costs what the straight
/// line between them does in its direction. A path of the field, where it is given, is refined: OMPL's best
/// path is returned only if it costs less.

#include <cstdint>
#include <string>

#include "src/planner/heading_costs.hpp"

namespace desert_sim {

struct OmplParameters {
  int evaluations =
      20000;  ///< after so many lines whose cost was computed it ends; the same number, the same path
  double time_limit = 2;   ///< [s] of wall time, whatever comes first
  std::uint32_t seed = 1;  ///< of the process: what the first planner says holds
};

struct OmplResult {
  GridPath path;        ///< empty if none was found
  double cost = 0;      ///< by HeadingCosts
  std::string problem;  ///< why there is none
};

/// From one passable point to another. `known`: a passable path, or an empty one.
OmplResult plan_with_ompl(const HeadingCosts& costs, const GridPoint& start, const GridPoint& goal,
                          const GridPath& known, const OmplParameters& parameters);

}  // namespace desert_sim
