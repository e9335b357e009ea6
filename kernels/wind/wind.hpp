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

#include "kernels/backend/buffer.hpp"
#include "kernels/backend/fft.hpp"
#include "kernels/backend/for_each.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/math.hpp"
#include "kernels/field/surface.hpp"
#include "kernels/wind/coarse_wind.hpp"
#include "kernels/wind/surface_wind.hpp"
#include "kernels/wind/tuned/line_transform.hpp"
#include "kernels/wind/wind_turning.hpp"
#include "src/core/parameters.hpp"

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

/// Buffers and transforms of the coarse grid; none if neither warping nor projection needs them.
struct Workspace {
  CoarseGrid coarse;
  std::unique_ptr<Fft> one, all_radii;  ///< none if `by_lines`
  bool by_lines = false;                ///< transform_by_lines() instead of by the library
  LineTransform lines_along_x, lines_along_y;
  Buffer<Complex> roots_x, roots_y;  ///< of these
  Buffer<float> row_means, rise;
  Buffer<Complex> spectrum, turned, correction, gradients;
  Buffer<Transfer> along_x[ShortList::capacity], along_y[ShortList::capacity];  ///< of each radius
};

CoarseGrid coarse_grid(const Grid& fine, const WindParameters& p);
Workspace make_workspace(Exec& exec, const Grid& fine, const WindParameters& p);

/// What becomes of the coarse grid's values: means, [transform,] slopes [, back,] wind [, transform,]
/// correction [, back].
struct CoarseLaws {
  CoarsenColumns columns;
  SmoothedGradients gradients;  ///< of no radius without warping
  TurnWind turn;
  ProjectionCorrection correct;
  bool projected;
};
inline CoarseLaws coarse_laws(const TerrainView& t, const WindParameters& p, Vector above, float speed_above,
                              const SpeedUp& speed_up, const Workspace& work) {
  const CoarseGrid& coarse = work.coarse;
  Complex* const spectrum = work.spectrum.data();
  const int radius_count = p.warping ? p.radii.count : 0;
  CoarseLaws laws{{coarse, work.row_means.data(), t.quantum, work.rise.data(), spectrum},
                  {coarse, radius_count, spectrum, {}, {}, work.gradients.data()},
                  {coarse,
                   work.rise.data(),
                   above,
                   speed_above,
                   speed_up,
                   radius_count,
                   {},
                   {},
                   p.gradient_scale,
                   work.gradients.data(),
                   work.turned.data(),
                   spectrum},
                  {coarse, spectrum, 1.0f / static_cast<float>(coarse.values()), work.correction.data()},
                  p.projection};
  for (int r = 0; r < radius_count; ++r) {
    laws.gradients.along_x[r] = work.along_x[r].data();
    laws.gradients.along_y[r] = work.along_y[r].data();
    laws.turn.weights[r] = p.weights.values[r];
    laws.turn.deflections[r] = p.deflections.values[r];
  }
  return laws;
}

/// The wind's turning, and what corrects its divergence, from the means of the terrain's rows.
template <class E>
void transform_by_library(E& exec, const CoarseLaws& laws, Workspace& work) {
  const Grid grid = work.coarse.transformed();
  for_each_cell(exec, grid, laws.columns);
  if (laws.gradients.radius_count > 0) {
    work.one->forward(work.spectrum.data());
    for_each_cell(exec, laws.gradients.grid(), laws.gradients);
    work.all_radii->inverse(work.gradients.data());
  }
  for_each_cell(exec, grid, laws.turn);
  if (!laws.projected) return;
  work.one->forward(work.spectrum.data());
  for_each_cell(exec, grid, laws.correct);
  work.one->inverse(work.correction.data());
}
#if DESERT_WITH_CUDA
/// The same in one kernel; tuned/coarse_wind.cu.
void transform_by_lines(CudaExec& exec, const CoarseLaws& laws, Workspace& work);
#endif
/// A block of that kernel works on so many lines at a time,
constexpr int lines_at_once = 2;
/// and has in shared memory two places for each of them, of each radius, and the roots of unity of both axes.
inline std::size_t bytes_for_lines(const CoarseGrid& c, int radius_count) {
  const int longest = c.width > c.height ? c.width : c.height, fields = radius_count > 1 ? radius_count : 1;
  return sizeof(Complex) *
         static_cast<std::size_t>(2 * longest * lines_at_once * fields + c.width + c.height);
}

template <class E>
void coarsen_rows(E& exec, const CoarsenRows& law) {
  for_each_cell(exec, law.grid(), law);
}
#if DESERT_WITH_CUDA
/// The same by way of shared memory; tuned/coarsen_rows.cu.
void coarsen_rows(CudaExec& exec, const CoarsenRows& law);
#endif

template <class E>
void coarse_wind(E& exec, const CoarseLaws& laws, const surface::Heights& heights, float reference,
                 Workspace& work) {
  const CoarsenRows rows{work.coarse, heights.of_cells.data(), reference, work.row_means.data()};
  coarsen_rows(exec, rows);
  if (!laws.projected) work.correction.set_zero();
  if constexpr (!works_on_rows<E>)
    if (work.by_lines) return transform_by_lines(exec, laws, work);
  transform_by_library(exec, laws, work);
}

/// `reference`: the lowest solid surface of the terrain at load [quanta].
template <class E>
void step(E& exec, const TerrainView& t, const WindParameters& p, Vector above,
          const surface::Heights& heights, Quanta reference, const float* perturbation_x,
          const float* perturbation_y, Workspace& work) {
  const float speed_above = hypotenuse(above.x, above.y), lowest = static_cast<float>(reference);
  const SpeedUp speed_up{p.speedup, p.speedup_lowest, p.speedup_highest};
  const bool coarse_fields = p.warping || p.projection;
  if (coarse_fields)
    coarse_wind(exec, coarse_laws(t, p, above, speed_above, speed_up, work), heights, lowest, work);
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
