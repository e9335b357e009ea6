/// The step of desertscape.hpp; compiled once for each backend.
#include "kernels/sand/desertscape.hpp"

#include <algorithm>

#include "kernels/backend/loops.hpp"
#include "kernels/sand/desertscape_laws.hpp"

namespace desert_sim::desertscape {

/// Wears ground by `bounced` sand, whatever part of a hop's time a step is.
inline abrasion::Abrade abrade_by_bounces(const TerrainView& t, const StepInputs& in, const Dice& dice,
                                          LedgerView ledger) {
  return saltation::abrade_for(t, in.abrasion, in.saltation.hop_time, dice[Roll::abrasion], ledger);
}

/// Moves what impacts set creeping. `change`: scratch.
template <class E>
void creep(E& exec, const TerrainView& t, const StepInputs& in, const Inputs<false>& layers, float slab,
           const Dice& dice, Quanta* change, const Workspace& work) {
  // The depth that came down on a cell is needed while the changes of sand are collected.
  for_each_item(exec, t.grid.cells(),
                CreepByImpacts{layers, reptation::creep_to_steepest(t, dice, change), 1.0f / slab,
                               in.creeping * t.quanta_per_metre, dice[Roll::creep_events], in.landed,
                               work.bounced.data()});
  for_each_cell(exec, t.grid, reptation::ApplyChange{t.grid, change, t.quanta(Layer::sand)});
}

template <class E>
void step(E& exec, const TerrainView& t, const StepInputs& in, const Dice& dice, LedgerView ledger,
          Workspace& work) {
  const SaltationParameters& p = in.saltation;
  const Inputs<false> layers(t, in.repose, p, in.echo, p.hop_time, in.time_step / p.hop_time);
  const Quanta slab =
      std::max(to_quanta_at_most(in.desertscape.slab, t.quanta_per_metre, load_limit), Quanta{1});
  Quanta *sand = t.quanta(Layer::sand), *airborne = t.quanta(Layer::airborne_sand);
  Quanta *aloft = work.aloft.data(), *bounced = work.bounced.data();
  exec.set_zero(in.landed, sizeof(Quanta) * static_cast<std::size_t>(t.grid.cells()));
  for_each_cell(exec, t.grid,
                LiftSlabs{layers, Lift<false>{layers, p}, layers.hop_share / static_cast<float>(slab), slab,
                          dice[Roll::lift], sand, airborne, aloft, bounced});
  for_each_item(exec, t.grid.cells(),
                FlySlabs{layers, DepositedShare<false>{layers, p}, p.hop_time / t.grid.cell_size,
                         p.hop_spread / t.grid.cell_size, slab, dice[Roll::hop], sand, aloft, in.landed,
                         bounced, airborne, ledger});
  if (!t.grid.periodic() && p.influx > 0.0f)
    for_each_cell(
        exec, t.grid,
        SlabInflux{Influx<false>{layers, p.influx, dice[Roll::influx], FilledHeight(t), in.landed, ledger},
                   slab});
  for_each_cell(exec, t.grid,
                SettleSlabs{layers, abrade_by_bounces(t, in, dice, ledger), in.landed, bounced, sand});
  if (t.real(Layer::flux_x))
    for_each_cell(exec, t.grid,
                  AddSlabFlux{layers, t.quantum * p.hop_time / in.flux_time, aloft, bounced,
                              t.real(Layer::flux_x), t.real(Layer::flux_y)});
  if (in.creeping > 0.0f) {
    work.aloft.set_zero();
    creep(exec, t, in, layers, static_cast<float>(slab), dice, aloft, work);
  }
}

template void step(Backend&, const TerrainView&, const StepInputs&, const Dice&, LedgerView, Workspace&);

}  // namespace desert_sim::desertscape
