/// The laws and the step of shallow_water.hpp; compiled once for each backend.
#include "kernels/water/shallow_water.hpp"

#include "kernels/backend/loops.hpp"
#include "kernels/water/water_sources.hpp"

namespace desert_sim::shallow_water {

using namespace face_flow;

/// C: share of l/(√(2 g w) + |u| + |v|) that a sub-step takes.
constexpr double courant = 0.6;

/// A face between cell i and its neighbour j to the east or north.
template <bool inside>
struct Face {
  Quanta depth_i, depth_j;  ///< h_f if the flow comes from i, and from j [quanta]
  Quanta drop;              ///< from i to j, of what pushes

  DESERT_HD Face(const Flow<inside>& flow, int i, int j) {
    const Quanta bed_i = flow.bed(i), bed_j = flow.bed(j), bed = bed_i > bed_j ? bed_i : bed_j;
    const Quanta top_i = bed_i + flow.water[i] - bed, top_j = bed_j + flow.water[j] - bed;
    depth_i = moving(flow.water[i], positive(top_i));
    depth_j = moving(flow.water[j], positive(top_j));
    const Quanta lowest = -static_cast<Quanta>(minimum(flow.grid.cell_size * flow.quanta_per_metre, 5e8f));
    drop = (top_i > lowest ? top_i : lowest) - (top_j > lowest ? top_j : lowest);
  }
  DESERT_HD static Quanta positive(Quanta v) { return v > 0 ? v : 0; }
  /// min(w, 2 over)
  DESERT_HD static Quanta moving(Quanta water, Quanta over) { return over < water - over ? 2 * over : water; }
  DESERT_HD bool level() const { return drop <= 1 && drop >= -1; }
  /// h_f [m] of water that moves with this velocity.
  DESERT_HD float depth(const FlowFields& flow, float velocity) const {
    return static_cast<float>(velocity > 0.0f ? depth_i : depth_j) * flow.quantum;
  }
  /// h_m [m]. `behind`: the depth of the cell upstream of the upstream one, −1 if there is none [quanta]
  DESERT_HD float mixed_depth(const FlowFields& flow, float velocity, Quanta behind) const {
    const float upstream = depth(flow, velocity), downstream = depth(flow, -velocity);
    const bool wet = downstream > 0.0f && upstream > 0.0f;
    const float ahead = 0.5f * (downstream - upstream);
    const float before = behind < 0 ? 0.0f : 0.5f * (upstream - static_cast<float>(behind) * flow.quantum);
    const float least = ahead * before > 0.0f ? (fabsf(ahead) < fabsf(before) ? ahead : before) : 0.0f;
    const float most = 0.25f * upstream, half = clamp(ahead, -most, most);
    const float slow = maximum(1.0f - fabsf(velocity) / sqrtf(flow.gravity * (wet ? upstream : 1.0f)), 0.0f);
    return wet ? upstream + (slow * half + (1.0f - slow) * least) : upstream;
  }
};

/// Finds the velocities on a cell's faces from the fluxes that the last step has left.
template <bool inside>
struct FindVelocities {
  Flow<inside> flow;
  float *velocity_x, *velocity_y;

  DESERT_HD float velocity(int i, int j, float flux) const {
    const float depth = Face<inside>(flow, i, j).depth(flow, flux);
    return depth > film ? flux / (flow.grid.cell_size * depth) : 0.0f;
  }
  DESERT_HD void operator()(int x, int y) const {
    const int i = flow.grid.index(x, y), east = flow.east(x, y), north = flow.north(x, y);
    velocity_x[i] = inside || east >= 0 ? velocity(i, east, flow.flux_x[i]) : 0.0f;
    velocity_y[i] = inside || north >= 0 ? velocity(i, north, flow.flux_y[i]) : 0.0f;
  }
};

/// √(2 g w) + |u| + |v| of a cell [m/s], with the faster of two opposite faces.
struct Speed {
  Flow<false> flow;
  const float *velocity_x, *velocity_y;

  DESERT_HD float operator()(int x, int y) const {
    const int i = flow.grid.index(x, y);
    return x > 0 && y > 0 ? speed(i, i - 1, i - flow.grid.width)
                          : speed(i, flow.west(x, y), flow.south(x, y));
  }
  DESERT_HD float speed(int i, int west, int south) const {
    const float depth = static_cast<float>(flow.water[i]) * flow.quantum;
    const float u = maximum(fabsf(velocity_x[i]), west >= 0 ? fabsf(velocity_x[west]) : 0.0f);
    const float v = maximum(fabsf(velocity_y[i]), south >= 0 ? fabsf(velocity_y[south]) : 0.0f);
    return sqrtf(2.0f * flow.gravity * depth) + (u + v);
  }
};

/// Velocities and fluxes before a sub-step.
struct Before {
  const float *velocity_x, *velocity_y, *flux_x, *flux_y;
};

/// Finds the velocities on a cell's east and north face after a sub-step, and the fluxes through them.
template <bool inside>
struct Accelerate {
  Flow<inside> flow;
  Before before;
  float *velocity_x, *velocity_y;
  Waves waves;
  BedDrag drag;
  float friction;  ///< 1/(1 + c Δt)

  /// What enters a face's volume: the flux [m³/s], and the change of velocity that it brings.
  struct Inflow {
    float sum = 0.0f, change = 0.0f;
    float across = 0.0f;  ///< mean velocity across the flux [m/s]
    DESERT_HD void add(float flux, float own, float brought) {
      const float in = maximum(flux, 0.0f);
      sum += in;
      change += in * (own - brought);
    }
  };

  /// What enters through the two sides that the flux crosses and through the two beside them. Where a cell is
  /// missing nothing enters. `behind`, `i`, `j`: cells along the flux, each with the face ahead of it;
  /// `left`, `right`: to the sides of i, with the faces towards the left; `right_of_j`: to the side of j.
  DESERT_HD Inflow inflow(const float* along, const float* along_flux, const float* across,
                          const float* across_flux, int behind, int i, int j, int left, int right,
                          int right_of_j) const {
    const float own = along[i], flux = along_flux[i];
    Inflow ends, sides;
    if (inside || behind >= 0) ends.add(0.5f * (along_flux[behind] + flux), own, along[behind]);
    ends.add(-0.5f * (flux + along_flux[j]), own, along[j]);
    float right_velocity = 0.0f;
    if (inside || (right >= 0 && right_of_j >= 0)) {
      sides.add(0.5f * (across_flux[right] + across_flux[right_of_j]), own, along[right]);
      right_velocity = across[right] + across[right_of_j];
    }
    if (inside || left >= 0) sides.add(-0.5f * (across_flux[i] + across_flux[j]), own, along[left]);
    return {ends.sum + sides.sum, ends.change + sides.change,
            0.25f * (right_velocity + (across[i] + across[j]))};
  }

  /// The velocity on a face after the sub-step, and h_m [m].
  struct Moved {
    float velocity, depth;
  };
  /// `behind`, `ahead`: the cells beyond i and j.
  DESERT_HD Moved accelerated(const Face<inside>& face, const Inflow& in, int behind, int i, int j, int ahead,
                              float own, const float* wind) const {
    const float l = flow.grid.cell_size, dt = flow.time_step;
    float pull = face.level() ? 0.0f : flow.gravity * (static_cast<float>(face.drop) * flow.quantum / l);
    if (waves.strength > 0.0f) pull += waves.pull(flow, i, j, wind);
    float mean =
        0.5f * (static_cast<float>(flow.water[i]) + static_cast<float>(flow.water[j])) * flow.quantum;
    mean = in.change * own > 0.0f ? maximum(mean, face.depth(flow, own)) : mean;
    // No more than all of a volume is replaced in a sub-step.
    const float share = minimum(dt / (l * l * maximum(mean, film)), 1.0f / (in.sum + 1e-20f));
    const float pushed = friction * ((own - share * in.change) + dt * pull);
    const Quanta before_i = inside || behind >= 0 ? flow.water[behind] : -1,
                 before_j = inside || ahead >= 0 ? flow.water[ahead] : -1;
    const float depth = face.mixed_depth(flow, pushed, pushed > 0.0f ? before_i : before_j);
    const float held = maximum(depth, film);
    const float found = pushed * left_by_drag(hypotenuse(pushed, in.across), drag.of(held) * dt / held);
    return {face.depth(flow, pushed) > film ? found : 0.0f, depth};
  }

  /// Stores the velocity on a face and the flux through it.
  DESERT_HD void store(const Face<inside>& face, Moved moved, int i, int j, float* velocity,
                       float* flux) const {
    const float l = flow.grid.cell_size, found = moved.velocity;
    const float wanted = found * (l * moved.depth);
    const bool stops = face.level() && flow.amount(fabsf(wanted)) < 0.5f;
    const float through = stops ? 0.0f : wanted;
    velocity[i] = stops ? 0.0f : found;
    flux[i] = clamp(through, -flow.most_flux_into(flow.bed(i) + flow.water[i]),
                    flow.most_flux_into(flow.bed(j) + flow.water[j]));
  }

  DESERT_HD void operator()(int x, int y) const {
    const int i = flow.grid.index(x, y);
    const int east = flow.east(x, y), west = flow.west(x, y), north = flow.north(x, y),
              south = flow.south(x, y);
    if (inside || east >= 0) {
      const Face<inside> face(flow, i, east);
      const Inflow in = inflow(before.velocity_x, before.flux_x, before.velocity_y, before.flux_y, west, i,
                               east, north, south, inside || south >= 0 ? flow.south(x + 1, y) : -1);
      store(face,
            accelerated(face, in, west, i, east, flow.east(x + 1, y), before.velocity_x[i], waves.wind_x), i,
            east, velocity_x, flow.flux_x);
    } else {
      velocity_x[i] = flow.flux_x[i] = 0.0f;
    }
    if (inside || north >= 0) {
      const Face<inside> face(flow, i, north);
      const Inflow in = inflow(before.velocity_y, before.flux_y, before.velocity_x, before.flux_x, south, i,
                               north, east, west, inside || west >= 0 ? flow.west(x, y + 1) : -1);
      store(face,
            accelerated(face, in, south, i, north, flow.north(x, y + 1), before.velocity_y[i], waves.wind_y),
            i, north, velocity_y, flow.flux_y);
    } else {
      velocity_y[i] = flow.flux_y[i] = 0.0f;
    }
  }
};

/// Leaves the fluxes for the next step.
template <bool inside>
struct KeepFluxes {
  Flow<inside> flow;
  const float *velocity_x, *velocity_y;

  DESERT_HD float flux(int i, int j, float velocity) const {
    return velocity * (flow.grid.cell_size * Face<inside>(flow, i, j).depth(flow, velocity));
  }
  DESERT_HD void operator()(int x, int y) const {
    const int i = flow.grid.index(x, y), east = flow.east(x, y), north = flow.north(x, y);
    flow.flux_x[i] = inside || east >= 0 ? flux(i, east, velocity_x[i]) : 0.0f;
    flow.flux_y[i] = inside || north >= 0 ? flux(i, north, velocity_y[i]) : 0.0f;
  }
};

template <class E>
void step(E& exec, const TerrainView& t, const WaterParameters& p, const StepInputs& in, LedgerView ledger,
          Workspace& work) {
  FlowFields flow = flow_fields(t, p, in, work.supply_share.data());
  flow.passes_through = true;
  float *const kept_x = flow.flux_x, *const kept_y = flow.flux_y;
  const auto fill_sea = [&] { water_sources::fill_sea(exec, t, p.sea, in.sea_level, ledger); };
  fill_sea();
  for_each_flow<FindVelocities>(exec, flow, work.velocity_x[0].data(), work.velocity_y[0].data());
  double done = 0;
  int n = 0;
  for (; done < in.time_step; ++n) {
    const float *u = work.velocity_x[n % 2].data(), *v = work.velocity_y[n % 2].data();
    float *next_u = work.velocity_x[1 - n % 2].data(), *next_v = work.velocity_y[1 - n % 2].data();
    const double fastest = max_cells(exec, t.grid, Speed{Flow<false>(flow), u, v});
    const double left = in.time_step - done, longest = courant * t.grid.cell_size / (fastest + 1e-12);
    const double parts = std::ceil(left / longest);  // equal ones, so that the last is not a sliver
    const double part = parts > 1 ? left / parts : left;
    const std::uint64_t turn = (in.tick << 20) + static_cast<std::uint64_t>(n);
    const Before before{u, v, flow.flux_x, flow.flux_y};
    flow.flux_x = n % 2 == 0 ? work.flux_x.data() : kept_x;
    flow.flux_y = n % 2 == 0 ? work.flux_y.data() : kept_y;
    begin_substep(flow, static_cast<float>(part), in.seed, turn);
    for_each_flow<Accelerate, 2>(exec, flow, before, next_u, next_v,
                                 waves_at(in.time + done + 0.5 * part, p, t), BedDrag(p),
                                 1.0f / (1.0f + p.friction * flow.time_step));
    move(exec, t, flow, in.seed, turn, ledger);
    fill_sea();
    done = parts > 1 ? done + part : in.time_step;
  }
  flow.flux_x = kept_x;
  flow.flux_y = kept_y;
  for_each_flow<KeepFluxes>(exec, flow, work.velocity_x[n % 2].data(), work.velocity_y[n % 2].data());
}

template void step(Backend&, const TerrainView&, const WaterParameters&, const StepInputs&, LedgerView,
                   Workspace&);

}  // namespace desert_sim::shallow_water
