#pragma once
/// The shear stress of the wind over sand, in real units, for the continuum model of transport. Kroy,
/// Sauermann & Herrmann 2002; Durán & Moore 2013; the response with constant coefficients of Fourrière,
/// Claudin & Andreotti 2010.
///
///   undisturbed   τ_0 = ρ_a u_*²,   u_* = κ U / ln(z/z_0),   U the wind at the height z = `wind_height`
///   response      τ̂_∥ = τ_0 (A + i B sgn k_∥) |k| (k_∥/|k|)² ĥ
///                 τ̂_⊥ = ½ τ_0 (A + i B sgn k_∥) |k| (k_∥ k_⊥/|k|²) ĥ
///   stress        τ   = (τ_0 + τ_∥, τ_⊥) (1 − shelter),   with τ_0 + τ_∥ not below 0
///
/// ∥ and ⊥ are along and across the undisturbed wind. B > 0 sets the largest stress before the crest. h is
/// the surface with the separation bubbles filled in. Where the lee is steeper than β = `separation_deg`,
/// the air leaves the ground at the brink with the slope of the brink, which bends down to −tan β over
/// three times the height H of the brink above its lee (`bend_length`), and comes down to the ground with
/// that slope,
///
///   e(s) = max(h(s), e(s − Δs) + e′ Δs),   e″ = −tan β/(3 H),   −tan β ≤ e′ ≤ 0
///
/// some 5.5 H behind the brink. The stress is 0 under it (shelter rises to 1 over the depth to which the line
/// falls in one cell).
///
/// The layers wind_x and wind_y are the wind at `wind_height` over flat ground that has this stress: their
/// square is proportional to τ, and their direction is that of τ. Local features of the wind turn and scale
/// τ_0 cell by cell.
///
/// The response is computed on a grid whose cells are `stress_cell` wide, on one of the terrain where that is
/// not narrower; open axes are extended evenly (mirrored).
///
/// Reads bedrock, soil and sand through `heights`; writes wind_x, wind_y.

#include <memory>

#include "kernels/backend/buffer.hpp"
#include "kernels/backend/fft.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/surface.hpp"
#include "kernels/wind/coarse_wind.hpp"
#include "kernels/wind/flow_inputs.hpp"
#include "kernels/wind/shear_stress_parameters.hpp"
#include "kernels/wind/vector.hpp"

namespace desert_sim {

namespace shear_stress {

/// Von Kármán's constant, of turbulence near any wall.
constexpr double von_karman = 0.41;

/// Shear velocity u_* over flat ground of a wind of 1 m/s at `wind_height` [1].
double shear_velocity_per_wind(const ShearStressParameters& p);

/// Words that a place of the sweeps hands on, and how many places to the side these are found.
constexpr int words_handed_on = 3, reach_of_words = 2;

struct Workspace {
  wind::CoarseGrid coarse;
  std::unique_ptr<Fft> fft;
  Buffer<float> ground;  ///< heights in the order of the sweep, as `lee` and `filled` [quanta]
  Buffer<float> lee;     ///< how low the ground lies downwind of each cell [quanta]
  Buffer<float> filled;  ///< the surface with the bubbles [quanta]
  Buffer<float> lines;   ///< what lines of the sweeps hand on
  Buffer<Complex> spectrum;
  // Empty where the coarse grid is the terrain's own:
  Buffer<float> row_means;  ///< of `filled` [quanta]
  Buffer<float> rise;       ///< of the coarse cells [m]
  Buffer<Complex> rows;     ///< the response, interpolated along x
  Buffer<float> transfer_x, transfer_y;

  std::size_t bytes() const;
};

Workspace make_workspace(Exec& exec, const Grid& grid, const ShearStressParameters& p);

template <class E>
void step(E& exec, const TerrainView& t, const ShearStressParameters& p, const wind::FlowInputs& in,
          Workspace& work);

}  // namespace shear_stress
}  // namespace desert_sim
