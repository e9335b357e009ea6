/// The step of wang.hpp; compiled once for each backend.
#include "kernels/particles/wang.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/backend/loops.hpp"
#include "kernels/particles/wang_laws.hpp"
#include "src/core/elementary.hpp"

namespace desert_sim::particles {

template <class E>
void blow(E& exec, const TerrainView& t, wind::Vector above) {
  for_each_cell(exec, t.grid, wind::Blow{t.grid, above, t.real(Layer::wind_x), t.real(Layer::wind_y)});
}

/// Measures the surface, and finds the shelter in one sweep downwind: over a periodic edge in two rounds.
template <class E>
void find_shelter(E& exec, const TerrainView& t, const StepInputs& in, const Downwind& order,
                  Workspace& work) {
  for_each_cell(exec, t.grid,
                MeasureSurface{order, t.quanta(Layer::bedrock), t.quanta(Layer::soil), t.quanta(Layer::sand),
                               work.columns.data()});
  const float shift = order.shift(in.above.x, in.above.y);
  const double way = elementary::hypot(1, shift) * static_cast<double>(t.grid.cell_size);
  const double fall =
      elementary::tan_deg(in.particle.shelter_deg) * way * static_cast<double>(t.quanta_per_metre);
  const auto whole_fall =
      static_cast<Quanta>(std::lround(std::clamp(fall, 1.0, static_cast<double>(wall_height))));
  const double renewal = -elementary::expm1(-way / static_cast<double>(in.particle.upwind_length));
  const FindShelter find{order, to_fixed_point(shift), whole_fall, static_cast<float>(renewal),
                         work.columns.data()};
  for_each_line_in_turn(exec, order.periodic_along() ? -order.lines() : 0, order.lines(), order.length(),
                        work.lines.data(), find);
}

inline Flights make_flights(const TerrainView& t, const StepInputs& in, const Downwind& order,
                            const Wind& wind, LedgerView ledger, const Workspace& work) {
  const ParticleParameters& p = in.particle;
  return {order,
          work.columns.data(),
          t.quantum,
          t.quanta_per_metre,
          wind.air,
          make_starts(p),
          p.normal_restitution,
          p.tangential_restitution,
          least_rise(p),
          t.real(Layer::obstacle),
          work.landed.data(),
          ledger};
}

inline LiftOff make_lift_off(const TerrainView& t, const StepInputs& in, const Flights& flights,
                             const Loose& loose, const Wind& wind, const Dice& dice, const Workspace& work) {
  const float u = wind.shear_velocity, excess = u * u - wind.threshold * wind.threshold;
  const float quanta = in.time_step * t.quanta_per_metre;
  const float entering = in.saltation.influx * quanta / t.grid.cell_size;
  return {flights,
          loose,
          u,
          wind.threshold * wind.threshold,
          excess > 0.0f ? wind.lift_rate * quanta / excess : 0.0f,
          in.particle.shear_height * in.particle.grain_diameter,
          in.particle.exposed_height,
          wind.exposure,
          entering * std::fabs(wind.air.along_x),
          entering * std::fabs(wind.air.along_y),
          in.particle.splash_number / std::sqrt(in.particle.gravity * in.particle.grain_diameter),
          in.particle.most_bounces,
          dice[Roll::particle_lift],
          dice[Roll::influx],
          dice[Roll::particle_flight],
          work.impacts.data(),
          work.splash.data()};
}

inline Loose make_loose(const TerrainView& t, const StepInputs& in) {
  return {t.quanta(Layer::sand),
          t.real(Layer::vegetation),
          t.quanta(Layer::water),
          t.quantum,
          repose::RelativeMoisture(t, in.repose),
          saltation::Dryness(in.saltation.moisture_cutoff)};
}

template <class E>
void trace(E& exec, const TerrainView& t, const StepInputs& in, const Dice& dice, Workspace& work,
           const GrainPaths& paths) {
  const Wind wind(in.particle, in.above);
  if (!(wind.shear_velocity > 0.0f)) {
    for_each_item(exec, paths.number, NoPath{paths});
    return;
  }
  const Downwind order(t.grid, in.above);
  find_shelter(exec, t, in, order, work);
  const Flights flights = make_flights(t, in, order, wind, {}, work);
  for_each_item(
      exec, paths.number,
      TraceGrain{make_lift_off(t, in, flights, make_loose(t, in), wind, dice, work), paths, t.quantum});
}

template <class E>
void step(E& exec, const TerrainView& t, const StepInputs& in, const Dice& dice, LedgerView ledger,
          Workspace& work) {
  blow(exec, t, in.above);
  for (Buffer<Quanta>* sums : {&work.impacts, &work.splash, &work.landed}) sums->set_zero();
  const Wind wind(in.particle, in.above);
  if (wind.shear_velocity > 0.0f) {
    const Downwind order(t.grid, in.above);
    find_shelter(exec, t, in, order, work);
    const Flights flights = make_flights(t, in, order, wind, ledger, work);
    const Loose loose = make_loose(t, in);
    for_each_item(exec, t.grid.cells(), make_lift_off(t, in, flights, loose, wind, dice, work));
    if (in.particle.splash_number > 0.0f)
      for_each_item(
          exec, t.grid.cells(),
          Splash{flights, loose,
                 std::sqrt(in.particle.gravity * in.particle.grain_diameter) / in.particle.splash_number,
                 in.particle.creep_length / (t.grid.cell_size * t.grid.cell_size),
                 dice[Roll::particle_splash], dice[Roll::particle_hop], dice[Roll::particle_creep],
                 work.impacts.data(), work.splash.data()});
  }
  for_each_cell(exec, t.grid,
                Settle{t.grid, t.quantum, work.landed.data(), t.quanta(Layer::sand), in.impact_strength});
}

template void blow(Backend&, const TerrainView&, wind::Vector);
template void trace(Backend&, const TerrainView&, const StepInputs&, const Dice&, Workspace&,
                    const GrainPaths&);
template void step(Backend&, const TerrainView&, const StepInputs&, const Dice&, LedgerView, Workspace&);

}  // namespace desert_sim::particles
