#pragma once
/// The laws between the transforms of the coarse grid: gradients of the smoothed terrains, the wind that they
/// deflect, and the correction that makes it divergence-free; equations in wind.hpp. Each law has a function
/// for a single value, and a call operator that loads and stores the value of a cell.

#include "kernels/wind/coarse_wind.hpp"
#include "kernels/wind/surface_wind.hpp"
#include "src/core/parameters.hpp"

namespace desert_sim::wind {

/// Spectra of ∂x H_R + i ∂y H_R of every radius R, with H_R the smoothed terrain, stacked as rows of one tall
/// grid. The derivative is the central difference over two fine cells, i sin(k)/l.
struct SmoothedGradients {
  CoarseGrid coarse;
  int radius_count;
  const Complex* elevation;
  const Transfer *along_x[ShortList::capacity], *along_y[ShortList::capacity];
  Complex* out;

  DESERT_HD Grid grid() const { return Grid{coarse.width, coarse.height * radius_count, 1, true, true}; }
  DESERT_HD void operator()(int i, int row) const {
    const int r = row / coarse.height, j = row - r * coarse.height;
    out[row * coarse.width + i] = of_mode(r, i, j, elevation[j * coarse.width + i]);
  }
  DESERT_HD Complex of_mode(int r, int i, int j, Complex h) const {
    const Transfer x = along_x[r][i], y = along_y[r][j];
    const float dx = x.derive * y.smooth, dy = x.smooth * y.derive;
    return {-dx * h.im - dy * h.re, dx * h.re - dy * h.im};  // (i dx − dy) h
  }
};

/// The high-altitude wind, deflected by the smoothed terrains, and the deviation of the wind at the ground of
/// each coarse cell from the high-altitude wind. The deviation is what is transformed, because a deviation of
/// 0 everywhere stays exactly 0.
struct WarpWind {
  CoarseGrid coarse;
  const float* rise;
  Vector above;
  float speed_above;
  SpeedUp speed_up;
  int radius_count;  ///< 0: no warping
  float weights[ShortList::capacity], deflections[ShortList::capacity];
  float gradient_scale;
  const Complex* gradients;
  Complex *warped_wind, *deviation;

  DESERT_HD void operator()(int x, int y) const {
    const int ground = coarse.mirrored_row(y) * coarse.width + coarse.mirrored_column(x);
    const Complex* of_ground = gradients + ground;
    const int values = coarse.values();
    const auto gradient = [of_ground, values](int r) { return of_ground[r * values]; };
    deviation[y * coarse.width + x] = warp_wind(x, y, gradient);
  }
  /// Writes `warped_wind` and returns the deviation. gradient_of(r): gradient of the r-th smoothed terrain.
  template <class Gradient>
  DESERT_HD Complex warp_wind(int x, int y, const Gradient& gradient_of) const {
    const int n = y * coarse.width + x;
    const float factor = speed_up(rise[n]);
    const float ux = above.x * factor, uy = above.y * factor;
    // Only the deviation from u is summed: where the ground is flat it is exactly 0, and the wind exactly u.
    float dx = 0, dy = 0, weight_sum = 0;
    for (int r = 0; r < radius_count; ++r) {
      const Complex gradient = gradient_of(r);
      const float gx = gradient_scale * gradient.re, gy = gradient_scale * gradient.im;
      const float pull = weights[r] * minimum(hypotenuse(gx, gy), 1.0f);
      const float sign = ux * -gy + uy * gx >= 0.0f ? deflections[r] : -deflections[r];
      dx += pull * (-gy * sign - ux);
      dy += pull * (gx * sign - uy);
      weight_sum += weights[r];
    }
    Complex wind{above.x, above.y};
    const float sx = ux * weight_sum + dx, sy = uy * weight_sum + dy, length = hypotenuse(sx, sy);
    if ((dx != 0.0f || dy != 0.0f) && length > 1e-12f) {
      const float stretch = speed_above / length;
      wind = {sx * stretch, sy * stretch};
    }
    warped_wind[n] = wind;
    return {wind.re * factor - above.x, wind.im * factor - above.y};
  }
};

/// Spectrum of the correction of the Helmholtz projection, −k (k·û)/|k|², which is added to the wind. The
/// field u + iv is one complex transform; û and v̂ are its parts of even and odd conjugate symmetry, so that
/// a mode also needs its mirror mode, and the result goes to another buffer.
struct ProjectionCorrection {
  CoarseGrid coarse;
  const Complex* field;
  float scale;  ///< 1 / number of values
  Complex* out;

  DESERT_HD void operator()(int i, int j) const {
    const int n = j * coarse.width + i;
    const int mirror = (j == 0 ? 0 : coarse.height - j) * coarse.width + (i == 0 ? 0 : coarse.width - i);
    out[n] = of_mode(i, j, field[n], field[mirror]);
  }
  DESERT_HD Complex of_mode(int i, int j, Complex z, Complex m) const {
    const Complex u{0.5f * (z.re + m.re), 0.5f * (z.im - m.im)};
    const Complex v{0.5f * (z.im + m.im), 0.5f * (m.re - z.re)};
    const Mode k(coarse, i, j);
    const float k2 = k.kx * k.kx + k.ky * k.ky;
    Complex cu{0, 0}, cv{0, 0};
    if (k.nyquist) {
      cu = {-u.re * scale, -u.im * scale};
      cv = {-v.re * scale, -v.im * scale};
    } else if (k2 > 0.0f) {
      const float share = scale / k2;
      const float re = (k.kx * u.re + k.ky * v.re) * share, im = (k.kx * u.im + k.ky * v.im) * share;
      cu = {-k.kx * re, -k.kx * im};
      cv = {-k.ky * re, -k.ky * im};
    }
    return {cu.re - cv.im, cu.im + cv.re};
  }
};

}  // namespace desert_sim::wind
