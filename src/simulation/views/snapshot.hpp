#pragma once
/// Layers at one moment, on the host.

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "kernels/field/layers.hpp"
#include "kernels/micro_relief/bumps.hpp"
#include "kernels/particles/wang.hpp"
#include "kernels/plants/marking.hpp"
#include "kernels/wind/wind.hpp"
#include "kernels/wind/wind_features.hpp"
#include "src/render/palette.hpp"
#include "src/scenario/species.hpp"
#include "src/simulation/views/staging.hpp"

namespace desert_sim {

/// Rows first … first + count − 1 of a terrain; all if count is 0. On a periodic one they go on over its
/// edges.
struct RowBand {
  int first = 0, count = 0;
};
/// The rows of a band that a terrain of `height` rows has.
RowBand clamp_band(const RowBand& band, int height, bool periodic_y);

/// What the micro-relief of the surface (micro_relief.hpp) depends on, besides layers.
struct MicroReliefSettings {
  MicroReliefParameters parameters;
  std::uint64_t seed = 1;
  RippleWind wind;
  float repose_tangent = 1;      ///< of bare sand
  float moisture_capacity = 1;   ///< of a metre of ground [m]
  float moisture_depth = 1;      ///< down to which ground holds it [m]
  float moisture_cutoff = 0.1f;  ///< relative moisture from which on sand stays where it is
  // Of the whole terrain, of which a snapshot may have a band of rows only:
  int grid_height = 0, first_row = 0;  ///< [cells]; the snapshot's row 0 is that row
  double origin_y = 0;                 ///< [m]
  bool periodic_y = true;
  bool plants_live = false;  ///< else the density of the layer says where they stand

  /// Whether heaps depend on the plants one by one.
  bool needs_feet() const { return plants_live && parameters.bumps; }
  /// The lattice of bumps on a terrain of so many columns, with cells of this size [m].
  micro_relief::Lattice bump_squares(int width, double cell_size, bool periodic_x) const {
    return micro_relief::Bumps::squares(parameters, width * cell_size, grid_height * cell_size, periodic_x,
                                        periodic_y);
  }
};

/// The widest plants of the squares of MicroReliefSettings::bump_squares(), from row `first_row` of these on
/// (kernels/micro_relief/plant_feet.hpp).
struct PlantFeet {
  int first_row = 0, rows = 0;
  std::vector<micro_relief::FootNumber> widest;
};

/// Layers at one moment, converted to floats in the layer's unit. Immutable once made; outlives the
/// simulation.
struct Snapshot {
  int width = 0, height = 0;
  double cell_size = 1, origin_x = 0, origin_y = 0;
  bool periodic_x = true, periodic_y = true;  ///< else open; a band of rows is open to north and south
  std::uint64_t step = 0;
  double time = 0;  ///< simulated [s]
  wind::Vector wind_above;
  std::vector<WindFeature> wind_features;  ///< of the scenario as it is now
  MicroReliefSettings micro_relief;
  std::vector<std::array<float, 3>> crown_colours;  ///< by species: of 1 in the layer plants, of 2 …
  render::Palette palette;                          ///< of everything else
  bool wind_arrows = false;                         ///< the scenario wants its wind to be seen
  std::map<Layer, std::vector<float>> layers;
  std::shared_ptr<const PlantFeet> feet;  ///< null unless they were asked for, and micro_relief needs them
  const std::vector<float>* find(Layer layer) const;  ///< null if it was not asked for
};

using PendingSnapshot = Pending<Snapshot>;

/// Plants at one moment, one by one.
struct PlantList {
  double origin_x = 0, origin_y = 0;  ///< [m] of the terrain's south-west corner
  std::uint64_t step = 0;
  double time = 0;               ///< simulated [s]
  std::vector<Species> species;  ///< of the scenario; none where plants are off
  std::vector<plants::PlantRecord> plants;
};

using PendingPlants = Pending<PlantList>;

/// The ways of some grains that the next step lifts, of the particle model (kernels/particles/wang.hpp).
struct ParticlePaths {
  double origin_x = 0, origin_y = 0;  ///< [m] of the terrain's south-west corner
  std::vector<std::vector<particles::PathPoint>> paths;
};

using PendingParticlePaths = Pending<ParticlePaths>;

}  // namespace desert_sim
