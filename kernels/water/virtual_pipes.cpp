/// The laws and the step of virtual_pipes.hpp; compiled once for each backend.
#include "kernels/water/virtual_pipes.hpp"

#include "kernels/backend/buffer.hpp"
#include "kernels/backend/loops.hpp"
#include "kernels/field/ledger.hpp"
#include "kernels/water/sediment_transport.hpp"
#include "kernels/water/water_sources.hpp"
#include "src/core/constants.hpp"

namespace desert_sim::virtual_pipes {

/// Sub-step over the longest stable time step; it allows depths to double within a step.
constexpr float safety = 0.65f;

/// Acceleration of the water by the wind.
struct Waves {
  float strength;  ///< at the current time: s max(sin 2π t/T, 0) [1/s]
  const float *wind_x, *wind_y;
};

/// Updates the fluxes through a cell's east and north face.
template <bool inside>
struct Accelerate {
  Flow<inside> flow;
  Waves waves;
  float friction_factor;  ///< 1 − c Δt
  float drag;             ///< c_f Δt/l [s/m]
  bool first;             ///< first sub-step of a step, whose fluxes already respect the supply

  DESERT_HD float accelerated_flux(int i, int j, float flux, const float* wind) const {
    const Quanta bed_i = flow.bed(i), bed_j = flow.bed(j);
    const Quanta top_i = bed_i + flow.water[i], top_j = bed_j + flow.water[j];
    const Quanta bed = bed_i > bed_j ? bed_i : bed_j, top = top_i > top_j ? top_i : top_j;
    if (top <= bed) return 0.0f;
    const float face = minimum(static_cast<float>(top - bed), flow.highest_face) * flow.quantum;
    const Quanta drop = top_i - top_j;
    const bool level = drop <= 1 && drop >= -1;
    float pull = level ? 0.0f : gravity * (static_cast<float>(drop) * flow.quantum / flow.grid.cell_size);
    if (waves.strength > 0.0f) {
      const float both = static_cast<float>(sum_of_depths(flow.water[i], flow.water[j])) * flow.quantum;
      pull += waves.strength * (1.0f - exp_negative(0.005f * both * both)) * 0.5f * (wind[i] + wind[j]);
    }
    const float limited_flux =
        first ? flux : flux * (flux > 0.0f ? flow.supply_share[i] : flow.supply_share[j]);
    if (level && pull == 0.0f && flow.amount(fabsf(limited_flux)) < 0.5f) return 0.0f;
    const float undamped_flux =
        friction_factor * limited_flux + flow.time_step * (flow.grid.cell_size * face) * pull;
    const float found =
        2.0f * undamped_flux / (1.0f + sqrtf(1.0f + 4.0f * (drag / (face * face)) * fabsf(undamped_flux)));
    return clamp(found, -flow.most_flux_into(top_i), flow.most_flux_into(top_j));
  }
  DESERT_HD void operator()(int x, int y) const {
    const int i = flow.grid.index(x, y), east = flow.east(x, y), north = flow.north(x, y);
    if (inside || east >= 0) flow.flux_x[i] = accelerated_flux(i, east, flow.flux_x[i], waves.wind_x);
    if (inside || north >= 0) flow.flux_y[i] = accelerated_flux(i, north, flow.flux_y[i], waves.wind_y);
  }
};

/// Finds the share of its outflow that a cell has water for.
template <bool inside>
struct LimitOutflow {
  Flow<inside> flow;
  DESERT_HD void operator()(int x, int y) const {
    const int i = flow.grid.index(x, y);
    const typename Flow<inside>::Faces f = flow.faces(x, y);
    const float out = (maximum(f.to_east, 0.0f) + maximum(f.to_west, 0.0f)) +
                      (maximum(f.to_north, 0.0f) + maximum(f.to_south, 0.0f));
    const float available = static_cast<float>(flow.water[i]);
    const float share = minimum(spare(available) / (out + 1e-20f), 1.0f);
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
  static constexpr float film = 1e-4f;  ///< depth up to which water is a film [m]
};

/// At the end of a step, applies the limit by the cells' supply to the fluxes.
template <bool inside>
struct ApplyLimits {
  Flow<inside> flow;
  DESERT_HD void operator()(int x, int y) const {
    const int i = flow.grid.index(x, y), east = flow.east(x, y), north = flow.north(x, y);
    const float qx = flow.flux_x[i], qy = flow.flux_y[i];
    if (inside || east >= 0)
      flow.flux_x[i] = qx * (qx > 0.0f ? flow.supply_share[i] : flow.supply_share[east]);
    if (inside || north >= 0)
      flow.flux_y[i] = qy * (qy > 0.0f ? flow.supply_share[i] : flow.supply_share[north]);
  }
};

struct Depth {
  Grid grid;
  const Quanta* water;
  DESERT_HD float operator()(int x, int y) const { return static_cast<float>(water[grid.index(x, y)]); }
};

/// Number of sub-steps of a step; `deepest`: the greatest depth of water [m].
inline int substeps(const WaterParameters& p, const Grid& grid, float time_step, double deepest) {
  const double longest = safety * grid.cell_size / std::sqrt(2.0 * gravity * deepest + 1e-12);
  const double parts = std::ceil(time_step / longest);
  return parts < 1 ? 1 : (parts > p.most_substeps ? p.most_substeps : static_cast<int>(parts));
}

template <class E>
void step(E& exec, const TerrainView& t, const WaterParameters& p, const StepInputs& in, LedgerView ledger,
          Workspace& work) {
  const auto fill_sea = [&] { water_sources::fill_sea(exec, t, p.sea, in.sea_level, ledger); };
  fill_sea();
  const double deepest =
      static_cast<double>(max_cells(exec, t.grid, Depth{t.grid, t.quanta(Layer::water)})) * t.quantum;
  const int parts = substeps(p, t.grid, in.time_step, deepest);
  const float part = in.time_step / static_cast<float>(parts);
  const float l = t.grid.cell_size;
  // The greatest depth that is stable with this sub-step, without the safety margin: Δt² 2 g h = l².
  const float highest = l * l / (2.0f * gravity * part * part);
  FlowFields flow{};
  flow.grid = t.grid;
  flow.time_step = part;
  flow.quantum = t.quantum;
  flow.quanta_per_metre = t.quanta_per_metre;
  flow.highest_face = highest * t.quanta_per_metre;
  flow.sea = p.sea != Sea::none;
  flow.sea_level = in.sea_level;
  flow.bedrock = t.quanta(Layer::bedrock);
  flow.soil = t.quanta(Layer::soil);
  flow.sand = t.quanta(Layer::sand);
  flow.water = t.quanta(Layer::water);
  flow.flux_x = t.real(Layer::water_flux_x);
  flow.flux_y = t.real(Layer::water_flux_y);
  flow.supply_share = work.supply_share.data();
  flow.sediment = t.quanta(Layer::suspended_sediment);
  flow.sediment_next = in.carried;
  float *velocity_x = t.real(Layer::water_velocity_x), *velocity_y = t.real(Layer::water_velocity_y);
  flow.sediment_share = velocity_x;  // it has no other use until the water has moved
  const float friction_factor = maximum(1.0f - p.friction * part, 0.0f);
  for (int n = 0; n < parts; ++n) {
    const double phase = 2 * pi * (in.time + (n + 0.5) * part) / p.wave_period;
    const float swell = p.wave_strength * static_cast<float>(std::fmax(std::sin(phase), 0.0));
    const Waves waves{swell, t.real(Layer::wind_x), t.real(Layer::wind_y)};
    const std::uint64_t turn = in.tick * static_cast<std::uint64_t>(parts) + static_cast<std::uint64_t>(n);
    flow.die_x = dice::regular(in.seed, Roll::pipe_x, turn);
    flow.die_y = dice::regular(in.seed, Roll::pipe_y, turn);
    for_each_pipe<Accelerate>(exec, flow, waves, friction_factor, p.drag * part / l, n == 0);
    for_each_pipe<LimitOutflow>(exec, flow);
    if (flow.sediment)
      for_each_pipe<CarrySediment>(exec, flow, ledger, dice::regular(in.seed, Roll::sediment_x, turn),
                                   dice::regular(in.seed, Roll::sediment_y, turn));
    for_each_pipe<MoveWater>(exec, flow, velocity_x, velocity_y, ledger);
    fill_sea();
  }
  for_each_pipe<ApplyLimits>(exec, flow);
}

template void step(Backend&, const TerrainView&, const WaterParameters&, const StepInputs&, LedgerView,
                   Workspace&);

}  // namespace desert_sim::virtual_pipes
