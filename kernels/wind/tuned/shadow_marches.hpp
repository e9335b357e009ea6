#pragma once
/// Faster forms of the straight march, with the bits of Shadow (wind_shadow_march.hpp): four cells at a time
/// for GPUs, and short marches without branches, which a CPU works on as vectors.

#include "kernels/wind/wind_shadow_march.hpp"

namespace desert_sim::wind_shadow {

/// Wind shadow of four cells at a time; called for each group of four of each block.
struct ShadowOfFour {
  static constexpr bool compact_warps = true;
  Shadow shadow;

  DESERT_HD Grid fours() const { return {side * shadow.blocks.width, shadow.blocks.height, 1}; }
  DESERT_HD void operator()(int four, int row) const {
    const MarchDirection c = shadow.march_direction(four / side, row);
    c.line().along_x() ? compute_shadow<MarchAxis::along_x>(c, four, row)
                       : compute_shadow<MarchAxis::along_y>(c, four, row);
  }

 private:
  template <MarchAxis axis>
  DESERT_HD void compute_shadow(const MarchDirection& c, int four, int row) const {
    constexpr bool along_x = axis == MarchAxis::along_x;
    const int x = four / side * side + (along_x ? four % side : 0);
    const int y = row * side + (along_x ? 0 : four % side);
    constexpr int east = along_x ? 0 : 1, north = along_x ? 1 : 0;
    if (shadow.grid().inside(x + (side - 1) * east, y + (side - 1) * north)) {
      shadow.compute_shadow<axis, side>(c, x, y);
      return;
    }
    DESERT_NO_UNROLL
    for (int k = 0; k < side; ++k)
      if (shadow.grid().inside(x + k * east, y + k * north))
        shadow.compute_shadow<axis, 1>(c, x + k * east, y + k * north);
  }
};

/// Marches of at most `longest` steps, from cells farther than that from every edge. They have no branch, so
/// that a CPU vectorises them over cells (SIMD).
template <int longest>
struct ShortShadow {
  static constexpr int margin = longest + 1;
  Shadow shadow;  ///< its march_directions must not be null

  DESERT_HD void operator()(int x, int y) const {
    const MarchDirection c = shadow.march_directions[y / side * shadow.blocks.width + x / side];
    const int end = shadow.steps_of(c);
    const Shadow::CellGroup<MarchAxis::either, 1> cell(shadow, c.line(), x, y);
    float steepest[1];
    shadow.rise_over_one_cell<true>(cell, steepest);
    unrolled<longest>([&](auto n) DESERT_INLINE {
      float found[1] = {steepest[0]};
      shadow.sample_step<true>(cell, n + 1, found);
      steepest[0] = n + 1 <= end ? found[0] : steepest[0];
    });
    shadow.wind_shadow[cell.first] = shadow.shadow_from_slope(steepest[0] * c.steps_per_cell);
  }
};

}  // namespace desert_sim::wind_shadow
