#pragma once
/// Avalanching: what is steeper than its angle of repose slides. Nilles 2024 eq. 9–11; physics.md B6.
///
///   B_ij = max(h_i − h_j − tan θ_i d l, 0),  A_i = min(k_c B_max/(1 + B_max/B_sum), s_i),  j gets A_i B_ij /
///   B_sum
///
/// Releases are computed from one state, then handed over: what a donor loses is to the bit what its
/// receivers get, so that nothing is made or lost and no order matters. Obstacles neither give nor take (they
/// stand as walls).
///
/// Schemes: `multilevel` (the default), half a V-cycle a step: the fine grid is relaxed a little, so that
/// small slides end where they are; sand and ground are averaged down by two a level until cells are
/// `coarsest_cell` wide; the coarsest is relaxed first, the change handed to the four children, and the fine
/// grid relaxed again last. Each relaxation is sweeps inside closed tiles whose seams move between passes
/// (avalanching_tile.hpp), which leave what is below 2e-4 cell sizes.
/// `sweeps`: synchronous sweeps of the whole grid, the reference. `taylor_keyser`: k_c = 0.25 of the largest
/// drop, by tangents, for comparison.
///
/// Reads bedrock, soil, obstacle and the repose tangents; writes sand. Soil and bedrock:
/// avalanching_ground.hpp.

#include <vector>

#include "desert_sim/core/parameters.hpp"
#include "desert_sim/kernels/avalanching_tile.hpp"
#include "desert_sim/kernels/buffer.hpp"

namespace desert_sim {

enum class AvalancheScheme : int { multilevel, sweeps, taylor_keyser };
constexpr const char* avalanche_schemes[] = {"multilevel", "sweeps", "taylor_keyser"};
enum class AvalancheQuality : int { fast, good, converged };
constexpr const char* avalanche_qualities[] = {"fast", "good", "converged"};

struct AvalanchingParameters {
  bool enabled = true;
  AvalancheScheme scheme = AvalancheScheme::multilevel;
  AvalancheQuality quality = AvalancheQuality::good;
  float transfer = 1.0f;
  float coarsest_cell = 4.0f;
  int sweeps = 50;
  float tolerance = 0.001f;
  int max_iterations = 20000;
  bool soil = true;
  bool bedrock = true;
  bool bedrock_to_sand = true;
};

constexpr auto parameter_table(const AvalanchingParameters*) {
  using P = AvalanchingParameters;
  return std::make_tuple(
      parameter("enabled", &P::enabled, "Whether steep sand slides."),
      parameter("scheme", &P::scheme, avalanche_schemes, "How slides are computed."),
      parameter("quality", &P::quality, avalanche_qualities,
                "fast: 2 x 4 fine sweeps; good: 4 x 8; converged: until tolerance (also for sweeps)."),
      parameter("transfer", &P::transfer, 0.05, 1, "1",
                "Share of what would stabilise a cell that one sweep moves (k_c)."),
      parameter("coarsest_cell", &P::coarsest_cell, 0.001, 1000, "m",
                "Width of cells at which coarsening stops."),
      parameter("sweeps", &P::sweeps, 1, 100000, "1",
                "Sweeps a step of the schemes sweeps and taylor_keyser, unless converged."),
      parameter("tolerance", &P::tolerance, 1e-6, 1, "1",
                "Largest excess that counts as converged, in cell sizes; multilevel gets to 2e-4."),
      parameter("max_iterations", &P::max_iterations, 1, 1000000, "1",
                "Most fine sweeps a step when converging."),
      parameter("soil", &P::soil, "Whether steep soil slides, where it changed."),
      parameter("bedrock", &P::bedrock, "Whether steep bedrock breaks, where it changed."),
      parameter("bedrock_to_sand", &P::bedrock_to_sand, "Whether broken bedrock turns to sand."));
}
static_assert(table_is_complete<AvalanchingParameters>());

namespace avalanching {

/// Passes over shifted tiles, and sweeps in each: of the fine grid before the coarse levels, of each coarse
/// level, and of the fine grid after them.
struct Schedule {
  int before, coarse, after, sweeps;
};
constexpr Schedule schedule(AvalancheQuality quality) {
  if (quality == AvalancheQuality::fast) return {1, 2, 1, 4};
  return {1, 4, 3, 8};
}
static_assert(schedule(AvalancheQuality::good).sweeps <= most_sweeps);

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
  int iterations = 0;  ///< fine sweeps of the last step
};

Workspace make_workspace(Exec& exec, const Grid& grid, const AvalanchingParameters& p);

inline LevelView finest(const TerrainView& t, const float* repose) {
  return {t.grid,
          t.quanta(Layer::bedrock),
          t.quanta(Layer::soil),
          t.real(Layer::obstacle),
          t.quanta(Layer::sand),
          repose,
          t.grid.cell_size * t.quanta_per_metre};
}

/// Seams move between passes, and each pass meets them at all places in so many turns, so that they leave no
/// imprint.
constexpr int seam_offsets[] = {0, 16, 8, 24, 4, 20, 12, 28};
constexpr std::uint64_t turns = 8;

/// Passes `first` to `last` of turn `turn` over one level.
template <class E>
void relax(E& exec, const LevelView& level, float transfer, int first, int last, int sweeps,
           std::uint64_t turn) {
  for (int pass = first; pass < last; ++pass) {
    const Tiles tiles{level.grid, seam_offsets[(5 * turn + static_cast<std::uint64_t>(pass)) % turns]};
    relax_tiles(exec, RelaxTile{tiles, level, transfer, sweeps});
  }
}

/// Relaxes the fine grid, then the coarse levels from the coarsest, then the fine grid again.
template <class E>
void cycle(E& exec, const LevelView& fine, float transfer, const Schedule& plan, std::uint64_t turn,
           Workspace& work) {
  relax(exec, fine, transfer, 0, plan.before, plan.sweeps, turn);
  std::vector<Level>& coarse = work.coarse;
  std::array<LevelView, 32> views;
  const int levels = static_cast<int>(coarse.size());
  views[0] = fine;
  for (int n = 0; n < levels; ++n) {
    Level& level = coarse[n];
    for_each_cell(exec, level.grid,
                  Restrict{views[n], level.grid, level.ground.data(), level.sand.data(),
                           level.sand_before.data(), level.repose.data()});
    views[n + 1] = {level.grid,
                    level.ground.data(),
                    nullptr,
                    nullptr,
                    level.sand.data(),
                    level.repose.data(),
                    2.0f * views[n].quanta_per_cell};
  }
  for (int n = levels; n > 0; --n) {
    relax(exec, views[n], transfer, 0, plan.coarse, plan.sweeps, turn);
    for_each_cell(exec, views[n].grid,
                  Prolong{views[n].grid, coarse[n - 1].sand.data(), coarse[n - 1].sand_before.data(),
                          views[n - 1].grid, views[n - 1].sand});
  }
  relax(exec, fine, transfer, plan.before, plan.before + plan.after, plan.sweeps, turn);
}

template <class E>
void sweep(E& exec, const LevelView& level, float transfer, bool by_tangent, Workspace& work) {
  for_each_cell(exec, level.grid,
                Release<LevelView>{level, transfer, by_tangent, work.share.data(), work.given.data()});
  for_each_cell(
      exec, level.grid,
      Gather<LevelView>{level, by_tangent, work.share.data(), work.given.data(), work.received.data()});
  for_each_cell(exec, level.grid,
                ApplySweep{level.grid, work.given.data(), work.received.data(), level.sand});
}

/// `repose`: tangents of each cell's angle of repose; `tick`: steps done.
template <class E>
void step(E& exec, const TerrainView& t, const AvalanchingParameters& p, std::uint64_t tick,
          const float* repose, Workspace& work) {
  const LevelView fine = finest(t, repose);
  const bool converge = p.quality == AvalancheQuality::converged;
  const auto unsettled = [&] { return max_cells(exec, t.grid, Excess{fine}) > p.tolerance; };
  work.iterations = 0;
  if (p.scheme == AvalancheScheme::multilevel) {
    const Schedule plan = schedule(p.quality);
    const int fine_sweeps = (plan.before + plan.after) * plan.sweeps;
    std::uint64_t turn = tick;
    do {
      cycle(exec, fine, p.transfer, plan, turn++, work);
      work.iterations += fine_sweeps;
    } while (converge && work.iterations < p.max_iterations && unsettled());
    return;
  }
  const bool by_tangent = p.scheme == AvalancheScheme::taylor_keyser;
  const float transfer = by_tangent ? 0.25f * p.transfer : p.transfer;
  do {
    for (int n = 0; n < p.sweeps; ++n) sweep(exec, fine, transfer, by_tangent, work);
    work.iterations += p.sweeps;
  } while (converge && work.iterations < p.max_iterations && unsettled());
}

}  // namespace avalanching
}  // namespace desert_sim
