/// The laws and the step of virtual_pipes.hpp; compiled once for each backend.
#include "kernels/water/virtual_pipes.hpp"

#include "kernels/backend/buffer.hpp"
#include "kernels/backend/loops.hpp"
#include "kernels/field/ledger.hpp"
#include "kernels/water/water_movement.hpp"
#include "kernels/water/water_sources.hpp"

namespace desert_sim::virtual_pipes {

using namespace face_flow;

/// Sub-step over the longest stable time step; it allows depths to double within a step.
constexpr float safety = 0.65f;

/// Share of froude_limit from which on water that flows out of a cell counts as deeper (stream_depth): that
/// is a safety of 0.5. With 0.65 streams at the limit break into pulses after all.
constexpr float nearly = 0.9f;

/// Share of the deepest stable water that h_face reaches. At the limit itself columns of cells that swing
/// against each other grow until they are dry and twice as deep.
constexpr float margin = 0.8f;

/// The greatest depth [m] that is stable with a sub-step: a wave from cell to cell changes by
/// λ² − (1 + f − K) λ + f = 0, K = 8 g h Δt²/l², in a sub-step, where f = 1 − c Δt is what friction leaves of
/// a flux; |λ| ≤ 1 where K ≤ 2 (1 + f).
inline float deepest_stable(float gravity, float l, float part, float friction_factor) {
  return (1.0f + friction_factor) * (l * l) / (4.0f * gravity * part * part);
}

/// Updates the fluxes through a cell's east and north face.
template <bool inside>
struct Accelerate {
  Flow<inside> flow;
  Waves waves;
  BedDrag drag;
  float friction_factor;  ///< 1 − c Δt
  float highest_face;     ///< upper bound of h_face [quanta]
  bool first;             ///< first sub-step of a step, whose fluxes already respect the supply

  DESERT_HD float accelerated_flux(int i, int j, float flux, const float* wind) const {
    const Quanta bed_i = flow.bed(i), bed_j = flow.bed(j);
    const Quanta top_i = bed_i + flow.water[i], top_j = bed_j + flow.water[j];
    const Quanta bed = bed_i > bed_j ? bed_i : bed_j, top = top_i > top_j ? top_i : top_j;
    if (top <= bed) return 0.0f;
    const float face = minimum(static_cast<float>(top - bed), highest_face) * flow.quantum;
    const Quanta drop = top_i - top_j;
    const bool level = drop <= 1 && drop >= -1;
    float pull =
        level ? 0.0f : flow.gravity * (static_cast<float>(drop) * flow.quantum / flow.grid.cell_size);
    if (waves.strength > 0.0f) pull += waves.pull(flow, i, j, wind);
    const float limited_flux =
        first ? flux : flux * (flux > 0.0f ? flow.supply_share[i] : flow.supply_share[j]);
    if (level && pull == 0.0f && flow.amount(fabsf(limited_flux)) < 0.5f) return 0.0f;
    const float undamped_flux =
        friction_factor * limited_flux + flow.time_step * (flow.grid.cell_size * face) * pull;
    const float per_flux = drag.of(face) * flow.time_step / flow.grid.cell_size / (face * face);
    const float found = dragged(undamped_flux, per_flux);
    return clamp(found, -flow.most_flux_into(top_i), flow.most_flux_into(top_j));
  }
  DESERT_HD void operator()(int x, int y) const {
    const int i = flow.grid.index(x, y), east = flow.east(x, y), north = flow.north(x, y);
    if (inside || east >= 0) flow.flux_x[i] = accelerated_flux(i, east, flow.flux_x[i], waves.wind_x);
    if (inside || north >= 0) flow.flux_y[i] = accelerated_flux(i, north, flow.flux_y[i], waves.wind_y);
  }
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

/// The depth that a cell's sub-step goes by [quanta].
struct DepthOfSubsteps {
  Flow<false> flow;

  DESERT_HD float operator()(int x, int y) const {
    const int i = flow.grid.index(x, y);
    return x > 0 && y > 0 ? depth(i, i - 1, i - flow.grid.width)
                          : depth(i, flow.west(x, y), flow.south(x, y));
  }
  DESERT_HD float depth(int i, int west, int south) const {
    const float quanta = static_cast<float>(flow.water[i]),
                out =
                    flow.amount(hypotenuse(maximum(flow.flux_x[i], west >= 0 ? -flow.flux_x[west] : 0.0f),
                                           maximum(flow.flux_y[i], south >= 0 ? -flow.flux_y[south] : 0.0f)));
    return out > flow.outflow_at(nearly * froude_limit, quanta) ? stream_depth * quanta : quanta;
  }
};

/// Number of sub-steps that water of this depth [m] needs in a step.
inline double substeps(const Grid& grid, float gravity, float time_step, double depth) {
  const double longest =
      safety * grid.cell_size / std::sqrt(2.0 * static_cast<double>(gravity) * depth + 1e-12);
  return std::fmax(std::ceil(time_step / longest), 1.0);
}

template <class E>
void step(E& exec, const TerrainView& t, const WaterParameters& p, const StepInputs& in, LedgerView ledger,
          Workspace& work) {
  const auto fill_sea = [&] { water_sources::fill_sea(exec, t, p.sea, in.sea_level, ledger); };
  fill_sea();
  FlowFields flow = flow_fields(t, p, in, work.supply_share.data());
  flow.most_froude = froude_limit;
  flow.time_step = in.time_step;
  const double depth =
      static_cast<double>(max_cells(exec, t.grid, DepthOfSubsteps{Flow<false>(flow)})) * t.quantum;
  work.substeps = {depth, substeps(t.grid, p.gravity, in.time_step, depth), in.time_step};
  const int parts = static_cast<int>(std::fmin(work.substeps.needed, p.most_substeps));
  const float part = in.time_step / static_cast<float>(parts);
  const float friction_factor = maximum(1.0f - p.friction * part, 0.0f);
  const float highest = margin * deepest_stable(p.gravity, t.grid.cell_size, part, friction_factor);
  for (int n = 0; n < parts; ++n) {
    const std::uint64_t turn = in.tick * static_cast<std::uint64_t>(parts) + static_cast<std::uint64_t>(n);
    begin_substep(flow, part, in.seed, turn);
    const Waves waves = waves_at(in.time + (n + 0.5) * part, p, t);
    for_each_flow<Accelerate>(exec, flow, waves, BedDrag(p), friction_factor, highest * t.quanta_per_metre,
                              n == 0);
    move(exec, t, flow, in.seed, turn, ledger);
    fill_sea();
  }
  for_each_flow<ApplyLimits>(exec, flow);
}

template void step(Backend&, const TerrainView&, const WaterParameters&, const StepInputs&, LedgerView,
                   Workspace&);

}  // namespace desert_sim::virtual_pipes
