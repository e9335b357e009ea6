#pragma once
/// Water that plants draw from the ground. Nilles 2025 eq. 22–24; physics.md D.
///
///   needed     Δt φ_w V_stem;   roots reach Δt M V_root;   a plant stores up to capacity · (V_stem + V_root)
///   volumes    ⅔ π r³ times stem or root [m³];   M: moisture over the ground's capacity for it
///
/// Volumes of water are counted as soaked ground. What a plant takes is a share of the water about its roots;
/// the same share, times `draw` and how much of its cell the plant covers, leaves the moisture of its own
/// cell, in whole quanta, booked as out. Where the plants of a cell want more than there is, each gets in
/// proportion to its wish, rounded down: integers, whose order cannot matter.
///
/// Plants live faster than in nature, and drink as much faster: at a `draw` of 1/100 a closed cover of bushes
/// still takes what rain of some 2 m an hour brings; at 1/10 no rain of the climates kept the ground moist.
/// Reads moisture, soil, sand; writes moisture.

#include "kernels/backend/for_each.hpp"
#include "kernels/field/ledger.hpp"
#include "kernels/plants/population.hpp"
#include "kernels/plants/site.hpp"

namespace desert_sim::plants {

struct Thirst {
  float needed = 0, stored_most = 0, reachable = 0, wanted = 0;  ///< [m³ of soaked ground]
  Quanta wish = 0;                                               ///< to leave the cell
};

struct Drinking {
  Site site;
  const Quanta* moisture;
  float capacity, time_step, draw;

  Drinking(const TerrainView& t, const ReposeParameters& repose, const VegetationParameters& p,
           const float* heights, float dt)
      : site(t, repose, heights),
        moisture(t.quanta(Layer::moisture)),
        capacity(repose.moisture_capacity),
        time_step(dt),
        draw(p.draw) {}

  DESERT_HD Thirst thirst(const SpeciesTraits& s, float radius, float stored, int cell) const {
    const float volume = 2.0943951f * radius * radius * radius;
    const float roots = volume * s.root, stem = volume * s.stem;
    const float there = static_cast<float>(value_or_zero(moisture, cell)) * site.quantum;
    const float soaked = minimum(there / capacity, 1.0f);
    Thirst t;
    t.needed = time_step * s.water_use * stem;
    t.stored_most = s.water_capacity * (stem + roots);
    t.reachable = minimum(time_step, 1.0f) * soaked * roots;
    t.wanted = minimum(t.reachable, t.needed + maximum(t.stored_most - stored, 0.0f));
    if (!(t.wanted > 0.0f) || !(draw > 0.0f)) return t;
    const float covered =
        minimum(3.14159265f * radius * radius / (site.grid.cell_size * site.grid.cell_size), 1.0f);
    const float depth = draw * covered * there * (t.wanted / (soaked * roots));
    t.wish = take(depth, site.quanta_per_metre, moisture[cell]);
    if (t.wish == 0) t.wish = 1;  // what rounds to nothing would be free
    return t;
  }
  /// What a plant of a wish gets, if `wishes` are those of all plants of the cell.
  DESERT_HD Quanta granted(Quanta wish, long long wishes, int cell) const {
    if (wish == 0 || wishes <= moisture[cell]) return wish;
    return static_cast<Quanta>(static_cast<long long>(wish) * moisture[cell] / wishes);
  }
};

struct Wish {
  Drinking drinking;
  View plants;
  const SpeciesTraits* species;
  long long* wishes;

  DESERT_HD void operator()(int n) const {
    const int cell = drinking.site.cell(plants.x[n], plants.y[n]);
    const Thirst t = drinking.thirst(species[plants.species[n]], plants.radius[n], plants.water[n], cell);
    if (t.wish > 0) atomic_add(&wishes[cell], static_cast<long long>(t.wish));
  }
};

/// Takes what was granted out of the ground.
struct Drink {
  Site site;
  View plants;
  const Quanta* drunk;
  Quanta* moisture;
  LedgerView ledger;

  DESERT_HD void operator()(int n) const {
    if (drunk[n] == 0) return;
    const int cell = site.cell(plants.x[n], plants.y[n]);
    atomic_add(&moisture[cell], -drunk[n]);
    ledger.book_out(Material::moisture, cell, drunk[n]);
  }
};

}  // namespace desert_sim::plants
