#pragma once
/// Wind at the surface from the wind high above. Paris 2019 §4, Nilles 2024 §3.3; physics.md A2–A5.
///
///   speed-up    u = w_a · clamp(1 + k_W (h − h_ref), low, high)
///   warping     f_R = lerp(u, k_R g⊥, α),  g = k_g ∇(h ⊗ Gauss(R/2)),  α = min(|g|, 1),  u·g⊥ ≥ 0
///               direction of Σ weight_R f_R / Σ weight_R, speed |u|
///   projection  û ← û − k (k·û)/|k|²   (divergence-free, mean kept)
///   features    + the divergence-free perturbation of wind_features.hpp
///
/// The Gaussians are tens of metres wide, so the smoothed terrain and the projection live on a grid coarsened
/// to about a quarter of the smallest σ; the box average that coarsens and the linear interpolation that
/// samples back are undone in the transfer function. Open grids are extended evenly (mirrored) before the
/// transform.
///
/// Reads elevation; writes wind_x, wind_y.

#include <memory>

#include "desert_sim/core/parameters.hpp"
#include "desert_sim/kernels/buffer.hpp"
#include "desert_sim/kernels/fft.hpp"
#include "desert_sim/kernels/for_each.hpp"
#include "desert_sim/kernels/layers.hpp"
#include "desert_sim/kernels/math.hpp"
#include "desert_sim/kernels/wind_coarse.hpp"

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

/// The wind high above the ground, now [m/s].
struct Vector {
  float x = 0, y = 0;
};

struct CoarsenElevation {
  CoarseGrid coarse;
  const Quanta* elevation;
  Quanta reference;
  float quantum;
  Complex* out;

  DESERT_HD void operator()(int x, int y) const {
    const Quanta *h = elevation, ref = reference;
    const float mean = coarse_mean(coarse, coarse.mirrored_column(x), coarse.mirrored_row(y),
                                   [h, ref](int i) { return static_cast<float>(h[i] - ref); });
    out[y * coarse.width + x] = {mean * quantum, 0.0f};
  }
};

/// Spectrum of ∂x H_R + i ∂y H_R: the derivative is the central difference over two fine cells, i sin(k)/l.
struct SmoothedGradient {
  CoarseGrid coarse;
  const Complex* elevation;
  const Transfer *along_x, *along_y;
  Complex* out;

  DESERT_HD void operator()(int i, int j) const {
    const int n = j * coarse.width + i;
    const Transfer x = along_x[i], y = along_y[j];
    const float dx = x.derive * y.smooth, dy = x.smooth * y.derive;
    const Complex h = elevation[n];
    out[n] = {-dx * h.im - dy * h.re, dx * h.re - dy * h.im};  // (i dx − dy) h
  }
};

struct WarpedWind {
  CoarseGrid coarse;
  const Quanta* elevation;
  Quanta reference;
  float quantum;
  Vector above;
  float speedup, lowest, highest;
  int radius_count;  ///< 0: no warping
  float weights[ShortList::capacity], deflections[ShortList::capacity];
  float gradient_scale;
  const Complex* gradients[ShortList::capacity];
  float *wind_x, *wind_y;

  DESERT_HD void operator()(int x, int y) const {
    const int i = coarse.fine.index(x, y);
    const float rise = static_cast<float>(elevation[i] - reference) * quantum;
    const float factor = clamp(1.0f + speedup * rise, lowest, highest);
    const float ux = above.x * factor, uy = above.y * factor;
    // Only the deviation from u is summed: where the ground is flat it is exactly 0, and the wind exactly u.
    float deviation_x = 0, deviation_y = 0, weight_sum = 0;
    if (radius_count > 0) {
      const CoarseSample sample(coarse, x, y);
      for (int r = 0; r < radius_count; ++r) {
        const Complex gradient = sample(gradients[r]);
        const float gx = gradient_scale * gradient.re, gy = gradient_scale * gradient.im;
        const float pull = weights[r] * minimum(hypotenuse(gx, gy), 1.0f);
        const float sign = ux * -gy + uy * gx >= 0.0f ? deflections[r] : -deflections[r];
        deviation_x += pull * (-gy * sign - ux);
        deviation_y += pull * (gx * sign - uy);
        weight_sum += weights[r];
      }
    }
    wind_x[i] = ux;
    wind_y[i] = uy;
    if (deviation_x == 0.0f && deviation_y == 0.0f) return;
    const float sx = ux * weight_sum + deviation_x, sy = uy * weight_sum + deviation_y;
    const float length = hypotenuse(sx, sy);
    if (!(length > 1e-12f)) return;
    const float keep_speed = hypotenuse(ux, uy) / length;
    wind_x[i] = sx * keep_speed;
    wind_y[i] = sy * keep_speed;
  }
};

/// The wind's deviation from the wind above, which a transform takes exactly to 0 where there is none.
struct CoarsenWind {
  CoarseGrid coarse;
  const float *wind_x, *wind_y;
  Vector above;
  Complex* out;

  DESERT_HD void operator()(int x, int y) const {
    const int cx = coarse.mirrored_column(x), cy = coarse.mirrored_row(y);
    const float *u = wind_x, *v = wind_y;
    const Vector w = above;
    out[y * coarse.width + x] = {coarse_mean(coarse, cx, cy, [u, w](int i) { return u[i] - w.x; }),
                                 coarse_mean(coarse, cx, cy, [v, w](int i) { return v[i] - w.y; })};
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

/// Adds the sampled correction and the perturbation of local features (null if there are none).
struct AddToWind {
  CoarseGrid coarse;
  const Complex* correction;
  const float *perturbation_x, *perturbation_y;
  float *wind_x, *wind_y;

  DESERT_HD void operator()(int x, int y) const {
    const int i = coarse.fine.index(x, y);
    float u = wind_x[i], v = wind_y[i];
    if (correction) {
      const Complex c = CoarseSample(coarse, x, y)(correction);
      u += c.re;
      v += c.im;
    }
    wind_x[i] = u + value_or_zero(perturbation_x, i);
    wind_y[i] = v + value_or_zero(perturbation_y, i);
  }
};

/// Buffers and transform of the coarse grid; none if neither warping nor projection needs them.
struct Workspace {
  CoarseGrid coarse;
  std::unique_ptr<Fft> fft;
  Buffer<Complex> spectrum, gradients[ShortList::capacity];
  Buffer<Transfer> along_x[ShortList::capacity], along_y[ShortList::capacity];  ///< of each radius
};

CoarseGrid coarse_grid(const Grid& fine, const WindParameters& p);
Workspace make_workspace(Exec& exec, const Grid& fine, const WindParameters& p);

/// `reference`: the lowest solid surface of the terrain at load [quanta].
template <class E>
void step(E& exec, const TerrainView& t, const WindParameters& p, Vector above, Quanta reference,
          const float* perturbation_x, const float* perturbation_y, Workspace& work) {
  const CoarseGrid& coarse = work.coarse;
  const Quanta* elevation = t.quanta(Layer::elevation);
  float *wind_x = t.real(Layer::wind_x), *wind_y = t.real(Layer::wind_y);
  const float scale = 1.0f / (static_cast<float>(coarse.width) * coarse.height);

  WarpedWind warp{coarse,
                  elevation,
                  reference,
                  t.quantum,
                  above,
                  p.speedup,
                  p.speedup_lowest,
                  p.speedup_highest,
                  0,
                  {},
                  {},
                  p.gradient_scale,
                  {},
                  wind_x,
                  wind_y};
  if (p.warping) {
    for_each_cell(exec, coarse.transformed(),
                  CoarsenElevation{coarse, elevation, reference, t.quantum, work.spectrum.data()});
    work.fft->forward(work.spectrum.data());
    warp.radius_count = p.radii.count;
    for (int r = 0; r < p.radii.count; ++r) {
      Complex* gradient = work.gradients[r].data();
      for_each_cell(exec, coarse.transformed(),
                    SmoothedGradient{coarse, work.spectrum.data(), work.along_x[r].data(),
                                     work.along_y[r].data(), gradient});
      work.fft->inverse(gradient);
      warp.gradients[r] = gradient;
      warp.weights[r] = p.weights.values[r];
      warp.deflections[r] = p.deflections.values[r];
    }
  }
  for_each_cell(exec, t.grid, warp);

  Complex* correction = nullptr;
  if (p.projection) {
    for_each_cell(exec, coarse.transformed(),
                  CoarsenWind{coarse, wind_x, wind_y, above, work.spectrum.data()});
    work.fft->forward(work.spectrum.data());
    correction = work.gradients[0].data();
    for_each_cell(exec, coarse.transformed(),
                  ProjectionCorrection{coarse, work.spectrum.data(), scale, correction});
    work.fft->inverse(correction);
  }
  if (correction || perturbation_x)
    for_each_cell(exec, t.grid,
                  AddToWind{coarse, correction, perturbation_x, perturbation_y, wind_x, wind_y});
}

}  // namespace wind
}  // namespace desert_sim
