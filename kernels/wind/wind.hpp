#pragma once
/// Wind at the surface from the high-altitude wind w_a. Jackson & Hunt 1975 for the speed-up over hills,
/// Paris 2019 §4 and Nilles 2024 §3.3, eq. 1–3, for Venturi's and for warping; Stam 1999 for the projection.
///
///   warping      g   = k_g ∇(h ⊗ Gauss(σ = R/2)),   α = min(|g|, 1)
///                g⊥  = ±(−g_y, g_x),   with the sign that makes u·g⊥ ≥ 0,   u = f w_a
///                f_R = lerp(u, k_R g⊥, α)
///                w   has the direction of Σ weight_R f_R / Σ weight_R and the speed |w_a|
///   speed-up     f   = 1 + s/√(1 + (s/s_max)²), ŝ = a |k| ĥ (jackson_hunt)
///                or clamp(1 + k_W (h − h_ref), …) (venturi)
///   projection   F   = P[w/f] + c (jackson_hunt)   or   P[w f] (venturi),   P[û] = û − k (k·û)/|k|²
///   wind         u   = f F (jackson_hunt)   or   F (venturi);   without projection f w, with f of venturi
///   features     + the divergence-free perturbation of wind_features.hpp
///
/// jackson_hunt: air that crosses a crest passes in a thinner layer, of thickness D = 1/f. What is free of
/// divergence is therefore the flux D u of the layer, not u: a wind that is free of divergence by itself
/// cannot be faster over a long crest across it. To first order in the slope, D u without divergence is
/// potential flow for a = 1, whose speed-up along the wind is (k_x²/|k|) ĥ; the inner layer of Jackson &
/// Hunt multiplies it by a = `speedup_response`. With a = 2.13 the wind at the crest of a Gaussian ridge H
/// high, with the half length L at half its height, is faster by 2 H/L, at that of a round hill by 1.6 H/L;
/// across an oblique ridge only the component across it is. f tends to response_lowest and response_highest,
/// 1 ± s_max, because the law is one for small slopes: over dunes as steep as they get it would say twice the
/// wind, and the wind shadow slows the air in hollows. c makes the mean wind that of f w.
/// venturi, as published: F is free of divergence itself, and h_ref is the 1st percentile of the surface at
/// load: the height of the low ground, which a pit or an error of a few cells does not change.
///
/// The Gaussians are tens of metres wide, so the smoothed terrain, the speed-up, the warped wind and the
/// flux are computed on a grid coarsened to about a quarter of the smallest σ. The spectral transfer
/// function undoes the attenuation of the box filter that coarsens and of the interpolation back, which is by
/// quadratic B-splines.
/// The terrain of jackson_hunt is smoothed with σ = half a coarse cell of the default width, or of the
/// width in use if that is more (at least one cell of the terrain), the flux with σ = a coarse cell,
/// because interpolation would bring back divergence at shorter waves. At most 5 % of the divergence
/// of f w is left in D u (of w f in u with venturi) at default settings, over dunes as over rough hills; at
/// full resolution nothing but rounding. Open axes are extended evenly (mirrored) before the transform.
///
/// Reads bedrock, soil and sand through `heights`, and the perturbation; writes wind_x, wind_y.

#include <memory>

#include "kernels/backend/buffer.hpp"
#include "kernels/backend/fft.hpp"
#include "kernels/backend/line_transform.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/surface.hpp"
#include "kernels/wind/coarse_wind.hpp"
#include "kernels/wind/flow_inputs.hpp"
#include "kernels/wind/surface_wind.hpp"
#include "kernels/wind/wind_parameters.hpp"

namespace desert_sim {

namespace wind {

/// Buffers and transforms of the coarse grid; empty if nothing is computed on it.
struct Workspace {
  CoarseGrid coarse;
  std::unique_ptr<Fft> fft_one_field, fft_all_responses;  ///< null if `in_one_kernel`
  bool in_one_kernel = false;  ///< use transform_in_one_kernel() instead of transform_pass_by_pass()
  LineTransform lines_along_x, lines_along_y;
  Buffer<Complex> roots_x, roots_y;  ///< their roots of unity
  Buffer<float> row_means;
  Buffer<float> rise;  ///< height above the reference [m]; then the factors of the speed-up
  Buffer<Complex> spectrum, warped;
  Buffer<Complex> responses;  ///< of the terrain, field by field; then the flux, in the place of the first
  Buffer<long long> mean_sums;
  Buffer<Transfer> along_x[ShortList::capacity], along_y[ShortList::capacity];  ///< of each radius
  Buffer<FlowTransfer> flow_x, flow_y;

  std::size_t bytes() const;
};

CoarseGrid coarse_grid(const Grid& fine, const WindParameters& p);

Workspace make_workspace(Exec& exec, const Grid& fine, const WindParameters& p);

template <class E>
void step(E& exec, const TerrainView& t, const WindParameters& p, const FlowInputs& in,
          const RowScratch& scratch, Workspace& work);

}  // namespace wind
}  // namespace desert_sim
