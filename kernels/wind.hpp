#pragma once
/// Wind at the surface from the wind high above. Paris 2019 §4, Nilles 2024 §3.3; physics.md A2–A5.
///
///   speed-up    u = w_a · clamp(1 + k_W (h − h_ref), low, high)
///   warping     f_R = lerp(u, k_R g⊥, α),  g = k_g ∇(h ⊗ Gauss(R/2)),  α = min(|g|, 1),  u·g⊥ ≥ 0
///               direction of Σ weight_R f_R / Σ weight_R, speed |u|
///   projection  û ← û − k (k·û)/|k|²   (divergence-free, mean kept)
///   features    + the divergence-free perturbation of wind_features.hpp
///
/// The Gaussians are tens of metres wide, so the smoothed terrain, the wind's turning by it and the
/// projection live on a grid coarsened to about a quarter of the smallest σ; the box average that coarsens
/// and the linear interpolation that samples back are undone in the transfer function. Each cell of the
/// terrain then has its own speed-up, the direction sampled from the coarse wind, and the sampled correction
/// of the projection. Open grids are extended evenly (mirrored) before the transform.
///
/// Reads the heights of the surface; writes wind_x, wind_y.

#include <memory>
#include <type_traits>

#include "desert_sim/core/parameters.hpp"
#include "desert_sim/kernels/buffer.hpp"
#include "desert_sim/kernels/fft.hpp"
#include "desert_sim/kernels/for_each.hpp"
#include "desert_sim/kernels/layers.hpp"
#include "desert_sim/kernels/math.hpp"
#include "desert_sim/kernels/surface.hpp"
#include "desert_sim/kernels/wind_coarse.hpp"
#include "desert_sim/kernels/wind_surface.hpp"

namespace desert_sim {

struct WindParameters {
  float speedup = 0.005f;
  float speedup_lowest = 0.5f;
  float speedup_highest = 3.0f;
  bool warping = true;
  ShortList radii{{200, 50, 0, 0}, 2};
  ShortList weights{{0.8f, 0.2f, 0, 0}, 2};
  ShortList deflections{{30, 5, 0, 0}, 2};
  float gradient_scale = 1.0f;
  bool projection = true;
  int coarsening = 0;
};

constexpr auto parameter_table(const WindParameters*) {
  using P = WindParameters;
  return std::make_tuple(
      parameter("speedup", &P::speedup, 0, 1, "1/m",
                "Speed-up of the wind per metre above the lowest ground (Venturi)."),
      parameter("speedup_lowest", &P::speedup_lowest, 0, 1, "1", "Least factor of the speed-up."),
      parameter("speedup_highest", &P::speedup_highest, 1, 10, "1", "Greatest factor of the speed-up."),
      parameter("warping", &P::warping, "Whether the terrain deflects the wind."),
      parameter("radii", &P::radii, 1, 5000, "m",
                "Radii of the smoothed terrains that deflect the wind; sigma is half of each."),
      parameter("weights", &P::weights, 0, 100, "1", "Weight of each radius."),
      parameter("deflections", &P::deflections, 0, 1000, "1", "Strength of deflection of each radius."),
      parameter("gradient_scale", &P::gradient_scale, 0, 10, "1",
                "Scale of the smoothed terrains' gradients; small values let wind reach obstacles."),
      parameter("projection", &P::projection, "Whether the wind is made free of divergence."),
      parameter("coarsening", &P::coarsening, 0, 64, "cells",
                "Cells of the terrain per cell of the FFT grid; 0 chooses a quarter of the smallest sigma."));
}
static_assert(table_is_complete<WindParameters>());

namespace wind {

/// Of several radii: spectra of ∂x H_R + i ∂y H_R, one behind the other, as rows of one tall grid. The
/// derivative is the central difference over two fine cells, i sin(k)/l.
struct SmoothedGradients {
  CoarseGrid coarse;
  int radius_count;
  const Complex* elevation;
  const Transfer *along_x[ShortList::capacity], *along_y[ShortList::capacity];
  Complex* out;

  DESERT_HD Grid grid() const { return Grid{coarse.width, coarse.height * radius_count, 1, true, true}; }
  DESERT_HD void operator()(int i, int row) const {
    const int r = row / coarse.height, j = row - r * coarse.height;
    const Complex h = elevation[j * coarse.width + i];
    const Transfer x = along_x[r][i], y = along_y[r][j];
    const float dx = x.derive * y.smooth, dy = x.smooth * y.derive;
    out[row * coarse.width + i] = {-dx * h.im - dy * h.re, dx * h.re - dy * h.im};  // (i dx − dy) h
  }
};

/// The wind above, turned by the smoothed terrain, and what wind there is near the ground of each coarse cell
/// less the wind above: a transform takes that exactly to 0 where there is none.
struct TurnWind {
  CoarseGrid coarse;
  const float* rise;
  Vector above;
  float speed_above;
  SpeedUp speed_up;
  int radius_count;  ///< 0: no warping
  float weights[ShortList::capacity], deflections[ShortList::capacity];
  float gradient_scale;
  const Complex* gradients;
  Complex *turned, *deviation;

  DESERT_HD void operator()(int x, int y) const {
    const int n = y * coarse.width + x;
    const int ground = coarse.mirrored_row(y) * coarse.width + coarse.mirrored_column(x);
    const float factor = speed_up(rise[n]);
    const float ux = above.x * factor, uy = above.y * factor;
    // Only the deviation from u is summed: where the ground is flat it is exactly 0, and the wind exactly u.
    float dx = 0, dy = 0, weight_sum = 0;
    for (int r = 0; r < radius_count; ++r) {
      const Complex gradient = gradients[r * coarse.values() + ground];
      const float gx = gradient_scale * gradient.re, gy = gradient_scale * gradient.im;
      const float pull = weights[r] * minimum(hypotenuse(gx, gy), 1.0f);
      const float sign = ux * -gy + uy * gx >= 0.0f ? deflections[r] : -deflections[r];
      dx += pull * (-gy * sign - ux);
      dy += pull * (gx * sign - uy);
      weight_sum += weights[r];
    }
    Complex wind{above.x, above.y};
    const float sx = ux * weight_sum + dx, sy = uy * weight_sum + dy, length = hypotenuse(sx, sy);
    if ((dx != 0.0f || dy != 0.0f) && length > 1e-12f)
      wind = {sx * speed_above / length, sy * speed_above / length};
    turned[n] = wind;
    deviation[n] = {wind.re * factor - above.x, wind.im * factor - above.y};
  }
};

/// Spectrum of what to add to the wind: −k (k·û)/|k|². The field u + iv is one complex transform; û and v̂ are
/// its parts of even and odd conjugate symmetry, so a mode needs its mirror mode too and writes to another
/// buffer.
struct ProjectionCorrection {
  CoarseGrid coarse;
  const Complex* field;
  float scale;  ///< 1 / number of values
  Complex* out;

  DESERT_HD void operator()(int i, int j) const {
    const int n = j * coarse.width + i;
    const int mirror = (j == 0 ? 0 : coarse.height - j) * coarse.width + (i == 0 ? 0 : coarse.width - i);
    const Complex z = field[n], m = field[mirror];
    const Complex u{0.5f * (z.re + m.re), 0.5f * (z.im - m.im)};
    const Complex v{0.5f * (z.im + m.im), 0.5f * (m.re - z.re)};
    const Mode k(coarse, i, j);
    const float k2 = k.kx * k.kx + k.ky * k.ky;
    Complex cu{0, 0}, cv{0, 0};
    if (k.nyquist) {
      cu = {-u.re * scale, -u.im * scale};
      cv = {-v.re * scale, -v.im * scale};
    } else if (k2 > 0.0f) {
      const float re = (k.kx * u.re + k.ky * v.re) * scale / k2,
                  im = (k.kx * u.im + k.ky * v.im) * scale / k2;
      cu = {-k.kx * re, -k.kx * im};
      cv = {-k.ky * re, -k.ky * im};
    }
    out[n] = {cu.re - cv.im, cu.im + cv.re};
  }
};

/// Buffers and transforms of the coarse grid; none if neither warping nor projection needs them.
struct Workspace {
  CoarseGrid coarse;
  std::unique_ptr<Fft> one, all_radii;
  Buffer<float> row_means, rise;
  Buffer<Complex> spectrum, turned, correction, gradients;
  Buffer<Transfer> along_x[ShortList::capacity], along_y[ShortList::capacity];  ///< of each radius
};

CoarseGrid coarse_grid(const Grid& fine, const WindParameters& p);
Workspace make_workspace(Exec& exec, const Grid& fine, const WindParameters& p);

/// The wind's turning, and what corrects its divergence, on the coarse grid.
template <class E>
void coarse_wind(E& exec, const TerrainView& t, const WindParameters& p, Vector above, float speed_above,
                 const SpeedUp& speed_up, const surface::Heights& heights, float reference, Workspace& work) {
  const CoarseGrid& coarse = work.coarse;
  Complex* spectrum = work.spectrum.data();
  const CoarsenRows rows{coarse, heights.of_cells.data(), reference, work.row_means.data()};
  for_each_cell(exec, rows.grid(), rows);
  for_each_cell(exec, coarse.transformed(),
                CoarsenColumns{coarse, work.row_means.data(), t.quantum, work.rise.data(), spectrum});
  TurnWind turn{coarse,
                work.rise.data(),
                above,
                speed_above,
                speed_up,
                p.warping ? p.radii.count : 0,
                {},
                {},
                p.gradient_scale,
                work.gradients.data(),
                work.turned.data(),
                spectrum};
  if (turn.radius_count > 0) {
    SmoothedGradients gradients{coarse, turn.radius_count, spectrum, {}, {}, work.gradients.data()};
    for (int r = 0; r < turn.radius_count; ++r) {
      gradients.along_x[r] = work.along_x[r].data();
      gradients.along_y[r] = work.along_y[r].data();
      turn.weights[r] = p.weights.values[r];
      turn.deflections[r] = p.deflections.values[r];
    }
    work.one->forward(spectrum);
    for_each_cell(exec, gradients.grid(), gradients);
    work.all_radii->inverse(work.gradients.data());
  }
  for_each_cell(exec, coarse.transformed(), turn);
  if (!p.projection) {
    work.correction.set_zero();
    return;
  }
  work.one->forward(spectrum);
  for_each_cell(exec, coarse.transformed(),
                ProjectionCorrection{coarse, spectrum, 1.0f / static_cast<float>(coarse.values()),
                                     work.correction.data()});
  work.one->inverse(work.correction.data());
}

/// `reference`: the lowest solid surface of the terrain at load [quanta].
template <class E>
void step(E& exec, const TerrainView& t, const WindParameters& p, Vector above,
          const surface::Heights& heights, Quanta reference, const float* perturbation_x,
          const float* perturbation_y, Workspace& work) {
  const float speed_above = hypotenuse(above.x, above.y), lowest = static_cast<float>(reference);
  const SpeedUp speed_up{p.speedup, p.speedup_lowest, p.speedup_highest};
  const bool coarse_fields = p.warping || p.projection;
  if (coarse_fields) coarse_wind(exec, t, p, above, speed_above, speed_up, heights, lowest, work);
  const auto run = [&](auto strip, auto is_perturbed) {
    const SurfaceWind<strip, is_perturbed> law{work.coarse,
                                               heights.of_cells.data(),
                                               lowest,
                                               t.quantum,
                                               above,
                                               speed_above > 0.0f ? 1.0f / (speed_above * speed_above) : 0.0f,
                                               speed_up,
                                               coarse_fields ? work.turned.data() : nullptr,
                                               coarse_fields ? work.correction.data() : nullptr,
                                               perturbation_x,
                                               perturbation_y,
                                               t.real(Layer::wind_x),
                                               t.real(Layer::wind_y)};
    for_each_cell(exec, law.strips(), law);
  };
  const auto run_strips = [&](auto strip) {
    perturbation_x ? run(strip, std::true_type()) : run(strip, std::false_type());
  };
  constexpr int many_cells = 1 << 22;  // that fill a GPU even in long strips
  if constexpr (works_on_rows<E>)
    run_strips(std::integral_constant<int, 1>());
  else if (t.grid.cells() >= many_cells)
    run_strips(std::integral_constant<int, 8>());
  else
    run_strips(std::integral_constant<int, 4>());
}

}  // namespace wind
}  // namespace desert_sim
