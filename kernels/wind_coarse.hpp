#pragma once
/// The coarse grid on which the wind's transforms live: how it lies over the terrain, how values get there and back,
/// and the wavenumbers of its modes. See wind.hpp.

#include "desert_sim/kernels/fft.hpp"
#include "desert_sim/kernels/grid.hpp"
#include "desert_sim/kernels/math.hpp"

namespace desert_sim::wind {

/// The coarse grid of the transforms: `grid` cells cover the terrain, `width` × `height` values are
/// transformed (twice as many along an open axis, where the terrain is mirrored).
struct CoarseGrid {
  Grid fine;
  int columns = 0, rows = 0;
  int width = 0, height = 0;
  float ratio_x = 1, ratio_y = 1;  ///< fine cells a coarse cell
  float share_x = 1, share_y = 1;  ///< 1 / ratio

  DESERT_HD int mirrored_column(int x) const { return x < columns ? x : 2 * columns - 1 - x; }
  DESERT_HD int mirrored_row(int y) const { return y < rows ? y : 2 * rows - 1 - y; }
  DESERT_HD Grid transformed() const { return Grid{width, height, fine.cell_size * ratio_x, true, true}; }
};

/// Area-weighted mean of fine(i) over the fine cells under coarse cell (cx, cy).
template <class Fine>
DESERT_HD float coarse_mean(const CoarseGrid& c, int cx, int cy, const Fine& fine) {
  const float left = cx * c.ratio_x, right = (cx + 1) * c.ratio_x;
  const float bottom = cy * c.ratio_y, top = (cy + 1) * c.ratio_y;
  const int x_end = clamp_index(static_cast<int>(ceilf(right - 1e-4f)) - 1, c.fine.width);
  const int y_end = clamp_index(static_cast<int>(ceilf(top - 1e-4f)) - 1, c.fine.height);
  float sum = 0, area = 0;
  for (int y = static_cast<int>(bottom + 1e-4f); y <= y_end; ++y) {
    const float row_weight = minimum(top, y + 1.0f) - maximum(bottom, static_cast<float>(y));
    for (int x = static_cast<int>(left + 1e-4f); x <= x_end; ++x) {
      const float weight = row_weight * (minimum(right, x + 1.0f) - maximum(left, static_cast<float>(x)));
      sum += weight * fine(c.fine.index(x, y));
      area += weight;
    }
  }
  return sum / area;
}

/// Where a fine cell's centre lies between the centres of four coarse cells.
struct CoarseSample {
  int i00, i10, i01, i11;
  float fx, fy;

  DESERT_HD CoarseSample(const CoarseGrid& c, int x, int y) {
    const float px = (x + 0.5f) * c.share_x - 0.5f, py = (y + 0.5f) * c.share_y - 0.5f;
    const int x0 = static_cast<int>(floorf(px)), y0 = static_cast<int>(floorf(py));
    fx = px - x0;
    fy = py - y0;
    // At full resolution the sample is the value itself.
    if (c.columns == c.fine.width) fx = 0.0f;
    if (c.rows == c.fine.height) fy = 0.0f;
    const int xa = wrap(x0, c.width), xb = wrap(x0 + 1, c.width);
    const int ya = wrap(y0, c.height) * c.width, yb = wrap(y0 + 1, c.height) * c.width;
    i00 = ya + xa;
    i10 = ya + xb;
    i01 = yb + xa;
    i11 = yb + xb;
  }
  DESERT_HD Complex operator()(const Complex* v) const {
    const Complex a = v[i00], b = v[i10], c = v[i01], d = v[i11];
    return {lerp(lerp(a.re, b.re, fx), lerp(c.re, d.re, fx), fy),
            lerp(lerp(a.im, b.im, fx), lerp(c.im, d.im, fx), fy)};
  }
};

/// Wavenumbers of a mode [rad per fine cell], zero at the Nyquist rows.
struct Mode {
  float kx, ky;
  bool nyquist;

  DESERT_HD Mode(const CoarseGrid& c, int i, int j) {
    const int mx = 2 * i > c.width ? i - c.width : i, my = 2 * j > c.height ? j - c.height : j;
    nyquist = 2 * i == c.width || 2 * j == c.height;
    kx = 6.28318531f * mx / (c.width * c.ratio_x);
    ky = 6.28318531f * my / (c.height * c.ratio_y);
  }
};

/// The transfer of one radius along one axis, one pair a mode: the Gaussian, divided by what averaging over
/// cells and interpolating between the averages take away; and that times the derivative's sin(k)/l. It is
/// separable, so two short tables, made once on the host, hold all of it.
struct Transfer {
  float smooth, derive;
};

}  // namespace desert_sim::wind
