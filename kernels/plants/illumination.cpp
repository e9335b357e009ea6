/// The laws and the step of illumination.hpp; compiled once for each backend.
#include "kernels/plants/illumination.hpp"

#include "kernels/backend/for_each.hpp"
#include "kernels/backend/loops.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/plants/workspace.hpp"
#include "src/core/elementary.hpp"

namespace desert_sim::plants {

/// Offsets from which light comes, and the weight of one quantum of rise there.
struct Rays {
  static constexpr int reach = 3, samples = 49, count = 24;
  int dx[count] = {}, dy[count] = {};
  float weight[count] = {};  ///< 0: unused entry

  Rays(float light_x, float light_y, float cell_size, float quantum) {
    int n = 0;
    for (int y = -reach; y <= reach; ++y)
      for (int x = -reach; x <= reach; ++x) {
        const float along = static_cast<float>(x) * light_x + static_cast<float>(y) * light_y;
        if (!(along > 1e-6f)) continue;
        const float distance = hypotenuse(static_cast<float>(x), static_cast<float>(y)) * cell_size;
        dx[n] = -x;
        dy[n] = -y;
        weight[n] = 2.0f * (cell_size * along) / (distance * distance) * (quantum / distance);
        ++n;
      }
  }
};

/// `inside`: the whole neighbourhood is on the grid.
template <bool inside>
struct Illuminate {
  Grid grid;
  Rays rays;
  const float *heights, *tops;  ///< [quanta]
  const Quanta* water;
  float quantum, light_decay;
  float *ground, *canopy;

  DESERT_HD float attenuated(float light, float depth) const {
    return depth > 0.0f ? light * exp_negative(light_decay * depth) : light;
  }

  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    const float low = heights[i], high = tops[i];
    float on_ground = 0.0f, on_canopy = 0.0f;
    unrolled<Rays::count>([&](auto n) DESERT_INLINE {
      const int at = inside ? i + rays.dy[n] * grid.width + rays.dx[n]
                            : sample_index(grid, x + rays.dx[n], y + rays.dy[n]);
      const float top = tops[at];
      on_ground += exp_negative(rays.weight[n] * fast_max(top - low, 0.0f));
      on_canopy += exp_negative(rays.weight[n] * fast_max(top - high, 0.0f));
    });
    constexpr float others = Rays::samples - Rays::count;
    const float depth = static_cast<float>(value_or_zero(water, i)) * quantum;
    const float cover = (high - low) * quantum;
    ground[i] = attenuated((on_ground + others) * (2.0f / Rays::samples) - 1.0f, depth);
    canopy[i] = attenuated((on_canopy + others) * (2.0f / Rays::samples) - 1.0f, depth - cover);
  }
};

template <class E>
void illuminate(E& exec, const TerrainView& t, const VegetationParameters& p, const surface::Heights& heights,
                const Workspace& work) {
  const elementary::UnitVector light = elementary::direction_deg(p.light_deg);
  const Illuminate<true> law{
      t.grid,
      Rays(static_cast<float>(light.x), static_cast<float>(light.y), t.grid.cell_size, t.quantum),
      heights.cell_heights.data(),
      work.tops.cell_heights.data(),
      t.quanta(Layer::water),
      t.quantum,
      p.light_decay,
      t.real(Layer::illumination),
      t.real(Layer::illumination_canopy)};
  const Illuminate<false> border{law.grid,    law.rays,        law.heights, law.tops,  law.water,
                                 law.quantum, law.light_decay, law.ground,  law.canopy};
  for_each_cell(exec, t.grid,
                Bordered<Illuminate<true>, Illuminate<false>>{t.grid, Rays::reach, law, border});
}

template void illuminate(Backend&, const TerrainView&, const VegetationParameters&, const surface::Heights&,
                         const Workspace&);

}  // namespace desert_sim::plants
