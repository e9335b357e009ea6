#pragma once
/// Avalanching: sand that is steeper than its angle of repose slides down. Nilles 2024, eq. 9–11.
///
///   B_ij = max(h_i − h_j − tan θ_i · d l, 0)          excess of cell i over its neighbour j
///   A_i  = min(k_c B_max / (1 + B_max/B_sum), s_i)    sand that cell i releases
///   A_ij = A_i B_ij / B_sum                           the part of it that neighbour j receives
///
/// h is the height of the surface, θ_i the donor's angle of repose, d l the distance of the two cells (d = 1
/// or √2, l the cell size), s the depth of sand; B_max and B_sum are the largest and the sum of the eight
/// B_ij. A donor loses exactly what its receivers get, so sand is conserved to the bit. Obstacles neither
/// give nor receive sand: they stand as walls.
///
/// Schemes:
///
///   multilevel      One multigrid cycle a step. The fine grid is relaxed briefly, so that small
///                   slides end where they are; ground and sand are restricted (averaged two by two) until
///                   cells are `coarsest_cell` wide, or four cells of the grid; then each level, from the
///                   coarsest to the finest, is relaxed, and its change prolonged to the four children of
///                   each cell. With quality `converged` more passes follow until the tolerance is met, which
///                   can be as low as 2e-4 (relax_until_converged()).
///   gradient        (default) The same cycle with one law for slopes of every aspect: sand slides where the
///                   gradient, and not one of eight drops, exceeds the angle of repose (quads.hpp). Cones
///                   are round, and slip faces have no planes.
///   sweeps          Synchronous sweeps (Jacobi) of the whole grid by the equations above; the reference.
///                   With `low_transfer` every tenth and the last five have another k_c.
///   taylor_keyser   Synchronous sweeps that release k_c `taylor_keyser_transfer` of the largest drop,
///                   distributed by tangents; for comparison.
///
/// Relaxation in `multilevel` consists of sweeps inside closed tiles, whose edges no sand crosses and whose
/// seams lie elsewhere in each pass (tile.hpp). A sweep relaxes pairs of neighbours one after the other, as
/// Gauss-Seidel relaxation does (patch.hpp), which converges faster than releases computed from one state,
/// with less arithmetic a sweep.
///
/// How the files fit together:
///
///   avalanching.cpp  step()
///    |
///    +-- sweep_all()  schemes `sweeps`, `taylor_keyser`
///    |     laws.hpp          Release, Gather, ApplySweep: one synchronous sweep; Excess: what is left
///    |
///    +-- cycle()      schemes `multilevel` and `gradient`
///    |     |
///    |     |   fine grid       relax               relax     then surface::ComputeBlockHeights
///    |     |                      \             /
///    |     |   coarse levels       restrict ... relax
///    |     |
///    |     laws.hpp          Restrict, Prolong: transfer between the levels
///    |     tile.cpp          relax_tiles(): one pass over all tiles of a level
///    |      |
///    |      +-- CPU: tile.hpp        RelaxTile: one closed tile of 32 × 32 cells, the reference
///    |      |        tile_units.hpp  Units: heights as floats that count whole units
///    |      |        patch.hpp       PairsOfPatches: the pairs of 4 × 4 cells, in the order of relaxation
///    |      |        quads.hpp       QuadsOfPatches: in place of pairs, for scheme `gradient`
///    |      |
///    |      +-- GPU: tuned/          the same arithmetic in hand-written kernels
///    |               tile.cu         the kernel: one tile a thread block, one patch a thread
///    |               patches.cuh     from global to shared memory and back
///    |               sweeps.cuh      sweeps in shared memory and registers
///    |
///    +-- relax_until_converged()     quality `converged`: cycle(), then passes over active tiles
///          steep_blocks.hpp  FindSteep: blocks of 8 × 8 cells with a cell that is still too steep
///          active_tiles.hpp  ActivateTiles: tiles of the next round; CheckConvergence: the convergence check
///
///   avalanching_host.cpp      schedule, grids and buffers of the coarse levels
///   soil_and_bedrock.*        one synchronous sweep a step of soil and of bedrock, by Release and Gather
///
/// Reads bedrock, soil, obstacle and the tangents of the angles of repose; writes sand.

#include <cstdint>
#include <vector>

#include "kernels/avalanching/active_tiles.hpp"
#include "kernels/avalanching/avalanching_parameters.hpp"
#include "kernels/backend/buffer.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/surface.hpp"

namespace desert_sim::avalanching {

/// Numbers of passes and sweeps of a cycle, and the shares of an excess that slide (ω in patch.hpp).
///
///   first_sweeps    fewest sweeps of the one pass over the fine grid before the coarse levels. With fewer,
///                   more is left to the coarse levels, which then move sand that would have come to rest by
///                   itself.
///   coarse_sweeps   fewest sweeps over a coarse level, in all its passes together
///   last_sweeps     fewest sweeps of each pass over the fine grid after the coarse levels
///   last_passes     number of those passes; their seams lie in different places
///   two_pass_levels    number of coarse levels, from the finest on, that get two passes; others get one
///   continue_threshold   a tile goes on, up to `max_sweeps_while_sliding` (tile.hpp), while a pair moves
///                   more than this [cell sizes]; not in the first pass
///   share           ω on the fine grid. ½ leaves a pair at repose; more converges sooner, but with 0.8
///                   slopes end too far below their angle of repose.
///   coarse_share    ω on coarse levels. They make somewhat more slopes of 6 … 18 degrees than there should
///                   be, the more so the larger ω is.
///   last_edge_factor   factor on ω next to tile edges in the very last pass (GapOmega), as no later pass
///                   relaxes across these edges
struct Schedule {
  int first_sweeps, coarse_sweeps, last_sweeps, last_passes;
  std::size_t two_pass_levels;
  float continue_threshold, share, coarse_share, last_edge_factor;

  /// Passes over the nth coarse level, from 1 for the finest; they share `coarse_sweeps`.
  constexpr int coarse_passes(std::size_t n) const { return n <= two_pass_levels ? 2 : 1; }
  constexpr int fine_passes() const { return 1 + last_passes; }
  constexpr int fine_sweeps() const { return first_sweeps + last_passes * last_sweeps; }
};

constexpr Schedule preset(AvalancheQuality quality) {
  if (quality == AvalancheQuality::fast) return {4, 8, 4, 1, 2, 0.3f, 0.7f, 0.6f, 0.6f};
  if (quality == AvalancheQuality::good) return {5, 8, 3, 3, 2, 0.25f, 0.7f, 0.7f, 0.45f};
  return {6, 8, 3, 1, 2, 0.3f, 0.6f, 0.6f, 1.0f};
}

/// The schedule of a quality. On small grids `good` takes more last sweeps, which cost next to nothing on
/// a GPU, so that hardly any excess is left there. By the gradient it takes fewer sweeps, so that it
/// takes no longer. A positive `last_passes` replaces the number of last passes, and selects the sweeps
/// of large grids.
Schedule schedule(const AvalanchingParameters& p, const Grid& grid);

/// Buffers of a coarse level. The finest level works on the layers of the terrain.
struct Level {
  Grid grid;
  Buffer<Quanta> ground, sand, sand_before;
  Buffer<float> repose;
};

struct Workspace {
  std::vector<Level> coarse;  ///< coarse[0] has cells twice as wide as the terrain's
  Buffer<float> share;        ///< with given, received: synchronous schemes only
  Buffer<Quanta> given, received;
  ActiveTiles active_tiles;  ///< schemes with levels, quality converged only
  int iterations = 0;        ///< fine sweeps of the last step that the host has counted
  /// Fine sweeps of all steps that the device has counted (relax_until_converged()).
  long long counted_iterations() const {
    if (!active_tiles.progress) return 0;
    Progress progress;
    active_tiles.progress.download(0, 1, &progress);
    return progress.sweeps;
  }
  std::size_t bytes() const;
};

Workspace make_workspace(Exec& exec, const Grid& grid, const AvalanchingParameters& p);

/// k_c of the nth of a step's `sweeps`, from 0.
inline float transfer_of_sweep(const AvalanchingParameters& p, int n) {
  const bool low = (p.low_every > 0 && (n + 1) % p.low_every == 0) || n >= p.sweeps - p.low_last;
  const float transfer = low && p.low_transfer > 0.0f ? p.low_transfer : p.transfer;
  return p.scheme == AvalancheScheme::taylor_keyser ? p.taylor_keyser_transfer * transfer : transfer;
}

/// Offsets of the tiles [cells]. Seams move from pass to pass, and in eight steps each pass has had all
/// offsets, so that seams leave no imprint in the terrain.
constexpr int seam_offsets[] = {0, 16, 8, 24, 4, 20, 12, 28};

constexpr std::uint64_t seam_period = 8;

inline int seam_offset(std::uint64_t step_count, int pass) {
  return seam_offsets[(5 * step_count + static_cast<std::uint64_t>(pass)) % seam_period];
}

/// RelaxTile::first_shift of a pass. Pairs of passes begin two sweeps apart: a tile in which two sweeps
/// move nothing takes no more of them, and what lies across its patches waits for the next pass. Quads
/// begin elsewhere in each step and in each pair of passes: if the same cells were always relaxed in the
/// same order, two to three times as much thin sand would lie unevenly from cell to cell.
inline int first_shift(std::uint64_t step_count, int pass, bool by_gradient) {
  const auto n = static_cast<std::uint64_t>(pass);
  return static_cast<int>((2 * (step_count + n) + (by_gradient ? step_count + n / 2 : 0)) % Patch::side);
}

/// `repose`: tangent of each cell's angle of repose. `tick`: number of steps done, which selects the seams.
/// `heights`: measured once the sand has settled, or null.
template <class E>
void step(E& exec, const TerrainView& t, const AvalanchingParameters& p, std::uint64_t tick,
          const float* repose, surface::Heights* heights, Workspace& work);

}  // namespace desert_sim::avalanching
