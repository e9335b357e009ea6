/// The step of avalanching.hpp; compiled once for each backend.
#include "kernels/avalanching/avalanching.hpp"

#include "kernels/avalanching/tile.hpp"
#include "kernels/backend/loops.hpp"
#include "kernels/field/surface_laws.hpp"

namespace desert_sim::avalanching {

/// Whether every coarse cell's children lie in one tile, whatever its offset: then they can get their share
/// there.
inline bool families_share_tiles(const Grid& g) {
  return (!g.periodic_x || g.width % 2 == 0) && (!g.periodic_y || g.height % 2 == 0);
}

/// Passes over a level: the `first` of a step to before the `last`, with so many sweeps each; of the very
/// last one `at_edges`.
struct Passes {
  int first, last, sweeps;
  float share, plenty, at_edges;
};

/// Passes over one level, which first gets what the coarser one has done. `then`: what becomes of its cells
/// (relax_tiles()).
template <class E, class Then>
void relax(E& exec, const LevelView& level, Prolong from_coarse, const Passes& p, std::uint64_t turn,
           const Then& then) {
  if (from_coarse.sand_after && !families_share_tiles(level.grid)) {
    for_each_cell(exec, from_coarse.coarse, from_coarse);
    from_coarse = {};
  }
  for (int pass = p.first; pass < p.last; ++pass) {
    const Tiles tiles{level.grid, seam_offset(turn, pass)};
    const bool is_last = pass + 1 == p.last;
    const ShareOfGap share{p.share, is_last ? p.share * p.at_edges : p.share};
    const RelaxTile law{tiles, level, from_coarse, share, p.sweeps, p.plenty};
    if (is_last)
      relax_tiles(exec, law, then);
    else
      relax_tiles(exec, law, NothingThen{});
    from_coarse = {};
  }
}

/// What the avalanches see of the coarse levels: views[n + 1] of coarse[n].
inline void view_levels(std::vector<Level>& coarse, LevelView* views) {
  for (std::size_t n = 0; n < coarse.size(); ++n) {
    Level& level = coarse[n];
    views[n + 1] = {level.grid,
                    level.ground.data(),
                    nullptr,
                    nullptr,
                    level.sand.data(),
                    level.repose.data(),
                    2.0f * views[n].quanta_per_cell};
  }
}

/// Fills coarse[n], and the next level if there is one, from the level below.
inline Restrict filling(std::vector<Level>& coarse, std::size_t n, const LevelView& below) {
  const auto out = [](Level& level) {
    return LevelOut{level.grid, level.ground.data(), level.sand.data(), level.sand_before.data(),
                    level.repose.data()};
  };
  return {below, out(coarse[n]), n + 1 < coarse.size() ? out(coarse[n + 1]) : LevelOut{}};
}

/// Relaxes the fine grid, then the coarse levels from the coarsest, then the fine grid again. `then`: what
/// becomes of the fine grid's cells.
template <class E, class Then>
void cycle(E& exec, const LevelView& fine, const AvalanchingParameters& p, const Schedule& plan,
           std::uint64_t turn, Workspace& work, const Then& then) {
  std::vector<Level>& coarse = work.coarse;
  std::array<LevelView, 32> views;
  views[0] = fine;
  view_levels(coarse, views.data());
  constexpr float never = 1e6f;
  const float share = plan.share * p.transfer, coarse_share = plan.coarse_share * p.transfer;
  const Passes before{0, 1, plan.first_sweeps, share, never, 1.0f};
  if (coarse.empty())
    relax(exec, fine, Prolong{}, before, turn, NothingThen{});
  else
    relax(exec, fine, Prolong{}, before, turn, filling(coarse, 0, fine));
  for (std::size_t n = 2; n < coarse.size(); n += 2) {
    const Restrict law = filling(coarse, n, views[n]);
    for_each_cell(exec, law.blocks(), law);
  }
  Prolong change{};
  for (std::size_t n = coarse.size(); n > 0; --n) {
    const int passes = plan.coarse_passes(n);
    relax(exec, views[n], change, {0, passes, plan.coarse_sweeps / passes, coarse_share, plan.plenty, 1.0f},
          turn, NothingThen{});
    const Level& done = coarse[n - 1];
    change = {done.grid, done.sand.data(), done.sand_before.data(), views[n - 1].grid, views[n - 1].sand};
  }
  relax(exec, fine, change, {1, plan.fine_passes(), plan.last_sweeps, share, plan.plenty, plan.last_at_edges},
        turn, then);
}

/// Of an excess slides in rounds: all. What is left after a cycle are mostly trains of small slides, and what
/// a pair keeps of one it hands on in later sweeps, which is what takes time.
constexpr float share_in_rounds = 1.0f;

/// Of a pass of a round, at most: its tiles come to rest as far as they can.
constexpr int sweeps_in_rounds = 32;

/// Finds what blocks have cells that are too steep, and the tiles of a round that these call for: in the
/// whole grid, or after a round of them around what it has passed over.
template <class E>
void find_unsettled(E& exec, const LevelView& fine, float tolerance, const RoundOfTiles& round,
                    bool after_round, const OpenTiles& open) {
  const Grid blocks = Blocks{fine.grid}.cells();
  Quanta* const ask = after_round ? open.ask.data() : nullptr;
  if (after_round) for_each_cell(exec, blocks, AskAround{round, ask});
  exec.set_zero(open.found.data(), open.found.bytes());
  const FindSteep find{{fine, tolerance}, ask, open.steep()};
  for_each_cell(exec, find.squares(), find);
  for_each_cell(exec, blocks, OpenNear{open.steep(), round, open.tally()});
}

/// A cycle, and then rounds of passes over those tiles alone that are not at rest, until all are: what is
/// left is on its way down; or another cycle (Look). Rounds between two cycles have the same seams, those of
/// the cycle's next passes.
template <class E>
void settle(E& exec, const LevelView& fine, const AvalanchingParameters& p, std::uint64_t turn,
            Workspace& work) {
  using After = Look::After;
  const Schedule plan = schedule(p, fine.grid);
  const float share = share_in_rounds * p.transfer;
  const OpenTiles& open = work.open;
  Progress* const progress = open.progress.data();
  const auto look = [&](After after, int sweeps) {
    for_each_item(exec, 1, Look{progress, open.tally(), p.max_iterations, after, sweeps});
  };
  const auto do_cycle = [&](std::uint64_t seams, After what) {
    RoundOfTiles round{fine.grid, {}, open.flags(), open.most_tiles};
    for (int n = 0; n < passes_a_round; ++n) round.offsets[n] = seam_offset(seams, plan.fine_passes() + n);
    cycle(exec, fine, p, plan, seams, work, NothingThen{});
    find_unsettled(exec, fine, p.tolerance, round, false, open);
    look(what, plan.fine_sweeps());
    exec.repeat_while(&progress->more_rounds, [&] {
      for (int n = 0; n < passes_a_round; ++n)
        relax_tiles(
            exec,
            RelaxTile{round.of(n), fine, Prolong{}, {share, share}, sweeps_in_rounds, 0.0f, round.of_pass(n)},
            NothingThen{});
      find_unsettled(exec, fine, p.tolerance, round, true, open);
      look(After::round, passes_a_round * sweeps_in_rounds);
    });
  };
  do_cycle(turn, After::first_cycle);
  exec.repeat_while(&progress->more_cycles, [&] { do_cycle(turn + 1, After::cycle); });
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

/// The schemes of synchronous sweeps over the whole grid.
template <class E>
void sweep_all(E& exec, const LevelView& fine, const AvalanchingParameters& p, Workspace& work) {
  const auto unsettled = [&] { return max_cells(exec, fine.grid, Excess{fine}) > p.tolerance; };
  const bool by_tangent = p.scheme == AvalancheScheme::taylor_keyser;
  const float transfer = by_tangent ? 0.25f * p.transfer : p.transfer;
  do {
    for (int n = 0; n < p.sweeps; ++n) sweep(exec, fine, transfer, by_tangent, work);
    work.iterations += p.sweeps;
  } while (p.quality == AvalancheQuality::converged && work.iterations < p.max_iterations && unsettled());
}

template <class E>
void step(E& exec, const TerrainView& t, const AvalanchingParameters& p, std::uint64_t tick,
          const float* repose, surface::Heights* heights, Workspace& work) {
  const LevelView fine = finest(t, repose);
  const bool converge = p.quality == AvalancheQuality::converged;
  work.iterations = 0;
  if (p.scheme == AvalancheScheme::multilevel && !converge) {
    const Schedule plan = schedule(p, t.grid);
    if (heights)
      cycle(exec, fine, p, plan, tick, work, surface::measuring(t, *heights));
    else
      cycle(exec, fine, p, plan, tick, work, NothingThen{});
    work.iterations = plan.fine_sweeps();
    return;
  }
  if (p.scheme == AvalancheScheme::multilevel)
    settle(exec, fine, p, tick, work);
  else
    sweep_all(exec, fine, p, work);
  if (heights) surface::measure(exec, t, *heights);
}

template void step(Backend&, const TerrainView&, const AvalanchingParameters&, std::uint64_t, const float*,
                   surface::Heights*, Workspace&);

}  // namespace desert_sim::avalanching
