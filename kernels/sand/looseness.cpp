/// The laws and the steps of looseness.hpp; compiled once for each backend.
#include "kernels/sand/looseness.hpp"

#include "kernels/backend/for_each.hpp"
#include "kernels/backend/loops.hpp"

namespace desert_sim::looseness {

struct Record {
  Grid grid;
  const Quanta* sand;
  Quanta* before;
  DESERT_HD void operator()(int x, int y) const { before[grid.index(x, y)] = sand[grid.index(x, y)]; }
};

struct DepositAndPack {
  Grid grid;
  float quantum, per_fresh_depth;  ///< 1/d [1/m]
  float packing;                   ///< Δt/(T d_i) [1/m]
  float firming;                   ///< k_f Δt
  Quanta bare;
  repose::RelativeMoisture moisture;
  const Quanta* sand;
  const float *impacts, *wind_shadow;
  Quanta* before;
  float* looseness;

  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    const Quanta depth = sand[i];
    const float gain = static_cast<float>(depth - before[i]) * quantum;
    const float wet = depth < bare ? 1.0f : minimum(2.0f * moisture(i), 1.0f);
    const float hit = impacts[i] * (1.0f - value_or_zero(wind_shadow, i));
    looseness[i] = after(looseness[i], maximum(gain, 0.0f) * per_fresh_depth, packing * hit + firming * wet);
    before[i] = depth;
  }
};

struct Slide {
  Grid grid;
  float quantum, per_fresh_depth;
  repose::Tangents tangents;
  repose::RelativeMoisture moisture;
  const float *vegetation, *present_tangents;
  const Quanta *sand, *before;
  float* looseness;

  /// The share of what slid that did so because it was steep, and not because impacts made it creep.
  DESERT_HD float avalanche_share(int i) const {
    const float at_rest = lerp(tangents.sand, tangents.vegetated, value_or_zero(vegetation, i)) *
                          tangents.moisture_factor(moisture(i));
    return clamp(2.0f * present_tangents[i] / at_rest - 1.0f, 0.0f, 1.0f);
  }
  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    const float slid = fabsf(static_cast<float>(sand[i] - before[i])) * quantum;
    looseness[i] = loosened(looseness[i], slid * avalanche_share(i) * per_fresh_depth);
  }
};

struct Fill {
  Grid grid;
  float value;
  float* looseness;
  DESERT_HD void operator()(int x, int y) const { looseness[grid.index(x, y)] = value; }
};

template <class E>
void record(E& exec, const TerrainView& t, Quanta* before) {
  for_each_cell(exec, t.grid, Record{t.grid, t.quanta(Layer::sand), before});
}

template <class E>
void step(E& exec, const TerrainView& t, const LoosenessParameters& p, const ReposeParameters& repose,
          const StepInputs& in, Quanta* before) {
  for_each_cell(exec, t.grid,
                DepositAndPack{t.grid, t.quantum, 1.0f / p.fresh_depth,
                               in.time_step / (in.hop_time * p.impact_depth), p.firming * in.time_step,
                               to_quanta_at_most(p.bare_depth, t.quanta_per_metre, wall_height),
                               repose::RelativeMoisture(t, repose), t.quanta(Layer::sand), in.impacts,
                               t.real(Layer::wind_shadow), before, t.real(Layer::looseness)});
}

template <class E>
void slides(E& exec, const TerrainView& t, const LoosenessParameters& p, const ReposeParameters& repose,
            const float* tangents, const Quanta* before) {
  for_each_cell(exec, t.grid,
                Slide{t.grid, t.quantum, 1.0f / p.fresh_depth, repose::Tangents(repose),
                      repose::RelativeMoisture(t, repose), t.real(Layer::vegetation), tangents,
                      t.quanta(Layer::sand), before, t.real(Layer::looseness)});
}

template <class E>
void fill(E& exec, const TerrainView& t, float value) {
  for_each_cell(exec, t.grid, Fill{t.grid, value, t.real(Layer::looseness)});
}

template void record(Backend&, const TerrainView&, Quanta*);
template void step(Backend&, const TerrainView&, const LoosenessParameters&, const ReposeParameters&,
                   const StepInputs&, Quanta*);
template void slides(Backend&, const TerrainView&, const LoosenessParameters&, const ReposeParameters&,
                     const float*, const Quanta*);
template void fill(Backend&, const TerrainView&, float);

}  // namespace desert_sim::looseness
