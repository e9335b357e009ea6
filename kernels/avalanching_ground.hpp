#pragma once
/// Avalanching of soil and of bedrock: one synchronous iteration a step, where they changed. Physics.md
/// B6–B7.
///
/// Soil slides over rock at its own angle (45° bare … 68° under vegetation), by the laws of
/// avalanching_laws.hpp. Bedrock breaks where it is steeper than `bedrock_deg`, by its own height alone, and
/// falls as sand or as rock. Reads and writes bedrock, soil, sand.

#include "desert_sim/kernels/avalanching.hpp"
#include "desert_sim/kernels/ledger.hpp"
#include "desert_sim/kernels/repose.hpp"

namespace desert_sim::avalanching {

struct SoilRepose {
  Grid grid;
  repose::Tangents tangents;
  const float* vegetation;
  float* repose;
  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    repose[i] = lerp(tangents.soil, tangents.soil_vegetated, value_or_zero(vegetation, i));
  }
};

/// Bedrock seen as material that can all move: `sand` of the level is the rock's height above the lowest
/// possible.
constexpr Quanta lowest_ground = 1 - wall_height;

struct RockColumn {
  Grid grid;
  const Quanta* bedrock;
  float tangent;
  Quanta *ground, *column;
  float* repose;
  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    ground[i] = lowest_ground;
    column[i] = bedrock[i] - lowest_ground;
    repose[i] = tangent;
  }
};

struct ApplyRockfall {
  Grid grid;
  const Quanta *given, *received;
  bool to_sand;
  Quanta *bedrock, *sand;
  LedgerView ledger;
  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    if (given[i] == 0 && received[i] == 0) return;
    bedrock[i] -= given[i];
    (to_sand ? sand : bedrock)[i] += received[i];
    if (to_sand) {
      ledger.book_out(Material::bedrock, i, given[i]);
      ledger.book_in(Material::sand, i, received[i]);
    }
  }
};

/// Scratch for the ground's avalanches: one value a cell each.
struct GroundWorkspace {
  Buffer<Quanta> ground, column, given, received;
  Buffer<float> repose, share;
};
GroundWorkspace make_ground_workspace(Exec& exec, const Grid& grid);

template <class E>
void step_soil(E& exec, const TerrainView& t, const AvalanchingParameters& p, const ReposeParameters& repose,
               GroundWorkspace& work) {
  for_each_cell(exec, t.grid,
                SoilRepose{t.grid, repose::Tangents(repose), t.real(Layer::vegetation), work.repose.data()});
  const LevelView level{t.grid,
                        t.quanta(Layer::bedrock),
                        nullptr,
                        t.real(Layer::obstacle),
                        t.quanta(Layer::soil),
                        work.repose.data(),
                        t.grid.cell_size * t.quanta_per_metre};
  for_each_cell(exec, t.grid, Release{level, p.transfer, false, work.share.data(), work.given.data()});
  for_each_cell(exec, t.grid,
                Gather{level, false, work.share.data(), work.given.data(), work.received.data()});
  for_each_cell(exec, t.grid,
                ApplySweep{t.grid, work.given.data(), work.received.data(), t.quanta(Layer::soil)});
}

template <class E>
void step_bedrock(E& exec, const TerrainView& t, const AvalanchingParameters& p,
                  const ReposeParameters& repose, LedgerView ledger, GroundWorkspace& work) {
  for_each_cell(exec, t.grid,
                RockColumn{t.grid, t.quanta(Layer::bedrock), repose::Tangents(repose).bedrock,
                           work.ground.data(), work.column.data(), work.repose.data()});
  const LevelView level{t.grid,
                        work.ground.data(),
                        nullptr,
                        t.real(Layer::obstacle),
                        work.column.data(),
                        work.repose.data(),
                        t.grid.cell_size * t.quanta_per_metre};
  for_each_cell(exec, t.grid, Release{level, p.transfer, false, work.share.data(), work.given.data()});
  for_each_cell(exec, t.grid,
                Gather{level, false, work.share.data(), work.given.data(), work.received.data()});
  for_each_cell(exec, t.grid,
                ApplyRockfall{t.grid, work.given.data(), work.received.data(), p.bedrock_to_sand,
                              t.quanta(Layer::bedrock), t.quanta(Layer::sand), ledger});
}

}  // namespace desert_sim::avalanching
