#pragma once
/// Water uptake of plants from the ground. Nilles 2025 §3.2.4, eq. 22–24.
///
///   volumes     V_stem = ⅔ π r³ h_s,   V_root = ⅔ π r³ h_r
///   required    W_req   = Δt φ_w V_stem
///   available   W_avail = min(Δt, t_d) M V_root,   M = min(moisture/(c_M d_M), 1)
///   capacity    W_cap   = w_c (V_stem + V_root)
///   uptake      W = min(W_avail, W_req + max(W_cap − stored, 0))
///   debit       `draw` · min(π r²/l², 1) · moisture · W/(M V_root)   from the cell's moisture
///
/// c_M and d_M are those of repose.hpp, t_d = 1 s. Volumes of water [m³] are counted as volumes of saturated
/// ground. The debit is in whole quanta (dice.hpp), and the ledger records it as outflow. Where the plants of
/// a cell request more than there is, each gets a part in proportion to its request, rounded down; the
/// requests are summed as integers, so that their order does not matter.
///
/// Plants live faster than in nature, and take up water as much faster: at a `draw` of 1/100 a closed cover
/// of bushes still takes up a rain of some 2 m an hour; at 1/10 no rain of the climates kept the ground
/// moist. Reads and writes moisture.

#include "kernels/backend/for_each.hpp"
#include "kernels/field/dice.hpp"
#include "kernels/field/ledger.hpp"
#include "kernels/plants/population.hpp"
#include "kernels/plants/site.hpp"
#include "src/core/constants.hpp"

namespace desert_sim::plants {

/// Water that a plant requires, can store, can reach, and takes up if its request is granted.
struct WaterDemand {
  /// Volumes [m³ of saturated ground].
  float required_water = 0, storage_capacity = 0, available_water = 0, wanted_water = 0;
  Quanta request = 0;  ///< requested from the cell's moisture
};

/// Time in which roots could take up all the water that they reach [s]. No parameter: the published equation
/// has Δt in its place, which longer steps would multiply beyond what there is.
constexpr float draining_time = 1.0f;

struct WaterUptake {
  Site site;
  const Quanta* moisture;
  float capacity, time_step, draw;  ///< capacity: of the deepest moist ground [m]
  Die die;

  WaterUptake(const TerrainView& t, const ReposeParameters& repose, const VegetationParameters& p,
              const float* heights, float dt, const Dice& dice)
      : site(t, repose, heights),
        moisture(t.quanta(Layer::moisture)),
        capacity(repose.moisture_capacity * repose.moisture_depth),
        time_step(dt),
        draw(p.draw),
        die(dice[Roll::water_uptake]) {}

  /// Of plant n.
  DESERT_HD WaterDemand water_demand(const SpeciesTraits& s, int n, float radius, float stored,
                                     int cell) const {
    const float volume = 2.0943951f * radius * radius * radius;
    const float roots = volume * s.root, stem = volume * s.stem;
    const float moisture_depth = static_cast<float>(value_or_zero(moisture, cell)) * site.quantum;
    const float saturation = minimum(moisture_depth / capacity, 1.0f);
    WaterDemand t;
    t.required_water = time_step * s.water_use * stem;
    t.storage_capacity = s.water_capacity * (stem + roots);
    t.available_water = minimum(time_step, draining_time) * saturation * roots;
    t.wanted_water =
        minimum(t.available_water, t.required_water + maximum(t.storage_capacity - stored, 0.0f));
    if (!(t.wanted_water > 0.0f) || !(draw > 0.0f)) return t;
    const float covered =
        minimum(static_cast<float>(pi) * radius * radius / (site.grid.cell_size * site.grid.cell_size), 1.0f);
    const float depth = draw * covered * moisture_depth * (t.wanted_water / (saturation * roots));
    t.request = die.whole_at_most(depth * site.quanta_per_metre, moisture[cell], n);
    return t;
  }
  /// What a plant gets [quanta] of its `request`; `water_requests`: sum over all plants of the cell.
  DESERT_HD Quanta granted(Quanta request, long long water_requests, int cell) const {
    if (request == 0 || water_requests <= moisture[cell]) return request;
    return static_cast<Quanta>(static_cast<long long>(request) * moisture[cell] / water_requests);
  }
};

/// Sums the requests of all plants of each cell.
struct SumRequests {
  WaterUptake water_uptake;
  View plants;
  const SpeciesTraits* species;
  long long* water_requests;

  DESERT_HD void operator()(int n) const {
    const int cell = water_uptake.site.cell(plants.x[n], plants.y[n]);
    const WaterDemand t =
        water_uptake.water_demand(species[plants.species[n]], n, plants.radius[n], plants.water[n], cell);
    if (t.request > 0) atomic_add(&water_requests[cell], static_cast<long long>(t.request));
  }
};

/// Removes the granted water from the moisture of the cells.
struct DebitMoisture {
  Site site;
  View plants;
  const Quanta* granted_water;
  Quanta* moisture;
  LedgerView ledger;

  DESERT_HD void operator()(int n) const {
    if (granted_water[n] == 0) return;
    const int cell = site.cell(plants.x[n], plants.y[n]);
    atomic_add(&moisture[cell], -granted_water[n]);
    ledger.book_out(Material::moisture, cell, granted_water[n]);
  }
};

}  // namespace desert_sim::plants
