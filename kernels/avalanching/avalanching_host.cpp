#include "kernels/avalanching/avalanching.hpp"
#include "kernels/avalanching/soil_and_bedrock.hpp"

namespace desert_sim::avalanching {

namespace {
/// Smallest width and height of a coarse level [cells]; coarser ones would not fill half a tile.
constexpr int min_level_cells = 16;

/// The grid with cells twice as wide. If an axis has an odd number of cells, the last one has no coarse cell:
/// the coarse level ends in a wall there, and only finer levels relax it.
Grid coarser(const Grid& g) {
  return Grid{g.width / 2, g.height / 2, 2 * g.cell_size, g.periodic_x && g.width % 2 == 0,
              g.periodic_y && g.height % 2 == 0};
}

/// Width of the coarsest level's cells, in those of the grid, where the scenario leaves it open. Each level
/// more lets a slide run on where a finer one would have stopped it: a column on cells of 0.5 m ends as a
/// cone of 12.6 m with levels up to 4 m, and of 13.9 m with levels up to 2 m.
constexpr float coarsest_cells = 4.0f;

/// Grids of the coarse levels, the finest first.
std::vector<Grid> coarse_grids(const Grid& grid, const AvalanchingParameters& p) {
  std::vector<Grid> grids;
  const float coarsest = p.coarsest_cell > 0.0f ? p.coarsest_cell : coarsest_cells * grid.cell_size;
  Grid g = grid;
  while (g.cell_size < coarsest * 0.999f && g.width / 2 >= min_level_cells &&
         g.height / 2 >= min_level_cells) {
    g = coarser(g);
    grids.push_back(g);
  }
  return grids;
}
}  // namespace

Schedule schedule(const AvalanchingParameters& p, const Grid& grid) {
  constexpr int few_cells = 1 << 18;
  Schedule plan = preset(p.quality);
  const bool by_gradient = p.scheme == AvalancheScheme::gradient;
  if (p.last_passes > 0) {
    plan.last_passes = p.last_passes;
  } else if (p.quality == AvalancheQuality::good && grid.cells() <= few_cells) {
    plan.last_sweeps = 7, plan.two_pass_levels = 0, plan.coarse_share = 0.6f;
    if (by_gradient) plan.first_sweeps = 4, plan.last_sweeps = 6;
  } else if (p.quality == AvalancheQuality::good && by_gradient) {
    plan.last_passes = 2;
  }
  return plan;
}

Workspace make_workspace(Exec& exec, const Grid& grid, const AvalanchingParameters& p) {
  Workspace work;
  const std::size_t cells = static_cast<std::size_t>(grid.cells());
  if (!has_levels(p.scheme)) {
    work.share = Buffer<float>(exec, cells);
    work.given = Buffer<Quanta>(exec, cells);
    work.received = Buffer<Quanta>(exec, cells);
    return work;
  }
  if (p.quality == AvalancheQuality::converged) work.active_tiles = make_active_tiles(exec, grid);
  for (const Grid& g : coarse_grids(grid, p)) {
    const std::size_t n = static_cast<std::size_t>(g.cells());
    work.coarse.push_back({g, Buffer<Quanta>(exec, n), Buffer<Quanta>(exec, n), Buffer<Quanta>(exec, n),
                           Buffer<float>(exec, n)});
  }
  return work;
}

GroundWorkspace make_ground_workspace(Exec& exec, const Grid& grid) {
  const std::size_t n = static_cast<std::size_t>(grid.cells());
  return {Buffer<Quanta>(exec, n), Buffer<float>(exec, n)};
}

std::size_t Workspace::bytes() const {
  std::size_t total = share.bytes() + given.bytes() + received.bytes() +
                      active_tiles.blocks_to_check.bytes() + active_tiles.check_buffer.bytes() +
                      active_tiles.progress.bytes();
  for (const Level& level : coarse)
    total += level.ground.bytes() + level.sand.bytes() + level.sand_before.bytes() + level.repose.bytes();
  return total;
}

}  // namespace desert_sim::avalanching
