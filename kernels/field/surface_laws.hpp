#pragma once
/// Laws of surface.hpp.

#include "kernels/backend/buffer.hpp"
#include "kernels/backend/for_each.hpp"
#include "kernels/backend/vec4.hpp"
#include "kernels/base/math.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/surface.hpp"

namespace desert_sim::surface {

/// Height of a cell [quanta]. Reads bedrock, soil and sand. Without a layer of soil, sand is read in its
/// place and masked to 0, because a branch for each cell would keep CPUs from vectorising.
struct SolidHeight {
  const Quanta *bedrock, *sand, *soil;
  Quanta soil_bits;

  explicit SolidHeight(const TerrainView& t)
      : bedrock(t.quanta(Layer::bedrock)),
        sand(t.quanta(Layer::sand)),
        soil(t.quanta(Layer::soil) ? t.quanta(Layer::soil) : sand),
        soil_bits(t.quanta(Layer::soil) ? ~Quanta{0} : 0) {}
  DESERT_HD Quanta operator()(int i) const { return bedrock[i] + (soil[i] & soil_bits) + sand[i]; }
};

/// Ground and sand of four cells beside each other.
struct GroundAndSand {
  Vec4<Quanta> ground, sand;
};

/// Writes the heights of one block's cells, and the highest of them.
struct ComputeBlockHeights {
  Grid grid;
  const Quanta *bedrock, *soil, *sand;
  Grid blocks;
  float *heights, *highest;

  DESERT_HD void operator()(int column, int row) const {
    const int x0 = block_side * column, y0 = block_side * row;
    float top = -static_cast<float>(wall_height);
    for (int y = y0; y < y0 + block_side && y < grid.height; ++y) {
      if (grid.width % block_side == 0) {
        top = maximum(top, store_row(grid.index(x0, y), row_at(grid.index(x0, y))));
        continue;
      }
      for (int x = x0; x < x0 + block_side && x < grid.width; ++x)
        top = maximum(top, compute_height(grid.index(x, y)));
    }
    highest[blocks.index(column, row)] = top;
  }
  /// The same for a block whose cells all exist, on a grid whose width is a multiple of block_side. row_of(n)
  /// gives ground and sand of the nth of its rows.
  template <class RowOf>
  DESERT_HD void compute_complete_block(int column, int row, const RowOf& row_of) const {
    const int first = grid.index(block_side * column, block_side * row);
    float top = -static_cast<float>(wall_height);
    unrolled<block_side>(
        [&](auto n) DESERT_INLINE { top = maximum(top, store_row(first + n * grid.width, row_of(n))); });
    highest[blocks.index(column, row)] = top;
  }

 private:
  DESERT_HD GroundAndSand row_at(int first) const {
    GroundAndSand row{load_vec4(bedrock + first), load_vec4(sand + first)};
    if (soil) {
      const Vec4<Quanta> above = load_vec4(soil + first);
      for (int n = 0; n < 4; ++n) row.ground.values[n] += above.values[n];
    }
    return row;
  }
  DESERT_HD float store_row(int first, const GroundAndSand& row) const {
    Vec4<float> h;
    for (int n = 0; n < 4; ++n) h.values[n] = static_cast<float>(row.ground.values[n] + row.sand.values[n]);
    store_vec4(heights + first, h);
    return maximum(maximum(h.values[0], h.values[1]), maximum(h.values[2], h.values[3]));
  }
  DESERT_HD float compute_height(int i) const {
    return heights[i] = static_cast<float>(bedrock[i] + value_or_zero(soil, i) + sand[i]);
  }
};

/// The law that computes all of `heights`.
inline ComputeBlockHeights make_heights_law(const TerrainView& t, Heights& heights) {
  return {t.grid,         t.quanta(Layer::bedrock),    t.quanta(Layer::soil), t.quanta(Layer::sand),
          heights.blocks, heights.cell_heights.data(), heights.highest.data()};
}

}  // namespace desert_sim::surface
