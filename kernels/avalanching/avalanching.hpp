#pragma once
/// Avalanching: what is steeper than its angle of repose slides. Nilles 2024 eq. 9–11; physics.md B6.
///
///   B_ij = max(h_i − h_j − tan θ_i d l, 0),  A_i = min(k_c B_max/(1 + B_max/B_sum), s_i),  j gets A_i B_ij /
///   B_sum
///
/// What a donor loses is to the bit what its receivers get, so that nothing is made or lost. Obstacles
/// neither give nor take (they stand as walls).
///
/// Schemes: `multilevel` (the default), half a V-cycle a step: the fine grid is relaxed a little, so that
/// small slides end where they are; sand and ground are averaged down by two a level until cells are
/// `coarsest_cell` wide; the coarsest is relaxed first, the change handed to the four children, and the fine
/// grid relaxed again last. Each relaxation is sweeps inside closed tiles whose seams move between passes
/// (avalanching_tile.hpp): pair by pair, each seeing what those before it have done (avalanching_patch.hpp),
/// which settles sooner than releases from one state, with less arithmetic a sweep. It leaves what
/// is below 2e-4 cell sizes. What `converged` adds: settle(). `sweeps`: synchronous sweeps of the whole grid
/// by the equation above, the reference. `taylor_keyser`: k_c = 0.25 of the largest drop, by tangents, for
/// comparison.
///
/// Reads bedrock, soil, obstacle and the repose tangents; writes sand. Soil and bedrock:
/// avalanching_ground.hpp.

#include <cstdint>
#include <vector>

#include "kernels/avalanching/active_tiles.hpp"
#include "kernels/avalanching/parameters.hpp"
#include "kernels/backend/buffer.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/surface.hpp"

namespace desert_sim::avalanching {

/// Sweeps, at least, of the one pass over the fine grid before the coarse levels, of the passes over each
/// coarse level together (two over the finest `levels_twice` of these, one over others), and of each of the
/// last passes over the fine grid, whose seams lie elsewhere; and how much a pair moves [cell sizes] for its
/// tile to go on (but in the first pass). With fewer sweeps in the first pass more is left to coarse levels,
/// which slide what would have come to rest by itself. `share`, `coarse_share`: of a pair's excess (ω in
/// avalanching_patch.hpp) on the fine grid and on coarse levels; ½ leaves the two at repose, more settles the
/// whole sooner, with 0.8 slopes end too far below their angle. Coarse levels make somewhat more slopes of 6
/// … 18 degrees than there should be, the more the larger their share. `last_at_edges`: of the share, next to
/// edges of the last pass's tiles (ShareOfGap), which no later pass goes over.
struct Schedule {
  int first_sweeps, coarse_sweeps, last_sweeps, last_passes;
  std::size_t levels_twice;
  float plenty, share, coarse_share, last_at_edges;

  /// Over the nth coarse level, from 1 for the finest; they share `coarse_sweeps`.
  constexpr int coarse_passes(std::size_t n) const { return n <= levels_twice ? 2 : 1; }
  constexpr int fine_passes() const { return 1 + last_passes; }
  constexpr int fine_sweeps() const { return first_sweeps + last_passes * last_sweeps; }
};

constexpr Schedule preset(AvalancheQuality quality) {
  if (quality == AvalancheQuality::fast) return {4, 8, 4, 1, 2, 0.3f, 0.7f, 0.6f, 0.6f};
  if (quality == AvalancheQuality::good) return {5, 8, 3, 3, 2, 0.25f, 0.7f, 0.7f, 0.45f};
  return {6, 8, 3, 1, 2, 0.3f, 0.6f, 0.6f, 1.0f};
}

/// The preset; on small grids `good` has more last sweeps, which hardly cost anything on a GPU, so that next to
/// nothing is left there. With `last_passes` that of large grids.
Schedule schedule(const AvalanchingParameters& p, const Grid& grid);

/// A level's own memory (the finest uses the terrain's sand).
struct Level {
  Grid grid;
  Buffer<Quanta> ground, sand, sand_before;
  Buffer<float> repose;
};

struct Workspace {
  std::vector<Level> coarse;  ///< coarse[0] has cells twice as wide as the terrain's
  Buffer<float> share;        ///< of the synchronous schemes; made when one is used
  Buffer<Quanta> given, received;
  OpenTiles open;      ///< of the multilevel scheme, when it converges
  int iterations = 0;  ///< fine sweeps of the last step, but those that the device counts
  /// Fine sweeps of all steps that the device has counted.
  long long counted_iterations() const {
    if (!open.progress) return 0;
    Progress progress;
    open.progress.download(0, 1, &progress);
    return progress.sweeps;
  }
};

Workspace make_workspace(Exec& exec, const Grid& grid, const AvalanchingParameters& p);

/// Seams move between passes, and each pass meets them at all places in so many turns, so that they leave no
/// imprint.
constexpr int seam_offsets[] = {0, 16, 8, 24, 4, 20, 12, 28};

constexpr std::uint64_t turns = 8;

inline int seam_offset(std::uint64_t turn, int pass) {
  return seam_offsets[(5 * turn + static_cast<std::uint64_t>(pass)) % turns];
}

/// `repose`: tangents of each cell's angle of repose; `tick`: steps done; `heights`: measured when all is
/// done, or null.
template <class E>
void step(E& exec, const TerrainView& t, const AvalanchingParameters& p, std::uint64_t tick,
          const float* repose, surface::Heights* heights, Workspace& work);

}  // namespace desert_sim::avalanching
