/// The step of saltation.hpp; compiled once for each backend.
#include "kernels/sand/saltation.hpp"

#include "kernels/backend/loops.hpp"
#include "kernels/sand/saltation_laws.hpp"
#include "kernels/sand/tuned/saltation_fused.hpp"

namespace desert_sim::saltation {

template <bool bare, class E>
void step_where(E& exec, const TerrainView& t, const SaltationParameters& p, const ReposeParameters& repose,
                float time_step, const Dice& dice, LedgerView ledger, Quanta* landed,
                const abrasion::Abrade& abrade, const reptation::Impacts& impacts,
                const wind_shadow::Shadow* shadow_law) {
  const Inputs<bare> in(t, repose, time_step);
  Quanta *sand = t.quanta(Layer::sand), *airborne = t.quanta(Layer::airborne_sand);
  const LiftAndAdvect<bare> lift{
      in, p, time_step / t.grid.cell_size, dice[Roll::lift], dice[Roll::hop], sand, airborne, ledger};
  if (shadow_law)
    for_each_cell_scatter(exec, t.grid, landed, ShadowAndLift<bare>{*shadow_law, lift});
  else
    for_each_cell_scatter(exec, t.grid, landed, lift);
  if (!t.grid.periodic() && p.influx > 0.0f)
    for_each_cell(exec, t.grid, Influx<bare>{in, p.influx, dice[Roll::influx], landed, ledger});
  const Deposit<bare> deposit{in, p, abrade, dice[Roll::deposit], landed, sand, airborne, impacts};
  if constexpr (bare && !vectorises_rows<E>)
    if (t.grid.width % 4 == 0) {
      const DepositOfFour four{deposit};
      return for_each_cell(exec, four.fours(), four);
    }
  for_each_cell(exec, t.grid, deposit);
}

template <class E>
void step(E& exec, const TerrainView& t, const SaltationParameters& p, const AbrasionParameters& a,
          const ReposeParameters& repose, float time_step, const Dice& dice, LedgerView ledger,
          Quanta* landed, const reptation::Impacts& impacts, const wind_shadow::Shadow* shadow_law) {
  const abrasion::Abrade abrade{a.rate * time_step,
                                a.rate_of_soil() * time_step,
                                to_quanta_at_most(a.cover, t.quanta_per_metre, wall_height),
                                t.quantum,
                                t.quanta_per_metre,
                                t.quanta(Layer::bedrock),
                                t.quanta(Layer::soil),
                                t.quanta(Layer::sand),
                                t.real(Layer::erosion_resistance),
                                dice[Roll::abrasion],
                                ledger};
  if (is_bare(t, a))
    step_where<true>(exec, t, p, repose, time_step, dice, ledger, landed, abrade, impacts, shadow_law);
  else
    step_where<false>(exec, t, p, repose, time_step, dice, ledger, landed, abrade, impacts, shadow_law);
}

template void step(Backend&, const TerrainView&, const SaltationParameters&, const AbrasionParameters&,
                   const ReposeParameters&, float, const Dice&, LedgerView, Quanta*,
                   const reptation::Impacts&, const wind_shadow::Shadow*);

}  // namespace desert_sim::saltation
