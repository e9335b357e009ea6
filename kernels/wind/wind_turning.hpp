#pragma once
/// The laws between the transforms of the coarse grid: gradients of the smoothed terrains and the speed-up
/// over them, the wind that they deflect, its projection, and the mean; equations in wind.hpp. Each law has a
/// function for a single value, and a call operator that loads and stores the value of a cell.

#include "kernels/backend/atomics.hpp"
#include "kernels/wind/coarse_wind.hpp"
#include "kernels/wind/surface_wind.hpp"
#include "src/core/parameter_table.hpp"

namespace desert_sim::wind {

/// Spectra of ∂x H_R + i ∂y H_R of every radius R, with H_R the smoothed terrain, and of the speed-up s by
/// jackson_hunt, if `response` is not 0; stacked as rows of one tall grid. The derivative is the central
/// difference over two fine cells, i sin(k)/l.
struct TerrainResponse {
  CoarseGrid coarse;
  int radius_count;
  float response;  ///< of the speed-up, per rad/cell [cells/m]
  const Complex* elevation;
  const Transfer *along_x[ShortList::capacity], *along_y[ShortList::capacity];
  const FlowTransfer *flow_x, *flow_y;
  Complex* out;

  DESERT_HD int fields() const { return radius_count + (response > 0.0f ? 1 : 0); }
  DESERT_HD Grid grid() const { return Grid{coarse.width, coarse.height * fields(), 1, true, true}; }
  DESERT_HD void operator()(int i, int row) const {
    const int r = row / coarse.height, j = row - r * coarse.height;
    out[row * coarse.width + i] = of_mode(r, i, j, elevation[j * coarse.width + i]);
  }
  DESERT_HD Complex of_mode(int r, int i, int j, Complex h) const {
    if (r == radius_count) {
      const Mode k(coarse, i, j);
      const float s = response * hypotenuse(k.kx, k.ky) * (flow_x[i].terrain * flow_y[j].terrain);
      return {s * h.re, s * h.im};
    }
    const Transfer x = along_x[r][i], y = along_y[r][j];
    const float dx = x.derive * y.smooth, dy = x.smooth * y.derive;
    return {-dx * h.im - dy * h.re, dx * h.re - dy * h.im};  // (i dx − dy) h
  }
};

/// The high-altitude wind, deflected by the smoothed terrains; the factor by which each coarse cell speeds it
/// up; and the field to be projected. Winds are stored as deviations from the high-altitude wind, because a
/// deviation of 0 everywhere stays exactly 0.
struct WarpWind {
  CoarseGrid coarse;
  const float* rise;
  Vector above;
  float speed_above;
  SpeedUp speed_up;
  bool by_response;  ///< the speed-up is the last field of TerrainResponse, not that of `rise`
  int radius_count;  ///< 0: no warping
  float weights[ShortList::capacity], deflections[ShortList::capacity];
  float gradient_scale;
  const Complex* responses;
  Complex* warped;  ///< the deflected wind
  float* factors;   ///< of the speed-up
  Complex* unprojected;

  DESERT_HD void operator()(int x, int y) const {
    const int ground = coarse.mirrored_row(y) * coarse.width + coarse.mirrored_column(x);
    const Complex* of_ground = responses + ground;
    const int values = coarse.values();
    const auto response = [of_ground, values](int r) { return of_ground[r * values]; };
    unprojected[y * coarse.width + x] = warp_wind(x, y, response);
  }
  /// Writes `warped` and `factors`, and returns what is to be projected. response_of(r): gradient of the r-th
  /// smoothed terrain; after the last one, the speed-up.
  template <class Response>
  DESERT_HD Complex warp_wind(int x, int y, const Response& response_of) const {
    const int n = y * coarse.width + x;
    const float factor = by_response ? speed_up.of_response(response_of(radius_count).re) : speed_up(rise[n]);
    const float ux = above.x * factor, uy = above.y * factor;
    // Only the deviation from u is summed: where the ground is flat it is exactly 0, and the wind exactly u.
    float dx = 0, dy = 0, weight_sum = 0;
    for (int r = 0; r < radius_count; ++r) {
      const Complex gradient = response_of(r);
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
    warped[n] = {wind.re - above.x, wind.im - above.y};
    factors[n] = factor;
    const float projected = by_response ? 1.0f / factor : factor;
    return {wind.re * projected - above.x, wind.im * projected - above.y};
  }
};

/// Spectrum of the Helmholtz projection, û − k (k·û)/|k|², smoothed. The field u + iv is one complex
/// transform; û and v̂ are its parts of even and odd conjugate symmetry, so that a mode also needs its mirror
/// mode, and the result goes to another buffer.
struct Projection {
  CoarseGrid coarse;
  const Complex* field;
  float scale;  ///< 1 / number of values
  const FlowTransfer *flow_x, *flow_y;
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
    if (k.nyquist) return {0, 0};
    if (k2 <= 0.0f) return {z.re * scale, z.im * scale};
    // The part across k:
    const float share = scale * (flow_x[i].flux * flow_y[j].flux) / k2;
    const float re = (k.kx * v.re - k.ky * u.re) * share, im = (k.kx * v.im - k.ky * u.im) * share;
    return {-k.ky * re - k.kx * im, -k.ky * im + k.kx * re};
  }
};

/// Sums over the terrain from which the mean of the projected wind follows, in integers, so that the order of
/// additions does not matter: factor · (warped − flux), and the factor itself.
struct MeanWind {
  CoarseGrid coarse;
  const float* factors;
  const Complex *warped, *flux;
  long long* sums;  ///< three, 0 at first; null if the projection keeps the mean by itself

  struct Sums {
    long long x = 0, y = 0, factor = 0;
  };
  DESERT_HD static long long counted(float v) { return static_cast<long long>(v * 1048576.0f); }
  DESERT_HD void add(Sums& to, int n, Complex of_flux) const {
    const float factor = factors[n];
    to.x += counted(factor * (warped[n].re - of_flux.re));
    to.y += counted(factor * (warped[n].im - of_flux.im));
    to.factor += counted(factor);
  }
  DESERT_HD void book(const Sums& s) const {
    atomic_add(&sums[0], s.x);
    atomic_add(&sums[1], s.y);
    atomic_add(&sums[2], s.factor);
  }
  DESERT_HD Grid grid() const { return Grid{1, coarse.rows, 1, true, true}; }
  DESERT_HD void operator()(int, int y) const {
    Sums of_row;
    for (int n = y * coarse.width; n < y * coarse.width + coarse.columns; ++n) add(of_row, n, flux[n]);
    book(of_row);
  }
};

}  // namespace desert_sim::wind
