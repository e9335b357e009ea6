#pragma once
/// How water moves through faces once their fluxes are known; both models of water share it
/// (virtual_pipes.hpp, shallow_water.hpp).
///
///   depth      w += Δt (Σ q_in − Σ q_out)/l²,   where a cell's outflow is limited to its water
///   velocity   U_x = ½(q_west + q_east)/(l w),   U_y = ½(q_south + q_north)/(l w)
///   waves      a_wave = s (1 − e^(−½ (w/d)²)) max(sin 2π t/T, 0) · ½(u_i + u_j)
///
/// u is the wind's component along the flux. In the waves w is the mean depth of both cells, d =
/// `wave_depth`; in the velocity it is the mean depth of the sub-step, and films have none. Amounts are
/// rounded to quanta by dice that turn regularly (dice.hpp), alike from both sides of a face, so that none
/// is lost and no flow is too small for a short step; up to three quanta of a cell wait for more, because
/// four faces may round as much up. Over open edges water leaves as over a sill, at the speed √(g w) or as
/// fast as it flows through the cell, down to the level of the sea where there is one.
///
/// Each sub-step begins and ends with the sea at its level (water_sources.hpp): filled once a step, it would
/// give less the longer the step is.

#include <cmath>
#include <cstdint>

#include "kernels/backend/for_each.hpp"
#include "kernels/base/math.hpp"
#include "kernels/field/dice.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/ledger.hpp"
#include "kernels/water/face_flow.hpp"
#include "kernels/water/sediment_transport.hpp"
#include "kernels/water/water_parameters.hpp"
#include "src/core/elementary.hpp"

namespace desert_sim::face_flow {

struct StepInputs {
  float time_step;           ///< [s]
  double time;               ///< of the waves [s]
  std::uint64_t seed, tick;  ///< key and counter (steps done) of the dice
  Quanta sea_level;
  Quanta* carried;  ///< scratch, one value a cell
};

/// Acceleration of the water by the wind.
struct Waves {
  float strength;          ///< at the current time: s max(sin 2π t/T, 0) [1/s]
  float per_depth_square;  ///< 1/(8 d²), of the sum of two depths [1/m²]
  const float *wind_x, *wind_y;

  /// [m/s²], between two cells with these depths; `wind`: its component along the flux.
  DESERT_HD float pull(const FlowFields& flow, int i, int j, const float* wind) const {
    const float both = static_cast<float>(sum_of_depths(flow.water[i], flow.water[j])) * flow.quantum;
    return strength * (1.0f - exp_negative(per_depth_square * both * both)) * 0.5f * (wind[i] + wind[j]);
  }
};

/// The waves `time` seconds after the run began.
inline Waves waves_at(double time, const WaterParameters& p, const TerrainView& t) {
  const double phase_deg = 360 * (std::fmod(time, p.wave_period) / p.wave_period);
  const float swell =
      p.wave_strength * static_cast<float>(std::fmax(elementary::direction_deg(phase_deg).y, 0.0));
  return {swell, 0.125f / (p.wave_depth * p.wave_depth), t.real(Layer::wind_x), t.real(Layer::wind_y)};
}

/// The coefficient of the bed's drag, − c_d |u| u/h: Chézy's c_f, plus Manning's g n²/h^⅓.
struct BedDrag {
  float chezy, manning;  ///< c_f, g n² [m^⅓]
  explicit BedDrag(const WaterParameters& p) : chezy(p.drag), manning(p.gravity * p.manning * p.manning) {}
  DESERT_HD float of(float depth) const {
    return manning > 0.0f ? chezy + manning / power(depth, 1.0f / 3.0f) : chezy;
  }
};

/// What the drag of the bed leaves of a speed or a flux in an implicit step: v + k |v| v = speed.
DESERT_HD float dragged(float speed, float k) {
  return 2.0f * speed / (1.0f + sqrtf(1.0f + 4.0f * k * fabsf(speed)));
}
/// The share that it leaves of a velocity's components.
DESERT_HD float left_by_drag(float speed, float k) { return 2.0f / (1.0f + sqrtf(1.0f + 4.0f * k * speed)); }

/// Finds the share of its outflow that a cell has water for, and that is not too fast.
template <bool inside>
struct LimitOutflow {
  Flow<inside> flow;
  DESERT_HD void operator()(int x, int y) const {
    const int i = flow.grid.index(x, y);
    const typename Flow<inside>::Faces f = flow.faces(x, y);
    const float out = (maximum(f.to_east, 0.0f) + maximum(f.to_west, 0.0f)) +
                      (maximum(f.to_north, 0.0f) + maximum(f.to_south, 0.0f));
    const float available = static_cast<float>(flow.water[i]);
    float share = minimum(spare(available) / (out + 1e-20f), 1.0f);
    if (flow.most_froude > 0.0f)
      share = minimum(
          share, flow.outflow_at(flow.most_froude, available) / (Flow<inside>::to_neighbours(f) + 1e-20f));
    flow.supply_share[i] = share;
    if (!flow.sediment) return;
    const float carried = static_cast<float>(flow.sediment[i]);
    flow.sediment_share[i] = minimum(carried * share / (available + 1e-20f), spare(carried) / (out + 1e-20f));
  }
  /// What may leave of so many quanta, so that whole quanta through four faces do not exceed them.
  DESERT_HD static float spare(float quanta) {
    constexpr float guard = 1.0f - 1.0f / 1048576.0f;  // sums are rounded
    return maximum(quanta * guard - rounding_of_faces, 0.0f);
  }
};

/// Moves water through all faces of a cell, and computes its velocity.
template <bool inside>
struct MoveWater {
  Flow<inside> flow;
  float *velocity_x, *velocity_y;
  LedgerView ledger;

  DESERT_HD void operator()(int x, int y) const {
    const int i = flow.grid.index(x, y);
    const typename Flow<inside>::Faces f = flow.shared(x, y, flow.supply_share);
    const Quanta e = flow.die_x.whole(f.to_east, i), w = flow.die_x.whole(f.to_west, flow.face_to(i, f.west));
    const Quanta n = flow.die_y.whole(f.to_north, i),
                 s = flow.die_y.whole(f.to_south, flow.face_to(i, f.south));
    const Quanta before = flow.water[i], after = before - ((e + w) + (n + s));
    flow.water[i] = after;
    if (flow.sediment) flow.sediment[i] = flow.sediment_next[i];
    if (!inside) {
      const Quanta over =
          (f.east < 0 ? e : 0) + (f.west < 0 ? w : 0) + (f.north < 0 ? n : 0) + (f.south < 0 ? s : 0);
      ledger.book_out(Material::water, i, over);
    }
    // Mean flux of two opposite faces over the mean depth of the sub-step; films have no velocity.
    const auto depth = static_cast<Quanta>(sum_of_depths(before, after) / 2);
    const float per = depth * flow.quantum > film
                          ? 0.5f * flow.grid.cell_size / (static_cast<float>(depth) * flow.time_step)
                          : 0.0f;
    velocity_x[i] = (f.to_east - f.to_west) * per;
    velocity_y[i] = (f.to_north - f.to_south) * per;
  }
};

/// The fields of a step; time_step and dice are those of a sub-step, set by begin_substep().
inline FlowFields flow_fields(const TerrainView& t, const WaterParameters& p, const StepInputs& in,
                              float* supply_share) {
  FlowFields flow{};
  flow.grid = t.grid;
  flow.quantum = t.quantum;
  flow.quanta_per_metre = t.quanta_per_metre;
  flow.gravity = p.gravity;
  flow.sea = p.sea != Sea::none;
  flow.sea_level = in.sea_level;
  flow.bedrock = t.quanta(Layer::bedrock);
  flow.soil = t.quanta(Layer::soil);
  flow.sand = t.quanta(Layer::sand);
  flow.water = t.quanta(Layer::water);
  flow.flux_x = t.real(Layer::water_flux_x);
  flow.flux_y = t.real(Layer::water_flux_y);
  flow.supply_share = supply_share;
  flow.sediment = t.quanta(Layer::suspended_sediment);
  flow.sediment_next = in.carried;
  flow.sediment_share = t.real(Layer::water_velocity_x);  // it has no other use until the water has moved
  return flow;
}

/// `turn`: number of the sub-step, which the dice turn by.
inline void begin_substep(FlowFields& flow, float time_step, std::uint64_t seed, std::uint64_t turn) {
  flow.time_step = time_step;
  flow.die_x = dice::regular(seed, Roll::pipe_x, turn);
  flow.die_y = dice::regular(seed, Roll::pipe_y, turn);
}

/// Moves water and its sediment by the fluxes of a sub-step.
template <class E>
void move(E& exec, const TerrainView& t, const FlowFields& flow, std::uint64_t seed, std::uint64_t turn,
          LedgerView ledger) {
  for_each_flow<LimitOutflow>(exec, flow);
  if (flow.sediment)
    for_each_flow<CarrySediment>(exec, flow, ledger, dice::regular(seed, Roll::sediment_x, turn),
                                 dice::regular(seed, Roll::sediment_y, turn));
  for_each_flow<MoveWater>(exec, flow, t.real(Layer::water_velocity_x), t.real(Layer::water_velocity_y),
                           ledger);
}

}  // namespace desert_sim::face_flow
