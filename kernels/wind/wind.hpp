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

#include "kernels/backend/buffer.hpp"
#include "kernels/backend/fft.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/surface.hpp"
#include "kernels/wind/coarse_wind.hpp"
#include "kernels/wind/surface_wind.hpp"
#include "kernels/wind/tuned/line_transform.hpp"
#include "kernels/wind/wind_parameters.hpp"

namespace desert_sim {

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

/// `reference`: the lowest solid surface of the terrain at load [quanta].
template <class E>
void step(E& exec, const TerrainView& t, const WindParameters& p, Vector above,
          const surface::Heights& heights, Quanta reference, const float* perturbation_x,
          const float* perturbation_y, Workspace& work);

}  // namespace wind
}  // namespace desert_sim
