#pragma once
/// The list of a scenario's sections. The section of a new process is added here.

#include "src/scenario/scenario.hpp"

namespace desert_sim {

struct SeedParameter {
  std::uint64_t seed = 1;
};
constexpr auto parameter_table(const SeedParameter*) {
  return std::make_tuple(
      parameter("seed", &SeedParameter::seed, 0, highest_uint64, "1", "Seed of all random numbers."));
}
static_assert(table_is_complete<SeedParameter>());

/// Calls visit(name, parameters) for each section that consists of one parameter table. The sections `wind`,
/// `water` and `run` also have lists, and `terrain` and `species` are lists; scenario.cpp reads these.
template <class S, class Visit>
void for_each_section(S& scenario, Visit&& visit) {
  visit("grid", scenario.grid);
  visit("wind_shadow", scenario.wind_shadow);
  visit("echo_dunes", scenario.echo_dunes);
  visit("sand", scenario.sand);
  visit("saltation", scenario.saltation);
  visit("shear_stress", scenario.shear_stress);
  visit("continuum", scenario.continuum);
  visit("abrasion", scenario.abrasion);
  visit("reptation", scenario.reptation);
  visit("looseness", scenario.looseness);
  visit("repose", scenario.repose);
  visit("avalanching", scenario.avalanching);
  visit("rain", scenario.rain);
  visit("hydraulic_erosion", scenario.hydraulic_erosion);
  visit("moisture", scenario.moisture);
  visit("soil", scenario.soil);
  visit("vegetation", scenario.vegetation);
  visit("traversability", scenario.traversability);
  visit("wheel_ground", scenario.wheel_ground);
}

/// The path of `file` in the scenario's folder if it exists there; otherwise `file` itself.
std::string raster_path(const Scenario& scenario, const std::string& file);

}  // namespace desert_sim
