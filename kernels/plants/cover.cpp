/// The laws and the step of cover.hpp; compiled once for each backend.
#include "kernels/plants/cover.hpp"

#include "kernels/backend/for_each.hpp"
#include "kernels/backend/loops.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/plants/density.hpp"
#include "kernels/plants/workspace.hpp"

namespace desert_sim::plants {

struct Cover {
  static constexpr bool compact_warps = true;  // cells near each other see the same plants
  Grid grid;
  Neighbourhood near;
  const std::int32_t* kinds;  ///< the species of each plant
  const SpeciesTraits* species;
  int species_count;
  const float *heights, *wind_x, *wind_y;  ///< heights [quanta]
  float quantum, quanta_per_metre, time_step;
  Die humus_die;
  Quanta humus_limit;
  float *vegetation, *canopy_height;  ///< vegetation: null if it and humus are not to be written
  Quanta* humus;
  float *density, *downwind;

  struct Sums {
    float density = 0, canopy = 0, humus = 0;
    float of_species[max_species], downwind[max_species];
  };

  DESERT_HD void add(Sums& sums, int n, const Neighbour& plant, float x, float y, float height, float u,
                     float v) const {
    const float dx = near.lookup.difference_x(x, plant.x), dy = near.lookup.difference_y(y, plant.y);
    const float distance2 = dx * dx + dy * dy, radius = plant.radius;
    const int kind = kinds[n];
    const SpeciesTraits& s = species[kind];
    const float above = (height - static_cast<float>(plant.z)) * quantum;
    const float d = density_at(distance2, above, radius, s.stem, s.root);
    sums.density += d;
    sums.canopy = maximum(sums.canopy, radius * s.stem * d);
    sums.humus += s.humus * d;
    if (!is_mature(s, radius)) return;
    sums.of_species[kind] += d;
    const float distance = sqrtf(distance2), along = u * dx + v * dy;
    if (distance > 0.0f && along > 0.0f)
      sums.downwind[kind] += along / distance * maximum(1.0f - distance / s.max_radius, 0.0f);
  }

  DESERT_HD void operator()(int column, int row) const {
    const int i = grid.index(column, row);
    const float x = (static_cast<float>(column) + 0.5f) * grid.cell_size,
                y = (static_cast<float>(row) + 0.5f) * grid.cell_size;
    const float speed = hypotenuse(wind_x[i], wind_y[i]);
    const float u = speed > 1e-6f ? wind_x[i] / speed : 0.0f, v = speed > 1e-6f ? wind_y[i] / speed : 0.0f;
    const float height = heights[i];
    Sums sums;
    for (int k = 0; k < species_count; ++k) sums.of_species[k] = sums.downwind[k] = 0.0f;
    near.visit_near(x, y, 0.0f,
                    [&](int n, const Neighbour& plant) { add(sums, n, plant, x, y, height, u, v); });
    canopy_height[i] = sums.canopy;
    for (int k = 0; k < species_count; ++k) {
      density[k * static_cast<long long>(grid.cells()) + i] = sums.of_species[k];
      downwind[k * static_cast<long long>(grid.cells()) + i] = sums.downwind[k];
    }
    if (!vegetation) return;
    vegetation[i] = minimum(sums.density, 1.0f);
    const Quanta present = humus[i];
    const Quanta room = humus_limit > present ? humus_limit - present : 0;
    humus[i] = present > humus_limit
                   ? humus_limit
                   : present + humus_die.whole_at_most(time_step * sums.humus * quanta_per_metre, room, i);
  }
};

/// Heights of the canopy over one block's cells, and the greatest of them.
struct ComputeCanopyTops {
  Grid grid, blocks;
  const float *heights, *canopy_height;
  float quanta_per_metre;
  float *tops, *highest;

  DESERT_HD void operator()(int column, int row) const {
    constexpr int side = surface::block_side;
    float top = -static_cast<float>(wall_height);
    for (int y = side * row; y < side * row + side && y < grid.height; ++y)
      for (int x = side * column; x < side * column + side && x < grid.width; ++x) {
        const int i = grid.index(x, y);
        tops[i] = heights[i] + canopy_height[i] * quanta_per_metre;
        top = maximum(top, tops[i]);
      }
    highest[blocks.index(column, row)] = top;
  }
};

template <class E>
void cover(E& exec, const TerrainView& t, const VegetationParameters& p, const CoverInputs& in,
           const Dice& dice, Workspace& work) {
  const float* const heights = in.heights.cell_heights.data();
  for_each_cell(
      exec, t.grid,
      Cover{t.grid, work.neighbourhood(), work.plants().species, work.species.data(), work.species_count,
            heights, t.real(Layer::wind_x), t.real(Layer::wind_y), t.quantum, t.quanta_per_metre,
            in.time_step, dice[Roll::humus], to_quanta_at_most(p.humus_limit, t.quanta_per_metre, load_limit),
            in.makes_state ? t.real(Layer::vegetation) : nullptr, t.real(Layer::canopy_height),
            t.quanta(Layer::humus), work.density.data(), work.downwind.data()});
  for_each_cell(
      exec, work.tops.blocks,
      ComputeCanopyTops{t.grid, work.tops.blocks, heights, t.real(Layer::canopy_height), t.quanta_per_metre,
                        work.tops.cell_heights.data(), work.tops.highest.data()});
}

template void cover(Backend&, const TerrainView&, const VegetationParameters&, const CoverInputs&,
                    const Dice&, Workspace&);

}  // namespace desert_sim::plants
