#pragma once
/// Which species grows where, and plants as others see them. Not part of a step: computed for who asks
/// (Lifetime::on_request).
///
///   plants   1 + the species of the plant that is densest on the ground of a cell's centre, of equal ones
///   the
///            first in order; 0 where none is denser than `bare`
///
/// Reads bedrock, soil, sand and the plants; writes plants.

#include "kernels/backend/for_each.hpp"
#include "kernels/plants/density.hpp"
#include "kernels/plants/lookup.hpp"
#include "kernels/view/layer_values.hpp"

namespace desert_sim::plants {

/// Density below which a place counts as bare.
constexpr float bare = 0.02f;

struct MarkSpecies {
  Grid grid;
  Neighbourhood near;
  View plants;
  const SpeciesTraits* species;
  surface::SolidHeight height;
  float quantum;
  float* mark;

  DESERT_HD void operator()(int column, int row) const {
    const int i = grid.index(column, row);
    const float x = (static_cast<float>(column) + 0.5f) * grid.cell_size,
                y = (static_cast<float>(row) + 0.5f) * grid.cell_size;
    const Quanta z = height(i);
    float densest = bare;
    int found = 0;
    near.around(x, y, 0.0f, [&](int n) {
      const float dx = near.lookup.difference_x(x, plants.x[n]),
                  dy = near.lookup.difference_y(y, plants.y[n]);
      const SpeciesTraits& s = species[plants.species[n]];
      const float above = static_cast<float>(z - plants.z[n]) * quantum;
      const float d = density_at(dx * dx + dy * dy, above, plants.radius[n], s.stem, s.root);
      if (!(d > densest)) return;
      densest = d;
      found = 1 + plants.species[n];
    });
    mark[i] = static_cast<float>(found);
  }
};

/// For rows first … first + rows − 1, over the north edge.
template <class E>
void mark_species(E& exec, const TerrainView& t, int first, int rows, const Neighbourhood& near,
                  const View& plants, const SpeciesTraits* species) {
  for_each_cell_of_rows(
      exec, t.grid, first, rows,
      MarkSpecies{t.grid, near, plants, species, surface::SolidHeight(t), t.quantum, t.real(Layer::plants)});
}

/// A plant as it goes to the host.
struct Listed {
  float x, y;                     ///< [m] from the grid's south-west corner
  float z;                        ///< [m] where stem and root meet
  float radius;                   ///< [m]
  std::uint16_t species, health;  ///< health: 255 is full; no bytes lie between or behind that nobody writes
};

struct List {
  View plants;
  Metres metres;
  Listed* to;
  int first;
  DESERT_HD void operator()(int k) const {
    const int n = first + k;
    to[k] = {plants.x[n],
             plants.y[n],
             metres(plants.z[n]),
             plants.radius[n],
             static_cast<std::uint16_t>(plants.species[n]),
             static_cast<std::uint16_t>(255.0f * clamp(plants.health[n], 0.0f, 1.0f) + 0.5f)};
  }
};

/// Plants first … first + count − 1, in their order, to `to` on the device.
template <class E>
void list(E& exec, const View& plants, const Metres& metres, int first, int count, Listed* to) {
  for_each_item(exec, count, List{plants, metres, to, first});
}

}  // namespace desert_sim::plants
