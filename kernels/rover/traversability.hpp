#pragma once
/// What the surface is to a rover: slope and normal, roughness, steps, and from these whether it gets
/// through. Not part of a step: computed for who asks (Lifetime::on_request).
///
///   slope, normal    of the central differences of the surface h; one-sided at open edges
///   roughness        √(mean of (h − p)²) over the window, p the plane that fits it best
///   step height      largest |h_j − h − g·d_j| in the window among cells j at distance d_j that lie higher
///   or
///                    lower by more than |d_j| tan `slope_deg`; g by axis the flatter of the two one-sided
///                    differences (0 if they disagree), so that an edge beside flat ground counts in full
///   traversability   the least of 1 − slope/limit, 1 − step/limit, 1 − roughness/limit, 1 − water/limit,
///                    1 − plants/limit, 1 − mud, 1 − `sand_cost`·σ, and not below 0; 0 on obstacles
///
/// The slope's limit goes from `slope_deg` to `sand_slope_deg` with σ = min(sand / `sand_depth`, 1), because
/// wheels slip on loose sand. Mud is (m − ½)/(`mud` − ½) of relative moisture m, where there is enough
/// ground. The window is the square of cells up to `window` away along x and y, one to 16 cells; at open
/// edges what there is of it. Reads elevation, sand, soil, moisture, water, vegetation, obstacle; writes
/// those of slope, normal_x, normal_y, normal_z, roughness, step_height, traversability that the view has.

#include "kernels/field/layers.hpp"
#include "kernels/field/math.hpp"
#include "kernels/sand/repose.hpp"
#include "src/core/parameters.hpp"

namespace desert_sim {

/// The defaults are a wheeled rover of a metre or so.
struct TraversabilityParameters {
  float slope_deg = 25.0f;
  float sand_slope_deg = 16.0f;
  float sand_depth = 0.3f;
  float sand_cost = 0.2f;
  float step_height = 0.3f;
  float roughness = 0.15f;
  float water_depth = 0.3f;
  float mud = 0.9f;
  float vegetation = 0.8f;
  float window = 0.5f;
};

constexpr auto parameter_table(const TraversabilityParameters*) {
  using P = TraversabilityParameters;
  return std::make_tuple(
      parameter("slope_deg", &P::slope_deg, 0.1, 89, "deg", "Slope of firm ground that stops the rover."),
      parameter("sand_slope_deg", &P::sand_slope_deg, 0.1, 89, "deg",
                "Slope of deep loose sand on which its wheels slip through."),
      parameter("sand_depth", &P::sand_depth, 1e-3, 1000, "m", "Depth from which sand is deep."),
      parameter("sand_cost", &P::sand_cost, 0, 1, "1", "What deep sand takes off the traversability of 1."),
      parameter("step_height", &P::step_height, 1e-3, 1000, "m", "Step that stops the rover."),
      parameter("roughness", &P::roughness, 1e-3, 1000, "m", "Roughness that stops the rover."),
      parameter("water_depth", &P::water_depth, 1e-3, 1000, "m", "Water that stops the rover."),
      parameter("mud", &P::mud, 0.501, 1000, "1",
                "Relative moisture of deep sand or soil that stops the rover; half-wet ground is firm, above "
                "1 none does."),
      parameter("vegetation", &P::vegetation, 1e-3, 1000, "1",
                "Density of plants that stops the rover; above 1 none does."),
      parameter("window", &P::window, 0, 1000, "m",
                "How far around a cell roughness and steps are looked for; at least one cell, at most 16."));
}
static_assert(table_is_complete<TraversabilityParameters>());

namespace traversability {

constexpr int widest_window = 16;  ///< [cells]

inline int window_cells(const TraversabilityParameters& p, float cell_size) {
  return static_cast<int>(clamp(p.window / cell_size, 1.0f, static_cast<float>(widest_window)));
}

/// For `rows` rows from `first` on. `elevation` must be up to date everywhere.
template <class E>
void step(E& exec, const TerrainView& t, const TraversabilityParameters& p, const ReposeParameters& repose,
          int first, int rows);

}  // namespace traversability
}  // namespace desert_sim
