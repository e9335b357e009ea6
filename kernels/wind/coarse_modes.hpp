#pragma once
/// The Fourier modes of a coarse grid along one of its axes, and how much of them averaging onto that grid
/// and interpolating back leaves. On the host: transfer functions are tabulated once.

#include <vector>

#include "kernels/backend/buffer.hpp"
#include "kernels/wind/coarse_wind.hpp"
#include "src/core/constants.hpp"
#include "src/core/elementary.hpp"

namespace desert_sim::wind {

/// The layout of a coarse grid of `columns` × `rows` cells over the terrain.
inline CoarseGrid coarse_grid_of(const Grid& fine, int columns, int rows) {
  CoarseGrid c;
  c.fine = fine;
  c.columns = columns;
  c.rows = rows;
  c.width = fine.periodic_x ? c.columns : 2 * c.columns;
  c.height = fine.periodic_y ? c.rows : 2 * c.rows;
  c.ratio_x = static_cast<float>(fine.width) / c.columns;
  c.ratio_y = static_cast<float>(fine.height) / c.rows;
  c.share_x = 1.0f / c.ratio_x;
  c.share_y = 1.0f / c.ratio_y;
  c.wavenumber_x = 2.0f * static_cast<float>(pi) / (c.width * c.ratio_x);
  c.wavenumber_y = 2.0f * static_cast<float>(pi) / (c.height * c.ratio_y);
  return c;
}

/// An axis of n modes of the transform, with `ratio` fine cells per coarse cell.
struct ModesOfAxis {
  int n;
  double ratio;

  bool nyquist(int i) const { return 2 * i == n; }
  double wavenumber(int i) const { return 2 * pi * (2 * i > n ? i - n : i) / (n * ratio); }  ///< [rad/cell]
  /// What the box filter and the interpolation back by quadratic B-splines leave of a mode.
  double kept(int i) const {
    if (ratio <= 1 || i == 0) return 1;
    const double half = 0.5 * wavenumber(i), box = elementary::sin(half * ratio) / (half * ratio);
    return elementary::sin(half * ratio) / (ratio * elementary::sin(half)) * box * box * box;
  }
  double gaussian(int i, double sigma) const {
    return elementary::exp(-0.5 * sigma * sigma * wavenumber(i) * wavenumber(i));
  }
};

template <class Value>
Buffer<Value> on_device(Exec& exec, const std::vector<Value>& table) {
  Buffer<Value> buffer(exec, table.size());
  buffer.upload(table);
  return buffer;
}

}  // namespace desert_sim::wind
