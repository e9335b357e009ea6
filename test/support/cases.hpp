#pragma once
/// Scenarios that between them switch on everything: what the properties are held against.

#include <string>
#include <vector>

namespace desert_sim::test {

struct Case {
  std::string name, yaml;
};

/// `grid: {…}` of a size and a boundary ("periodic" or "open").
std::string grid_yaml(int width, int height, const std::string& boundary);

/// Everything but the grid: each reptation method, each avalanche scheme, soil, vegetation, obstacles,
/// abrasion, wet ground, echo dunes, influx, wind features. `transforms`: with warping and projection of the
/// wind.
std::vector<Case> process_cases(bool transforms);

}  // namespace desert_sim::test
