#pragma once
/// The laws of surface.hpp, cell by cell.

#include "kernels/backend/buffer.hpp"
#include "kernels/backend/for_each.hpp"
#include "kernels/backend/vec4.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/math.hpp"
#include "kernels/field/surface.hpp"

namespace desert_sim::surface {

/// Of a cell [quanta]. Reads bedrock, soil, sand. Where there is no soil, it takes none of something else
/// instead of asking cell by cell, for which a CPU could not work on several at once.
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

/// Of four cells beside each other.
struct GroundAndSand {
  Four<Quanta> ground, sand;
};

/// The heights of one block's cells, and the highest of them.
struct MeasureBlock {
  Grid grid;
  const Quanta *bedrock, *soil, *sand;
  Grid blocks;
  float *heights, *highest;

  DESERT_HD void operator()(int column, int row) const {
    const int x0 = block_side * column, y0 = block_side * row;
    float top = -static_cast<float>(wall_height);
    for (int y = y0; y < y0 + block_side && y < grid.height; ++y) {
      if (grid.width % block_side == 0) {
        top = maximum(top, put_row(grid.index(x0, y), row_at(grid.index(x0, y))));
        continue;
      }
      for (int x = x0; x < x0 + block_side && x < grid.width; ++x)
        top = maximum(top, measure(grid.index(x, y)));
    }
    highest[blocks.index(column, row)] = top;
  }
  /// Likewise, of a block that is there as a whole, on a grid whose width is a multiple of block_side, with
  /// what row_of(n) knows of its nth row.
  template <class RowOf>
  DESERT_HD void measure_whole(int column, int row, const RowOf& row_of) const {
    const int first = grid.index(block_side * column, block_side * row);
    float top = -static_cast<float>(wall_height);
    unrolled<block_side>(
        [&](auto n) DESERT_INLINE { top = maximum(top, put_row(first + n * grid.width, row_of(n))); });
    highest[blocks.index(column, row)] = top;
  }

 private:
  DESERT_HD GroundAndSand row_at(int first) const {
    GroundAndSand row{four_at(bedrock + first), four_at(sand + first)};
    if (soil) {
      const Four<Quanta> above = four_at(soil + first);
      for (int n = 0; n < 4; ++n) row.ground.values[n] += above.values[n];
    }
    return row;
  }
  DESERT_HD float put_row(int first, const GroundAndSand& row) const {
    Four<float> h;
    for (int n = 0; n < 4; ++n) h.values[n] = static_cast<float>(row.ground.values[n] + row.sand.values[n]);
    put_four(heights + first, h);
    return maximum(maximum(h.values[0], h.values[1]), maximum(h.values[2], h.values[3]));
  }
  DESERT_HD float measure(int i) const {
    return heights[i] = static_cast<float>(bedrock[i] + value_or_zero(soil, i) + sand[i]);
  }
};

/// The law that measures all of `heights`.
inline MeasureBlock measuring(const TerrainView& t, Heights& heights) {
  return {t.grid,         t.quanta(Layer::bedrock), t.quanta(Layer::soil), t.quanta(Layer::sand),
          heights.blocks, heights.of_cells.data(),  heights.highest.data()};
}

}  // namespace desert_sim::surface
