#pragma once
/// Faster forms of the straight march, with the bits of Shadow (wind_shadow_march.hpp): four cells across the
/// march at a time, and all cells of a block, for the vectors of a CPU.

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

/// Wind shadow of the cells of a block, which have one direction: the four cells of its rows are vectors of a
/// CPU. Called for each block; no pieces of a march are skipped.
struct ShadowOfBlock {
  static constexpr int cells_of_a_call = side * side;
  Shadow shadow;  ///< its march_directions must not be null

  DESERT_HD void operator()(int column, int row) const {
    const Grid& g = shadow.grid();
    const MarchDirection c = shadow.march_directions[shadow.blocks.index(column, row)];
    const int x0 = side * column, y0 = side * row;
    if (is_far_from_edges(x0, g.width) && is_far_from_edges(y0, g.height)) {
      compute_shadow(c, g.index(x0, y0));
      return;
    }
    for (int y = y0; y < y0 + side && y < g.height; ++y)
      for (int x = x0; x < x0 + side && x < g.width; ++x)
        shadow.compute_shadow<MarchAxis::either, 1>(c, x, y);
  }

 private:
  /// Whether no march from the cells n … n + side − 1 of an axis reaches beyond its ends.
  DESERT_HD bool is_far_from_edges(int n, int cells) const {
    const int reach = shadow.steps + 1;
    return n >= reach && n + side <= cells - reach;
  }

  /// Calls body(row, k, cell) for each cell; `cell` is its index behind the south-western one.
  template <class Body>
  DESERT_HD static void for_each_cell_of_block(int width, const Body& body) {
    for (int row = 0; row < side; ++row) {
      DESERT_SIMD
      for (int k = 0; k < side; ++k) body(row, k, row * width + k);
    }
  }

  /// `first`: the south-western cell.
  DESERT_HD void compute_shadow(const MarchDirection& c, int first) const {
    const marching::Line line = c.line();
    const int width = shadow.grid().width, end = shadow.steps_of(c);
    const int along = line.step() * (line.along_x() ? 1 : width), across = line.along_x() ? width : 1;
    const float* const base = shadow.heights + first;
    float steepest[side][side] = {};
    if (line.is_oblique()) {
      const RiseOverFirstStep rise(line);
      for_each_cell_of_block(width, [&](int row, int k, int cell) DESERT_INLINE {
        steepest[row][k] =
            rise([&](int a, int b) DESERT_INLINE { return base[cell + (a * along + b * across)]; });
      });
    }
    for (int j = 1; j <= end; ++j) {
      const StepSample sample(j, line.drift, shadow.reciprocals);
      const float* const nearer = base + (j * along + sample.drifted * across);
      const float* const farther = nearer + across;
      for_each_cell_of_block(width, [&](int row, int k, int cell) DESERT_INLINE {
        steepest[row][k] = fast_max(steepest[row][k], sample.rise(base[cell], nearer[cell], farther[cell]));
      });
    }
    const ShadowFromSlope shadow_from_slope = shadow.shadow_from_slope;
    const float steps_per_cell = c.steps_per_cell;
    float* const to = shadow.wind_shadow + first;
    for_each_cell_of_block(width, [&](int row, int k, int cell) DESERT_INLINE {
      to[cell] = shadow_from_slope(steepest[row][k] * steps_per_cell);
    });
  }
};

}  // namespace desert_sim::wind_shadow
