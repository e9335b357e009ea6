#pragma once
/// Frost weathering: a process that is made up for made_up_process_test.cpp, which shows that a process costs
/// one header (this one), one row, and one test.
///
///   rate · Δt of bare rock becomes sand
///
/// Reads bedrock, soil, sand; writes bedrock, sand.

#include "kernels/backend/for_each_cpu.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/ledger.hpp"
#include "src/core/parameter_table.hpp"

namespace desert_sim::test {

struct FrostParameters {
  bool enabled = false;
  float rate = 0.001f;
};
constexpr auto parameter_table(const FrostParameters*) {
  using P = FrostParameters;
  return std::make_tuple(
      parameter("enabled", &P::enabled, "Whether frost breaks bare rock to sand."),
      parameter("rate", &P::rate, 0, 1, "m/s", "Depth of bare rock that breaks a second."));
}
static_assert(table_is_complete<FrostParameters>());

struct Frost {
  Grid grid;
  float metres, quanta_per_metre;
  const Quanta* soil;
  Quanta *bedrock, *sand;
  LedgerView ledger;

  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    if (value_or_zero(soil, i) > 0 || sand[i] > 0) return;
    const Quanta broken = to_quanta_at_most(metres, quanta_per_metre, bedrock[i] + wall_height);
    bedrock[i] -= broken;
    sand[i] += broken;
    ledger.convert(Material::bedrock, Material::sand, i, broken);
  }
};

inline void frost_step(CpuExec& exec, const TerrainView& t, const FrostParameters& p, float time_step,
                       LedgerView ledger) {
  for_each_cell(exec, t.grid,
                Frost{t.grid, p.rate * time_step, t.quanta_per_metre, t.quanta(Layer::soil),
                      t.quanta(Layer::bedrock), t.quanta(Layer::sand), ledger});
}

}  // namespace desert_sim::test
