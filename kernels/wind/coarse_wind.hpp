#pragma once
/// The coarse grid on which the wind's transforms live: how it lies over the terrain, how values get there
/// and back, and the wavenumbers of its modes. See wind.hpp.

#include "kernels/backend/fft.hpp"
#include "kernels/field/grid.hpp"
#include "kernels/field/math.hpp"
#include "kernels/field/quanta.hpp"

namespace desert_sim::wind {

struct AxisPlace;

/// The coarse grid of the transforms: `grid` cells cover the terrain, `width` × `height` values are
/// transformed (twice as many along an open axis, where the terrain is mirrored).
struct CoarseGrid {
  Grid fine;
  int columns = 0, rows = 0;
  int width = 0, height = 0;
  float ratio_x = 1, ratio_y = 1;            ///< fine cells a coarse cell
  float share_x = 1, share_y = 1;            ///< 1 / ratio
  float wavenumber_x = 0, wavenumber_y = 0;  ///< of the first modes [rad per fine cell]

  DESERT_HD int mirrored_column(int x) const { return x < columns ? x : 2 * columns - 1 - x; }
  DESERT_HD int mirrored_row(int y) const { return y < rows ? y : 2 * rows - 1 - y; }
  DESERT_HD AxisPlace across(int x) const;
  DESERT_HD AxisPlace along(int y) const;
  DESERT_HD int values() const { return width * height; }
  DESERT_HD Grid transformed() const { return Grid{width, height, fine.cell_size * ratio_x, true, true}; }
};

/// Mean of value(i) over left … right [cells of an axis of n cells], by length. Of values that are all the
/// same it is exactly that value: uniform ground stays uniform.
template <class Value>
DESERT_HD float mean_over(float left, float right, int n, const Value& value) {
  const int first = static_cast<int>(left + 1e-4f);
  const int last = clamp_index(static_cast<int>(ceilf(right - 1e-4f)) - 1, n);
  const float base = value(first);
  float sum = 0, length = 0;
  const auto add = [&](int i, float share) {
    sum += share * (value(i) - base);
    length += share;
  };
  const auto overlap = [=](int i) { return minimum(right, i + 1.0f) - maximum(left, static_cast<float>(i)); };
  add(first, overlap(first));
  for (int i = first + 1; i < last; ++i) add(i, 1.0f);  // what overlap() gives there
  if (last > first) add(last, overlap(last));
  return base + sum / length;
}

/// Means of the surface along the rows of the terrain, `columns` a row. [quanta above `reference`]
struct CoarsenRows {
  CoarseGrid coarse;
  const float* heights;
  float reference;
  float* means;

  DESERT_HD Grid grid() const { return Grid{coarse.columns, coarse.fine.height, 1, true, true}; }
  DESERT_HD void operator()(int column, int y) const {
    const float* row = heights + coarse.fine.index(0, y);
    put_mean(column, y, [row](int x) { return row[x]; });
  }
  /// With the heights of row y from height(x).
  template <class Height>
  DESERT_HD void put_mean(int column, int y, const Height& height) const {
    const float ref = reference;
    means[y * coarse.columns + column] =
        mean_over(column * coarse.ratio_x, (column + 1) * coarse.ratio_x, coarse.fine.width,
                  [height, ref](int x) { return height(x) - ref; });
  }
};

/// Those means' means along the columns, on the grid of the transform.
struct CoarsenColumns {
  CoarseGrid coarse;
  const float* means;
  float quantum;
  float* rise;        ///< [m]
  Complex* spectrum;  ///< the same, for a transform

  DESERT_HD void operator()(int x, int y) const { spectrum[y * coarse.width + x] = {rise_at(x, y), 0.0f}; }
  /// Writes `rise`, and returns it.
  DESERT_HD float rise_at(int x, int y) const {
    const int row = coarse.mirrored_row(y), columns = coarse.columns;
    const float* column = means + coarse.mirrored_column(x);
    const float mean =
        quantum * mean_over(row * coarse.ratio_y, (row + 1) * coarse.ratio_y, coarse.fine.height,
                            [column, columns](int i) { return column[i * columns]; });
    rise[y * coarse.width + x] = mean;
    return mean;
  }
};

/// Where a fine cell lies along an axis between two coarse ones.
struct AxisPlace {
  int first, second;
  float share;  ///< of the second

  DESERT_HD AxisPlace(int cell, int coarse_cells, float coarse_a_cell) {
    const float place = (cell + 0.5f) * coarse_a_cell - 0.5f, before = floorf(place);
    share = place - before;  // at full resolution 0: the value itself
    first = wrap_once(static_cast<int>(before), coarse_cells);
    second = wrap_once(static_cast<int>(before) + 1, coarse_cells);
  }
};

DESERT_HD AxisPlace CoarseGrid::across(int x) const { return {x, width, share_x}; }
DESERT_HD AxisPlace CoarseGrid::along(int y) const { return {y, height, share_y}; }

/// A field of the coarse grid along a column of fine cells, between two coarse columns. Several cells in a
/// row lie between the same two coarse rows: what these have at the column is read once.
struct CoarseColumn {
  const Complex* field;
  AxisPlace across;
  int width;
  Complex south{0, 0}, north{0, 0};

  DESERT_HD CoarseColumn(const Complex* values, const AxisPlace& place_across, int row_width)
      : field(values), across(place_across), width(row_width) {}
  DESERT_HD void move_to(const AxisPlace& along) {
    south = in_row(along.first);
    north = in_row(along.second);
  }
  DESERT_HD Complex at(float share) const {
    return {lerp(south.re, north.re, share), lerp(south.im, north.im, share)};
  }

 private:
  DESERT_HD Complex in_row(int row) const {
    const Complex a = field[row * width + across.first], b = field[row * width + across.second];
    return {lerp(a.re, b.re, across.share), lerp(a.im, b.im, across.share)};
  }
};

/// Wavenumbers of a mode [rad per fine cell], zero at the Nyquist rows.
struct Mode {
  float kx, ky;
  bool nyquist;

  DESERT_HD Mode(const CoarseGrid& c, int i, int j) {
    const int mx = 2 * i > c.width ? i - c.width : i, my = 2 * j > c.height ? j - c.height : j;
    nyquist = 2 * i == c.width || 2 * j == c.height;
    kx = c.wavenumber_x * mx;
    ky = c.wavenumber_y * my;
  }
};

/// The transfer of one radius along one axis, one pair a mode: the Gaussian, divided by what averaging over
/// cells and interpolating between the averages take away; and that times the derivative's sin(k)/l. It is
/// separable, so two short tables, made once on the host, hold all of it.
struct Transfer {
  float smooth, derive;
};

}  // namespace desert_sim::wind
