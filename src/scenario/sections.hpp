#pragma once
/// Which sections a scenario has; the one place to add a process's.

#include "src/scenario/scenario.hpp"

namespace desert_sim {

struct SeedParameter {
  std::uint64_t seed = 1;
};
constexpr auto parameter_table(const SeedParameter*) {
  return std::make_tuple(
      parameter("seed", &SeedParameter::seed, 0, 1.8e19, "1", "Seed of everything random."));
}
static_assert(table_is_complete<SeedParameter>());

/// Calls visit(name, parameters) for each section that is one table; `wind`, `water` and `terrain` have lists
/// besides, and `species` is one.
template <class S, class Visit>
void for_each_section(S& scenario, Visit&& visit) {
  visit("grid", scenario.grid);
  visit("wind_shadow", scenario.wind_shadow);
  visit("echo_dunes", scenario.echo_dunes);
  visit("saltation", scenario.saltation);
  visit("abrasion", scenario.abrasion);
  visit("reptation", scenario.reptation);
  visit("repose", scenario.repose);
  visit("avalanching", scenario.avalanching);
  visit("rain", scenario.rain);
  visit("hydraulic_erosion", scenario.hydraulic_erosion);
  visit("moisture", scenario.moisture);
  visit("soil", scenario.soil);
  visit("vegetation", scenario.vegetation);
  visit("traversability", scenario.traversability);
}

/// `file` beside the scenario, if it is there; else as it is.
std::string raster_path(const Scenario& scenario, const std::string& file);

}  // namespace desert_sim
