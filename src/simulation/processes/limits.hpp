#pragma once
/// What rows of processes check of their parameters: how far something reaches, and how many sub-steps a step
/// needs.

#include "src/core/validation_errors.hpp"
#include "src/scenario/scenario.hpp"

namespace desert_sim {

/// The fastest wind that the regime and the speed-up over hills can bring [m/s].
double fastest_wind(const Scenario& scenario);

/// A hop or a march may cross max_displacement cells at most: they are counted in 16.16 fixed point.
void check_reach(const Scenario& scenario, const char* key, double metres, ValidationErrors& errors);

/// A number of sub-steps of a step that is proportional to a parameter.
struct Substeps {
  const char* key;
  double value;
  const char* unit;
  double count;
  int most;
};
void check_substeps(const Scenario& scenario, const Substeps& substeps, ValidationErrors& errors);

/// A step may be 256 times as long as `interval`, which `key` gives [s].
void check_step_length(const Scenario& scenario, const char* key, double interval, ValidationErrors& errors);

}  // namespace desert_sim
