/// The step of continuum.hpp; compiled once for each backend.
#include "kernels/sand/continuum.hpp"

#include "kernels/backend/loops.hpp"
#include "kernels/sand/continuum_laws.hpp"

namespace desert_sim::continuum {

template <bool inside, bool bare>
Prepare<inside, bare> prepare(const TerrainView& t, const StepInputs& in, const Downwind& order,
                              const Drift& drift, const Dice& dice, LedgerView ledger,
                              const Workspace& work) {
  const ContinuumParameters& p = in.continuum;
  const float l = t.grid.cell_size;
  return {saltation::Inputs<bare>(t, in.repose, in.saltation, in.echo, 1.0f, 1.0f),
          order,
          drift,
          SaturatedFlux(p, shear_stress::shear_velocity_per_wind(in.stress)),
          p.plant_drag,
          1.0f / p.slope_friction,
          l / static_cast<float>(saturation_length(p)),
          in.time_step / l * t.quanta_per_metre,
          in.time_step * t.quanta_per_metre,
          t.quantum / l,
          in.saltation.influx,
          dice[Roll::influx],
          ledger,
          in.heights,
          t.quanta(Layer::sand),
          t.quanta(Layer::airborne_sand),
          SweepFields(work)};
}

template <bool inside>
LinearGain<inside> linear_gain(const Grid& lines, const StepInputs& in, const Drift& drift,
                               const Workspace& work) {
  const float way = lines.cell_size * sqrtf(1.0f + drift.shift * drift.shift);
  return {lines,
          drift,
          place_of_mean(way / static_cast<float>(saturation_length(in.continuum))),
          work.level_gain.data(),
          work.decay.data(),
          work.gain.data()};
}

template <bool inside, bool bare>
Settle<inside, bare> settle(const TerrainView& t, const StepInputs& in, const Downwind& order,
                            const Drift& drift, const Dice& dice, LedgerView ledger, const Workspace& work) {
  const abrasion::Abrade abrade =
      saltation::abrade_for(t, in.abrasion, in.time_step, dice[Roll::abrasion], ledger);
  return {saltation::Inputs<bare>(t, in.repose, in.saltation, in.echo, 1.0f, 1.0f),
          order,
          drift,
          SweepFields(work),
          abrade,
          ledger,
          t.quanta(Layer::sand),
          t.quanta(Layer::airborne_sand),
          t.quantum * t.grid.cell_size / in.time_step,
          in.time_step / in.flux_time,
          t.real(Layer::flux_x),
          t.real(Layer::flux_y),
          in.impact_strength};
}

template <bool bare, class E>
void step(E& exec, const TerrainView& t, const StepInputs& in, const Dice& dice, LedgerView ledger,
          Workspace& work) {
  const Downwind order(t.grid, in.above);
  const Drift drift(order, in.above);
  for_each_cell(exec, t.grid,
                Lead{t.grid, order, drift, t.real(Layer::wind_x), t.real(Layer::wind_y), work.lead.data()});
  for_each_cell(exec, t.grid,
                Bordered<Prepare<true, bare>, Prepare<false, bare>>{
                    t.grid, margin, prepare<true, bare>(t, in, order, drift, dice, ledger, work),
                    prepare<false, bare>(t, in, order, drift, dice, ledger, work)});
  const Grid lines{order.length(), order.lines(), t.grid.cell_size, order.periodic_across(),
                   order.periodic_along()};
  for_each_cell(
      exec, lines,
      Bordered<LinearGain<true>, LinearGain<false>>{lines, margin, linear_gain<true>(lines, in, drift, work),
                                                    linear_gain<false>(lines, in, drift, work)});
  const PassSand<true> inside{order, drift, dice[Roll::lift], SweepFields(work)};
  const PassSand<false> ends{order, drift, dice[Roll::lift], SweepFields(work)};
  for_each_line_in_turn(exec, 0, order.lines(), order.length(), work.lines.data(),
                        LineWithEnds(inside, ends, order.length()));
  for_each_cell(exec, t.grid,
                Bordered<Settle<true, bare>, Settle<false, bare>>{
                    t.grid, margin, settle<true, bare>(t, in, order, drift, dice, ledger, work),
                    settle<false, bare>(t, in, order, drift, dice, ledger, work)});
}

template <class E>
void step(E& exec, const TerrainView& t, const StepInputs& in, const Dice& dice, LedgerView ledger,
          Workspace& work) {
  if (saltation::is_bare(t, in.abrasion))
    step<true>(exec, t, in, dice, ledger, work);
  else
    step<false>(exec, t, in, dice, ledger, work);
}

template void step(Backend&, const TerrainView&, const StepInputs&, const Dice&, LedgerView, Workspace&);

}  // namespace desert_sim::continuum
