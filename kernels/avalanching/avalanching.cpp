/// Steps of avalanching.hpp: synchronous sweeps, the multigrid cycle and convergence. Compiled once for each
/// backend.
#include "kernels/avalanching/avalanching.hpp"

#include "kernels/avalanching/tile.hpp"
#include "kernels/backend/loops.hpp"
#include "kernels/field/surface_laws.hpp"

namespace desert_sim::avalanching {

/// Whether the four children of every coarse cell lie in one tile, whatever the tiles' offset: then the
/// change of the coarse level can be prolonged tile by tile.
inline bool children_share_tiles(const Grid& g) {
  return (!g.periodic_x || g.width % 2 == 0) && (!g.periodic_y || g.height % 2 == 0);
}

/// Passes over a level: those numbered `first` to `last` − 1 in this step, with at least `sweeps` sweeps
/// each. `share`, `continue_threshold` and `edge_factor` are as in Schedule; `edge_factor` applies to the
/// last of these passes. `by_gradient`: by quads.hpp.
struct Passes {
  int first, last, sweeps;
  float share, continue_threshold, edge_factor;
  bool by_gradient;
};

/// Relaxes one level, after prolonging the change of the next coarser one to it. `then` is the law that
/// follows the last pass (relax_tiles()).
template <class E, class Then>
void relax(E& exec, const LevelView& level, Prolong from_coarse, const Passes& p, std::uint64_t step_count,
           const Then& then) {
  if (from_coarse.sand_after && !children_share_tiles(level.grid)) {
    for_each_cell(exec, from_coarse.coarse, from_coarse);
    from_coarse = {};
  }
  for (int pass = p.first; pass < p.last; ++pass) {
    const Tiles tiles{level.grid, seam_offset(step_count, pass)};
    const bool is_last = pass + 1 == p.last;
    const GapOmega share{p.share, is_last ? p.share * p.edge_factor : p.share};
    const RelaxTile law{tiles,   level,         from_coarse,
                        share,   p.sweeps,      p.continue_threshold,
                        nullptr, p.by_gradient, first_shift(step_count, pass, p.by_gradient)};
    if (is_last)
      relax_tiles(exec, law, then);
    else
      relax_tiles(exec, law, NoFollowUp{});
    from_coarse = {};
  }
}

/// Fills views[n + 1] with the view of coarse[n]; views[0] is the finest level.
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

/// The law that restricts the level `below` to coarse[n] and, if there is one, to coarse[n + 1].
inline Restrict make_restriction(std::vector<Level>& coarse, std::size_t n, const LevelView& below) {
  const auto out = [](Level& level) {
    return LevelBuffers{level.grid, level.ground.data(), level.sand.data(), level.sand_before.data(),
                        level.repose.data()};
  };
  return {below, out(coarse[n]), n + 1 < coarse.size() ? out(coarse[n + 1]) : LevelBuffers{}};
}

/// One multigrid cycle: relaxes the fine grid, restricts it to the coarse levels, relaxes these from the
/// coarsest on, and relaxes the fine grid again. `then` is the law that follows the last pass over the fine
/// grid.
template <class E, class Then>
void cycle(E& exec, const LevelView& fine, const AvalanchingParameters& p, const Schedule& plan,
           std::uint64_t step_count, Workspace& work, const Then& then) {
  std::vector<Level>& coarse = work.coarse;
  std::array<LevelView, 32> views;
  views[0] = fine;
  view_levels(coarse, views.data());
  constexpr float never = 1e6f;
  const float share = plan.share * p.transfer, coarse_share = plan.coarse_share * p.transfer;
  const bool by_gradient = p.scheme == AvalancheScheme::gradient;
  const Passes before{0, 1, plan.first_sweeps, share, never, 1.0f, by_gradient};
  if (coarse.empty())
    relax(exec, fine, Prolong{}, before, step_count, NoFollowUp{});
  else
    relax(exec, fine, Prolong{}, before, step_count, make_restriction(coarse, 0, fine));
  for (std::size_t n = 2; n < coarse.size(); n += 2) {
    const Restrict law = make_restriction(coarse, n, views[n]);
    for_each_cell(exec, law.blocks(), law);
  }
  Prolong change{};
  for (std::size_t n = coarse.size(); n > 0; --n) {
    const int passes = plan.coarse_passes(n);
    relax(exec, views[n], change,
          {0, passes, plan.coarse_sweeps / passes, coarse_share, plan.continue_threshold, 1.0f, by_gradient},
          step_count, NoFollowUp{});
    const Level& done = coarse[n - 1];
    change = {done.grid, done.sand.data(), done.sand_before.data(), views[n - 1].grid, views[n - 1].sand};
  }
  relax(exec, fine, change,
        {1, plan.fine_passes(), plan.last_sweeps, share, plan.continue_threshold, plan.last_edge_factor,
         by_gradient},
        step_count, then);
}

/// In rounds the whole excess slides (ω = 1), or what the law by the gradient may move at most. Mostly chains
/// of small slides are left after a cycle, and what a pair keeps back of one has to be passed on in later
/// sweeps, which is what takes time.
constexpr float omega_in_rounds(AvalancheScheme scheme) {
  return scheme == AvalancheScheme::gradient ? 0.75f : 1.0f;
}

/// Upper bound of sweeps per pass in a round; tiles that come to rest stop sooner.
constexpr int max_sweeps_in_rounds = 32;

/// Finds the blocks with cells that are too steep, and activates the tiles around them for the next round.
/// The whole grid is checked, or after a round only the blocks around the tiles that it has relaxed.
template <class E>
void update_active_tiles(E& exec, const LevelView& fine, const AvalanchingParameters& p,
                         const ActiveTileFlags& round, bool after_round, const ActiveTiles& active) {
  const Grid blocks = Blocks{fine.grid}.cells();
  Quanta* const blocks_to_check = after_round ? active.blocks_to_check.data() : nullptr;
  if (after_round) for_each_cell(exec, blocks, MarkNeighbours{round, blocks_to_check});
  exec.set_zero(active.check_buffer.data(), active.check_buffer.bytes());
  const FindSteep find{
      {fine, p.tolerance}, blocks_to_check, active.steep(), p.scheme == AvalancheScheme::gradient};
  for_each_cell(exec, find.squares(), find);
  for_each_cell(exec, blocks, ActivateTiles{active.steep(), round, active.steep_counter()});
}

/// A multigrid cycle, then rounds of passes over the active tiles only, until no cell is too steep. What is
/// left after a cycle are mostly small slides on their way down; where it is more, CheckConvergence asks for
/// another cycle. All rounds between two cycles have the same seams, those of the passes that would follow
/// the cycle.
template <class E>
void relax_until_converged(E& exec, const LevelView& fine, const AvalanchingParameters& p,
                           std::uint64_t step_count, Workspace& work) {
  using After = CheckConvergence::After;
  const Schedule plan = schedule(p, fine.grid);
  const bool by_gradient = p.scheme == AvalancheScheme::gradient;
  const float share = omega_in_rounds(p.scheme) * p.transfer;
  const ActiveTiles& active = work.active_tiles;
  Progress* const progress = active.progress.data();
  const auto check = [&](After after, int sweeps) {
    for_each_item(exec, 1,
                  CheckConvergence{progress, active.steep_counter(), p.max_iterations, after, sweeps});
  };
  const auto do_cycle = [&](std::uint64_t seams, After what) {
    ActiveTileFlags round{fine.grid, {}, active.flags(), active.max_tiles};
    for (int n = 0; n < passes_per_round; ++n) round.offsets[n] = seam_offset(seams, plan.fine_passes() + n);
    cycle(exec, fine, p, plan, seams, work, NoFollowUp{});
    update_active_tiles(exec, fine, p, round, false, active);
    check(what, plan.fine_sweeps());
    exec.repeat_while(&progress->more_rounds, [&] {
      for (int n = 0; n < passes_per_round; ++n)
        relax_tiles(exec,
                    RelaxTile{round.tiles_of_pass(n),
                              fine,
                              Prolong{},
                              {share, share},
                              max_sweeps_in_rounds,
                              0.0f,
                              round.flags_of_pass(n),
                              by_gradient,
                              first_shift(seams, plan.fine_passes() + n, by_gradient)},
                    NoFollowUp{});
      update_active_tiles(exec, fine, p, round, true, active);
      check(After::round, passes_per_round * max_sweeps_in_rounds);
    });
  };
  do_cycle(step_count, After::first_cycle);
  exec.repeat_while(&progress->more_cycles, [&] { do_cycle(step_count + 1, After::cycle); });
}

template <class E>
void sweep(E& exec, const LevelView& level, float transfer, bool by_tangent, Workspace& work) {
  give_and_receive(exec, level, transfer, by_tangent, work.share.data(), work.given.data(),
                   work.received.data());
  for_each_cell(exec, level.grid,
                ApplySweep{level.grid, work.given.data(), work.received.data(), level.sand});
}

/// The schemes of synchronous sweeps over the whole grid. Quality `converged` repeats them until the largest
/// excess is within the tolerance.
template <class E>
void sweep_all(E& exec, const LevelView& fine, const AvalanchingParameters& p, Workspace& work) {
  const auto unsettled = [&] { return max_cells(exec, fine.grid, Excess{fine}) > p.tolerance; };
  const bool by_tangent = p.scheme == AvalancheScheme::taylor_keyser;
  do {
    for (int n = 0; n < p.sweeps; ++n) sweep(exec, fine, transfer_of_sweep(p, n), by_tangent, work);
    work.iterations += p.sweeps;
  } while (p.quality == AvalancheQuality::converged && work.iterations < p.max_iterations && unsettled());
}

template <class E>
void step(E& exec, const TerrainView& t, const AvalanchingParameters& p, std::uint64_t tick,
          const float* repose, surface::Heights* heights, Workspace& work) {
  const LevelView fine = finest_level(t, repose);
  const bool converge = p.quality == AvalancheQuality::converged;
  work.iterations = 0;
  if (has_levels(p.scheme) && !converge) {
    const Schedule plan = schedule(p, t.grid);
    if (heights)
      cycle(exec, fine, p, plan, tick, work, surface::make_heights_law(t, *heights));
    else
      cycle(exec, fine, p, plan, tick, work, NoFollowUp{});
    work.iterations = plan.fine_sweeps();
    return;
  }
  if (has_levels(p.scheme))
    relax_until_converged(exec, fine, p, tick, work);
  else
    sweep_all(exec, fine, p, work);
  if (heights) surface::compute_heights(exec, t, *heights);
}

template void step(Backend&, const TerrainView&, const AvalanchingParameters&, std::uint64_t, const float*,
                   surface::Heights*, Workspace&);

}  // namespace desert_sim::avalanching
