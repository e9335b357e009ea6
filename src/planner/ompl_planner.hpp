#pragma once
/// A free path by OMPL over HeadingCosts: positions in the plane, and a motion costs what the straight line
/// between them does in its direction. A path of the field, where it is given, is refined: OMPL's best path
/// is returned only if it costs less.

#include <cstdint>
#include <string>

#include "src/planner/heading_costs.hpp"

namespace desert_sim {

/// rrt_star: RRT*, whose costs may depend on the direction; bit_star, abit_star: informed trees, which find
/// good paths sooner on large terrains.
enum class OmplMethod : int { rrt_star, bit_star, abit_star };
constexpr const char* ompl_methods[] = {"rrt_star", "bit_star", "abit_star"};

struct OmplParameters {
  OmplMethod method = OmplMethod::bit_star;
  int evaluations = 20000;  ///< lines whose cost is computed, and rounds of the method, at which it ends
  double time_limit = 2;    ///< [s] of wall time, whatever comes first
  std::uint32_t seed = 1;   ///< of the process: what the first planner says holds
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
