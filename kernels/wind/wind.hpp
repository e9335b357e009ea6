#pragma once
/// Wind at the surface from the high-altitude wind w_a. Paris 2019 §4 and Nilles 2024 §3.3, eq. 1–3, for
/// speed-up and warping; Stam 1999 for the projection.
///
///   speed-up     u   = w_a · clamp(1 + k_W (h − h_ref), low, high)
///   warping      g   = k_g ∇(h ⊗ Gauss(σ = R/2)),   α = min(|g|, 1)
///                g⊥  = ±(−g_y, g_x),   with the sign that makes u·g⊥ ≥ 0
///                f_R = lerp(u, k_R g⊥, α)
///                direction of Σ weight_R f_R / Σ weight_R, speed |u|
///   projection   û ← û − k (k·û)/|k|²   (Helmholtz: divergence-free, with the mean kept)
///   features     + the divergence-free perturbation of wind_features.hpp
///
/// The Gaussians are tens of metres wide, so the smoothed terrain, the warped wind and the projection are
/// computed on a grid coarsened to about a quarter of the smallest σ. The spectral transfer function undoes
/// the attenuation of the box filter that coarsens and of the linear interpolation back. Each terrain cell
/// then has its own speed-up, the interpolated direction of the coarse wind and the interpolated correction
/// of the projection. Open axes are extended evenly (mirrored) before the transform.
///
/// Reads bedrock, soil and sand through `heights`, and the perturbation; writes wind_x, wind_y.

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

/// Buffers and transforms of the coarse grid; empty if neither warping nor projection needs them.
struct Workspace {
  CoarseGrid coarse;
  std::unique_ptr<Fft> fft_one_field, fft_all_radii;  ///< null if `by_lines`
  bool by_lines = false;  ///< use transform_by_lines() instead of transform_by_library()
  LineTransform lines_along_x, lines_along_y;
  Buffer<Complex> roots_x, roots_y;  ///< their roots of unity
  Buffer<float> row_means, rise;
  Buffer<Complex> spectrum, warped_wind, correction, gradients;
  Buffer<Transfer> along_x[ShortList::capacity], along_y[ShortList::capacity];  ///< of each radius

  std::size_t bytes() const;
};

CoarseGrid coarse_grid(const Grid& fine, const WindParameters& p);

Workspace make_workspace(Exec& exec, const Grid& fine, const WindParameters& p);

/// `above`: w_a; `reference`: h_ref, the lowest solid surface of the terrain at load [quanta];
/// `perturbation_x`, `perturbation_y`: of wind_features.hpp [m/s], or null.
template <class E>
void step(E& exec, const TerrainView& t, const WindParameters& p, Vector above,
          const surface::Heights& heights, Quanta reference, const float* perturbation_x,
          const float* perturbation_y, Workspace& work);

}  // namespace wind
}  // namespace desert_sim
