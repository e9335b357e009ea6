#pragma once
/// Plants on a small terrain, for tests that run one of their steps at a time.

#include <vector>

#include "kernels/plants/cover.hpp"
#include "kernels/plants/density.hpp"
#include "kernels/plants/growth.hpp"
#include "kernels/plants/illumination.hpp"
#include "kernels/plants/life.hpp"
#include "kernels/plants/marking.hpp"
#include "kernels/plants/spawning.hpp"
#include "test/support/bench_terrain.hpp"

namespace desert_sim::test {

/// One plant on the host; positions in metres from the grid's corner and above the datum.
struct Plant {
  float x = 0, y = 0, z = 0, radius = 1, health = 1, water = 0, age = 0;
  int species = 0;
};

/// Ground that hinders nothing: flat deep soil, in full light. `capacity` 0: a plant a cell.
class PlantBench {
 public:
  PlantBench(Exec& exec, int width, int height, std::vector<SpeciesTraits> species, double cell_size = 1,
             bool periodic = true, int capacity = 0, std::vector<float> competition = {});

  BenchTerrain terrain;
  plants::Workspace work;
  VegetationParameters parameters;
  ReposeParameters repose;

  void put(const std::vector<Plant>& plants);
  std::vector<Plant> plants() const;  ///< in the order of the look-up

  void cover(float time_step = 1, bool makes_state = true);
  void illuminate();
  /// With light as illuminate() makes it; `lit`: full light everywhere instead.
  void live(float time_step = 1, std::uint64_t step = 0, std::uint64_t seed = 1, bool lit = true);
  /// A whole step: cover, light, life.
  void step(float time_step, std::uint64_t step);
};

/// A species that nothing hinders and that needs nothing.
SpeciesTraits undemanding();

}  // namespace desert_sim::test
