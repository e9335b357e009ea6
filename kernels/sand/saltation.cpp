/// The step of saltation.hpp; compiled once for each backend.
#include "kernels/sand/saltation.hpp"

#include "kernels/backend/loops.hpp"
#include "kernels/sand/saltation_laws.hpp"
#include "kernels/sand/tuned/saltation_fused.hpp"

namespace desert_sim::saltation {

struct SaltationDice {
  Die lift, wait, landing, influx, deposit;

  SaltationDice(const Dice& dice, int part)
      : lift(dice[Roll::lift].of_part(part)),
        wait(dice[Roll::hop_share].of_part(part)),
        landing(dice[Roll::hop].of_part(part)),
        influx(dice[Roll::influx].of_part(part)),
        deposit(dice[Roll::deposit].of_part(part)) {}
};

/// One part of a step; see Hops.
template <bool bare, class E>
void hop(E& exec, const TerrainView& t, const StepInputs& inputs, float hop_share, const SaltationDice& dice,
         LedgerView ledger, const abrasion::Abrade& abrade) {
  const SaltationParameters& p = inputs.saltation;
  const Inputs<bare> in(t, inputs.repose, p, inputs.echo, p.hop_time, hop_share);
  const Lift<bare> lift{in, p};
  Quanta *sand = t.quanta(Layer::sand), *airborne = t.quanta(Layer::airborne_sand), *landed = inputs.landed;
  const LiftAndAdvect<bare> advect{
      in, lift, p.hop_time / t.grid.cell_size, dice.lift, dice.wait, dice.landing, sand, airborne, ledger};
  if (t.real(Layer::flux_x))
    for_each_cell(exec, t.grid,
                  AddFlux<bare>{advect, t.quantum * p.hop_time / inputs.flux_time, t.real(Layer::flux_x),
                                t.real(Layer::flux_y)});
  if (inputs.shadow)
    for_each_cell_scatter(exec, t.grid, landed, ShadowAndLift<bare>{*inputs.shadow, advect});
  else
    for_each_cell_scatter(exec, t.grid, landed, advect);
  if (!t.grid.periodic() && p.influx > 0.0f)
    for_each_cell(exec, t.grid, Influx<bare>{in, p.influx, dice.influx, FilledHeight(t), landed, ledger});
  const Deposit<bare> deposit{
      in, lift, abrade, dice.deposit, Landing(t.grid, landed, p.hop_spread), sand, airborne, inputs.impacts};
  if constexpr (bare && !vectorises_rows<E>)
    if (t.grid.width % 4 == 0) {
      const DepositOfFour four{deposit};
      return for_each_cell(exec, four.fours(), four);
    }
  for_each_cell(
      exec, t.grid,
      Bordered<DepositOfOne<bare, true>, DepositOfOne<bare, false>>{t.grid, 1, {deposit}, {deposit}});
}

template <class E>
void step(E& exec, const TerrainView& t, const StepInputs& inputs, const Dice& dice, LedgerView ledger) {
  StepInputs in = inputs;
  const Hops hops(in.saltation, in.time_step);
  const float part_of_step = in.time_step / static_cast<float>(hops.parts);
  abrasion::Abrade abrade = abrade_for(t, in.abrasion, part_of_step, dice[Roll::abrasion], ledger);
  for (int part = 0; part < hops.parts; ++part) {
    const SaltationDice of_part(dice, part);
    abrade.die = dice[Roll::abrasion].of_part(part);
    if (is_bare(t, in.abrasion))
      hop<true>(exec, t, in, hops.share, of_part, ledger, abrade);
    else
      hop<false>(exec, t, in, hops.share, of_part, ledger, abrade);
    in.shadow = nullptr;  // the first part has left it in the layer
  }
}

template void step(Backend&, const TerrainView&, const StepInputs&, const Dice&, LedgerView);

struct Clear {
  Grid grid;
  float *x_part, *y_part;
  DESERT_HD void operator()(int x, int y) const {
    x_part[grid.index(x, y)] = 0.0f;
    y_part[grid.index(x, y)] = 0.0f;
  }
};

template <class E>
void clear_flux(E& exec, const TerrainView& t) {
  for_each_cell(exec, t.grid, Clear{t.grid, t.real(Layer::flux_x), t.real(Layer::flux_y)});
}

template void clear_flux(Backend&, const TerrainView&);

}  // namespace desert_sim::saltation
