#pragma once
/// The coarse grid on which the wind is transformed: its layout over the terrain, averaging onto it,
/// interpolation back, and the wavenumbers of its Fourier modes. Equations in wind.hpp.

#include "kernels/backend/fft.hpp"
#include "kernels/base/grid.hpp"
#include "kernels/base/math.hpp"
#include "kernels/base/quanta.hpp"

namespace desert_sim::wind {

struct AxisInterpolation;

/// The coarse grid: `columns` × `rows` cells cover the terrain, and `width` × `height` values are transformed
/// (twice as many along an open axis, where the terrain is mirrored).
struct CoarseGrid {
  Grid fine;
  int columns = 0, rows = 0;
  int width = 0, height = 0;
  float ratio_x = 1, ratio_y = 1;            ///< fine cells per coarse cell
  float share_x = 1, share_y = 1;            ///< 1 / ratio
  float wavenumber_x = 0, wavenumber_y = 0;  ///< of the first modes [rad per fine cell]

  DESERT_HD int mirrored_column(int x) const { return x < columns ? x : 2 * columns - 1 - x; }
  DESERT_HD int mirrored_row(int y) const { return y < rows ? y : 2 * rows - 1 - y; }
  DESERT_HD AxisInterpolation interpolation_x(int x) const;
  DESERT_HD AxisInterpolation interpolation_y(int y) const;
  DESERT_HD int values() const { return width * height; }
  /// Whether its cells are those of the terrain.
  bool is_full() const { return columns == fine.width && rows == fine.height; }
  DESERT_HD Grid transformed() const { return Grid{width, height, fine.cell_size * ratio_x, true, true}; }
};

/// Box filter: mean of value(i) over the interval left … right of an axis of n cells, weighted by overlap.
/// Equal values have exactly that mean, so that uniform ground stays uniform.
template <class Value>
DESERT_HD float box_mean(float left, float right, int n, const Value& value) {
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
  for (int i = first + 1; i < last; ++i) add(i, 1.0f);  // their overlap is 1
  if (last > first) add(last, overlap(last));
  return base + sum / length;
}

/// Box filter of the surface along the rows of the terrain: `columns` means a row [quanta above `reference`].
struct CoarsenRows {
  CoarseGrid coarse;
  const float* heights;
  float reference;
  float* means;

  DESERT_HD Grid grid() const { return Grid{coarse.columns, coarse.fine.height, 1, true, true}; }
  DESERT_HD void operator()(int column, int y) const {
    const float* row = heights + coarse.fine.index(0, y);
    store_mean(column, y, [row](int x) { return row[x]; });
  }
  /// Writes one mean of row y, whose heights are height(x).
  template <class Height>
  DESERT_HD void store_mean(int column, int y, const Height& height) const {
    const float ref = reference;
    means[y * coarse.columns + column] =
        box_mean(column * coarse.ratio_x, (column + 1) * coarse.ratio_x, coarse.fine.width,
                 [height, ref](int x) { return height(x) - ref; });
  }
};

/// Box filter along the columns of the row means; gives the values on the grid of the transform.
struct CoarsenColumns {
  CoarseGrid coarse;
  const float* means;
  float quantum;
  float* rise;        ///< [m]
  Complex* spectrum;  ///< the same, as input of the transform

  DESERT_HD void operator()(int x, int y) const { spectrum[y * coarse.width + x] = {rise_at(x, y), 0.0f}; }
  /// Computes one value of `rise`, writes and returns it.
  DESERT_HD float rise_at(int x, int y) const {
    const int row = coarse.mirrored_row(y), columns = coarse.columns;
    const float* column = means + coarse.mirrored_column(x);
    const float mean =
        quantum * box_mean(row * coarse.ratio_y, (row + 1) * coarse.ratio_y, coarse.fine.height,
                           [column, columns](int i) { return column[i * columns]; });
    rise[y * coarse.width + x] = mean;
    return mean;
  }
};

/// Position of a fine cell along an axis among the three nearest coarse cells, for interpolation by quadratic
/// B-splines. Their slopes are continuous: with linear interpolation dunes have the kinks of the coarse grid.
struct AxisInterpolation {
  int before, nearest, after;
  float of_before, of_after;  ///< weights; the nearest has the rest

  DESERT_HD AxisInterpolation(int cell, int coarse_cells, float coarse_per_cell) {
    const float position = (cell + 0.5f) * coarse_per_cell - 0.5f, middle = floorf(position + 0.5f);
    const float to_before = 0.5f - (position - middle), to_after = 0.5f + (position - middle);
    nearest = wrap_once(static_cast<int>(middle), coarse_cells);
    before = wrap_once(static_cast<int>(middle) - 1, coarse_cells);
    after = wrap_once(static_cast<int>(middle) + 1, coarse_cells);
    const bool full_resolution = coarse_per_cell >= 1.0f;  // then the value itself
    of_before = full_resolution ? 0.0f : 0.5f * to_before * to_before;
    of_after = full_resolution ? 0.0f : 0.5f * to_after * to_after;
  }

  /// Equal values give exactly that value.
  DESERT_HD float operator()(float first, float middle, float last) const {
    return middle + (of_before * (first - middle) + of_after * (last - middle));
  }
  DESERT_HD Complex operator()(Complex first, Complex middle, Complex last) const {
    return {(*this)(first.re, middle.re, last.re), (*this)(first.im, middle.im, last.im)};
  }
};

DESERT_HD AxisInterpolation CoarseGrid::interpolation_x(int x) const { return {x, width, share_x}; }
DESERT_HD AxisInterpolation CoarseGrid::interpolation_y(int y) const { return {y, height, share_y}; }

/// A coarse field, interpolated along a column of fine cells. Consecutive cells of the column lie among the
/// same three coarse rows, whose values are loaded once.
template <class Value>
struct CoarseColumn {
  const Value* field;
  AxisInterpolation interpolation_x;
  int width;
  Value south{}, middle{}, north{};

  DESERT_HD CoarseColumn(const Value* values, const AxisInterpolation& along_x, int row_width)
      : field(values), interpolation_x(along_x), width(row_width) {}
  DESERT_HD void move_to(const AxisInterpolation& along_y) {
    south = in_row(along_y.before);
    middle = in_row(along_y.nearest);
    north = in_row(along_y.after);
  }
  DESERT_HD Value at(const AxisInterpolation& along_y) const { return along_y(south, middle, north); }
  /// Interpolated along x in one coarse row.
  DESERT_HD Value in_row(int row) const {
    const Value* of_row = field + row * width;
    return interpolation_x(of_row[interpolation_x.before], of_row[interpolation_x.nearest],
                           of_row[interpolation_x.after]);
  }
};

/// The same from rows that were interpolated along x before (InterpolateRows).
template <class Value>
struct InterpolatedColumn {
  const Value* column;
  int width;
  Value south{}, middle{}, north{};

  DESERT_HD InterpolatedColumn(const Value* rows, int x, int row_width)
      : column(rows ? rows + x : nullptr), width(row_width) {}
  DESERT_HD void move_to(const AxisInterpolation& along_y) {
    south = column[along_y.before * width];
    middle = column[along_y.nearest * width];
    north = column[along_y.after * width];
  }
  DESERT_HD Value at(const AxisInterpolation& along_y) const { return along_y(south, middle, north); }
};

/// Wavenumbers of a Fourier mode [rad per fine cell]; `nyquist`: whether one of them is the Nyquist
/// wavenumber, whose sign is undefined, so that the mode is removed from the wind.
struct Mode {
  float kx, ky;
  bool nyquist;

  DESERT_HD Mode(const CoarseGrid& c, int i, int j) {
    const int mx = 2 * i > c.width ? i - c.width : i, my = 2 * j > c.height ? j - c.height : j;
    nyquist = ((2 * i == c.width) | (2 * j == c.height)) != 0;  // without a branch, for vectors
    kx = c.wavenumber_x * mx;
    ky = c.wavenumber_y * my;
  }
};

/// Spectral transfer function of one radius along one axis, one pair a mode. `smooth` is the Gaussian divided
/// by the attenuation of the box filter and of the interpolation back; `derive` is that times sin(k)/l
/// of the central difference. The function is separable, so two short tables, made once on the host, hold it.
struct Transfer {
  float smooth, derive;
};

/// Spectral transfer functions of the air flow along one axis: of the terrain that speeds it up, and of its
/// flux. Both are Gaussians; the first is divided by the same attenuation as Transfer::smooth.
struct FlowTransfer {
  float terrain, flux;
};

}  // namespace desert_sim::wind
