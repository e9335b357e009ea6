#pragma once
/// The laws of wang.hpp.

#include "kernels/backend/for_each.hpp"
#include "kernels/particles/shelter.hpp"
#include "kernels/particles/starts.hpp"
#include "kernels/particles/wang.hpp"
#include "kernels/sand/saltation_inputs.hpp"
#include "kernels/wind/undisturbed_wind.hpp"

namespace desert_sim::particles {

/// The surface as a flight sees it that began in cell (x, y): bilinear between the centres of cells.
struct Bed {
  Downwind order;
  const Column* columns;
  float quantum, cell_size, per_cell;
  int x, y;            ///< the cell
  float off_x, off_y;  ///< of the beginning from the cell's centre [cells]
  Quanta reference;    ///< height from which heights are counted

  struct Place {
    int x, y;
    float part_x, part_y;
  };
  DESERT_HD const Column& column(int at_x, int at_y) const {
    const Grid& grid = order.grid;
    const int cx = grid.periodic_x ? wrap(at_x, grid.width) : clamp_index(at_x, grid.width);
    const int cy = grid.periodic_y ? wrap(at_y, grid.height) : clamp_index(at_y, grid.height);
    return columns[order.slot(cx, cy)];
  }
  DESERT_HD Surface at(float dx, float dy) const {
    const float px = dx * per_cell + off_x, py = dy * per_cell + off_y;
    const float fx = floorf(px), fy = floorf(py), u = px - fx, v = py - fy;
    const int cx = x + static_cast<int>(fx), cy = y + static_cast<int>(fy);
    const Grid& grid = order.grid;
    const bool inside = grid.inside(cx, cy) && grid.inside(cx + 1, cy + 1);
    const int first = inside ? order.slot(cx, cy) : 0;
    float heights[4], depths[4];
    unrolled<4>([&](auto k) DESERT_INLINE {
      constexpr int east = k & 1, north = k >> 1;
      const Column c = inside ? columns[first + east * order.slot_x + north * order.slot_y]
                              : column(cx + east, cy + north);
      heights[k] = static_cast<float>(difference_modulo(c.surface, reference)) * quantum;
      depths[k] = static_cast<float>(c.shelter - c.surface) * quantum;
    });
    const float south = heights[1] - heights[0], north = heights[3] - heights[2];
    const float low = fused(u, south, heights[0]), high = fused(u, north, heights[2]);
    const float depth = lerp(lerp(depths[0], depths[1], u), lerp(depths[2], depths[3], u), v);
    return {lerp(low, high, v), depth, lerp(south, north, v) * per_cell, (high - low) * per_cell};
  }
  /// The cell that holds a place; −1 beyond an open edge.
  DESERT_HD int cell_at(float dx, float dy) const {
    const int cx = x + static_cast<int>(floorf(dx * per_cell + off_x + 0.5f)),
              cy = y + static_cast<int>(floorf(dy * per_cell + off_y + 0.5f));
    return neighbour_index(order.grid, cx, cy);
  }
};

/// Nobody looks at the grains of a step.
struct Unseen {
  DESERT_HD void flying(const Grain&) const {}
  DESERT_HD void landed(const Grain&) const {}
};

/// What all grains of a step share.
struct Flights {
  Downwind order;
  const Column* columns;
  float quantum, quanta_per_metre;
  Air air;
  Starts starts;
  float normal_restitution, tangential_restitution;
  float least_rise;  ///< √(2 g d) [m/s]
  const float* obstacle;
  Quanta* landed;
  LedgerView ledger;

  DESERT_HD Bed bed_at(int x, int y, float off_x = 0.0f, float off_y = 0.0f) const {
    const float cell = order.grid.cell_size;
    return {order, columns, quantum, cell,  1.0f / cell,
            x,     y,       off_x,   off_y, columns[order.slot(x, y)].surface};
  }
  /// A bed for a flight from a place in the cell, by dice.
  DESERT_HD Bed bed_from(int x, int y, RandomSequence& words) const {
    const float off_x = words.unit() - 0.5f, off_y = words.unit() - 0.5f;
    return bed_at(x, y, off_x, off_y);
  }
  DESERT_HD bool solid(int i) const { return value_or_zero(obstacle, i) > 0.0f; }

  /// Flies to the next impact, and says in which cell; −1 beyond an open edge. `rest`: the last cell on the
  /// way where a grain can rest. `seen` is told of the grain in flight, and where it has landed.
  template <class Seen>
  DESERT_HD int next_impact(const Bed& bed, float rise, Grain& g, Surface& hit, int& rest,
                            const Seen& seen) const {
    hit = hop(bed, air, rise, g, [&](float gx, float gy) DESERT_INLINE {
      seen.flying(g);
      if (!obstacle) return;
      const int cell = bed.cell_at(gx, gy);
      if (cell >= 0 && !solid(cell)) rest = cell;
    });
    seen.landed(g);
    const int cell = bed.cell_at(g.x, g.y);
    if (cell >= 0 && !solid(cell)) rest = cell;
    return cell;
  }
  DESERT_HD void leave(int from, Quanta amount) const { ledger.book_out(Material::sand, from, amount); }
};

/// Sand that the wind takes up, and what plants, water and moisture leave of it.
struct Loose {
  Quanta* sand;
  const float* vegetation;
  const Quanta* water;
  float quantum;
  repose::RelativeMoisture relative_moisture;
  saltation::Dryness dryness;

  DESERT_HD float share(int i) const {
    if (static_cast<float>(value_or_zero(water, i)) * quantum > wet_depth) return 0.0f;
    return (1.0f - value_or_zero(vegetation, i)) * dryness(relative_moisture(i));
  }
};

/// Each cell gives a packet to the wind, together with what the wind brings over an open edge there.
struct LiftOff {
  Flights flights;
  Loose loose;
  float shear_velocity, threshold_squared;
  float per_excess;      ///< E Δt/(u_*² − u_*t²) [quanta s²/m²]
  float shear_height;    ///< at which u is read [m]
  float exposed_height;  ///< z_e [m]
  float exposure;        ///< cot α [1]
  float entering_x,
      entering_y;       ///< over a cell's side at the edge to the west or east, south or north [quanta]
  float splash_number;  ///< a_s/√(g d) [s/m]
  int most_bounces;
  Die lift, influx, flight;
  Quanta *impacts, *splash;

  /// Impacts over those on level ground: 1 + cot α ∂h/∂s, by central differences.
  DESERT_HD float exposure_at(const Bed& bed) const {
    const int x = bed.x, y = bed.y;
    const auto rise = [&](int dx, int dy) DESERT_INLINE {
      return static_cast<float>(bed.column(x + dx, y + dy).surface - bed.column(x - dx, y - dy).surface);
    };
    const float slope = 0.5f * flights.quantum * bed.per_cell *
                        (rise(1, 0) * flights.air.along_x + rise(0, 1) * flights.air.along_y);
    return maximum(1.0f + exposure * slope, 0.0f);
  }
  /// u at a cell [m/s]: less under a shelter, more on what stands out of the ground upwind.
  DESERT_HD float shear_velocity_at(const Column& c) const {
    const float quantum = flights.quantum, depth = static_cast<float>(c.shelter - c.surface) * quantum,
                above = static_cast<float>(c.surface - c.upwind) * quantum;
    const Air& air = flights.air;
    const float sheltered = air.speed(shear_height, depth) / air.speed(shear_height, 0.0f);
    const float ratio = maximum((exposed_height + above) * air.per_roughness, 1.0f);
    return shear_velocity * sheltered * (logarithm(ratio) / logarithm(exposed_height * air.per_roughness));
  }
  DESERT_HD bool at_windward_edge(int n, int cells, bool periodic, float along) const {
    return !periodic && (along > 0.0f ? n == 0 : along < 0.0f && n == cells - 1);
  }
  /// Into a cell that is full comes nothing.
  DESERT_HD Quanta enter(int x, int y, int i, Quanta surface) const {
    const Grid& grid = flights.order.grid;
    const Air& air = flights.air;
    const float amount = (at_windward_edge(x, grid.width, grid.periodic_x, air.along_x) ? entering_x : 0.0f) +
                         (at_windward_edge(y, grid.height, grid.periodic_y, air.along_y) ? entering_y : 0.0f);
    if (!(amount > 0.0f)) return 0;
    const Quanta whole = with_room(influx.whole_at_most(amount, most_influx, i), surface);
    flights.ledger.book_in(Material::sand, i, whole);
    return whole;
  }
  /// What the wind lifts off a cell, at this u.
  DESERT_HD Quanta lifted_at(int x, int y, int i, float u) const {
    const float excess = maximum(u * u - threshold_squared, 0.0f) * exposure_at(flights.bed_at(x, y));
    return lift.whole_at_most(per_excess * excess * loose.share(i), loose.sand[i], i);
  }
  DESERT_HD void operator()(int i) const {
    const Grid& grid = flights.order.grid;
    const int y = i / grid.width, x = i - y * grid.width;
    if (flights.solid(i)) return;
    const Column& here = flights.columns[flights.order.slot(x, y)];
    const float u = shear_velocity_at(here);
    const Quanta lifted = lifted_at(x, y, i, u);
    loose.sand[i] -= lifted;
    const Quanta packet = lifted + enter(x, y, i, here.surface);
    if (packet > 0) fly(x, y, i, packet, lifted > 0 ? u : shear_velocity);
  }
  DESERT_HD void fly(int x, int y, int i, Quanta packet, float u) const {
    RandomSequence words{flight.word(i)};
    const int rest = run(x, y, i, u, words, Unseen{},
                         [&](int cell, float speed) DESERT_INLINE { strike(cell, packet, speed, words); });
    if (rest < 0) return flights.leave(i, packet);
    atomic_add(&flights.landed[rest], packet);
  }
  /// From lift-off to rest, and says in which cell; −1 if that is beyond an open edge. `struck(cell, speed)`
  /// is called for each impact on what is not solid.
  template <class Seen, class Struck>
  DESERT_HD int run(int x, int y, int i, float u, RandomSequence& words, const Seen& seen,
                    const Struck& struck) const {
    const Bed bed = flights.bed_from(x, y, words);
    Grain g{0.0f, 0.0f, bed.at(0.0f, 0.0f).height, 0.0f, 0.0f, 0.0f};
    flights.starts.lift_off(flights.air, u, words, g);
    float rise = g.velocity_z;
    int rest = i;
    Surface hit{};
    for (int bounces = 0;; ++bounces) {
      const int cell = flights.next_impact(bed, rise, g, hit, rest, seen);
      if (cell < 0) return cell;
      if (!flights.solid(cell)) struck(cell, g.speed());
      rise = bounce(hit, flights.normal_restitution, flights.tangential_restitution, g);
      if (rise < flights.least_rise || bounces == most_bounces) return rest;
    }
  }
  DESERT_HD void strike(int cell, Quanta packet, float speed, RandomSequence& words) const {
    atomic_add(&impacts[cell], packet);
    const float thrown = static_cast<float>(packet) * splash_number * speed;
    atomic_add(&splash[cell], Die::whole_at_most(thrown, load_limit, words.next()));
  }
};

struct NoPath {
  GrainPaths paths;
  DESERT_HD void operator()(int n) const { paths.end(n, 0); }
};

/// The ways of grains that a step would lift off some cells, for somebody who looks; nothing moves.
struct TraceGrain {
  LiftOff lift_off;
  GrainPaths paths;
  float metres_per_quantum;

  /// Notes where a grain is: from where it started, in a path with room for some points.
  struct Note {
    PathPoint* points;
    int* count;
    int most;
    PathPoint start;  ///< of the ground there

    DESERT_HD void put(const Grain& g) const {
      points[*count - 1] = {start.x + g.x, start.y + g.y, start.z + g.z};
    }
    DESERT_HD void flying(const Grain& g) const {
      if (*count < most) ++*count;
      put(g);
    }
    DESERT_HD void landed(const Grain& g) const { put(g); }
  };

  DESERT_HD void operator()(int n) const { paths.end(n, follow(n)); }
  /// Writes the points of a way, and says how many.
  DESERT_HD int follow(int n) const {
    const Flights& flights = lift_off.flights;
    const Grid& grid = flights.order.grid;
    const int i = paths.cell(n, grid), y = i / grid.width, x = i - y * grid.width;
    if (flights.solid(i)) return 0;
    const float u = lift_off.shear_velocity_at(flights.columns[flights.order.slot(x, y)]);
    if (lift_off.lifted_at(x, y, i, u) == 0) return 0;
    RandomSequence words{lift_off.flight.word(i)};
    RandomSequence place = words;  // the grain draws its place from the same dice
    const Bed bed = flights.bed_from(x, y, place);
    const PathPoint start{(static_cast<float>(x) + 0.5f + bed.off_x) * grid.cell_size,
                          (static_cast<float>(y) + 0.5f + bed.off_y) * grid.cell_size,
                          static_cast<float>(bed.reference) * metres_per_quantum};
    PathPoint* const points = paths.path(n);
    points[0] = {start.x, start.y, start.z + bed.at(0.0f, 0.0f).height};
    int count = 1;
    lift_off.run(x, y, i, u, words, Note{points, &count, paths.most_points, start}, [](int, float) {});
    return count;
  }
};

/// What impacts throw up hops once, and what they push creeps downhill.
struct Splash {
  Flights flights;
  Loose loose;
  float per_splash_number;  ///< √(g d)/a_s [m/s]
  float creep;              ///< λ_c/l² [1/m]
  Die amount, hop, creep_amount;
  const Quanta *impacts, *splash;

  DESERT_HD void operator()(int i) const {
    if (splash[i] == 0) return;
    const Grid& grid = flights.order.grid;
    const int y = i / grid.width, x = i - y * grid.width;
    const float share = loose.share(i), thrown = static_cast<float>(splash[i]);
    const Quanta packet = amount.whole_at_most(thrown * share, loose.sand[i], i);
    loose.sand[i] -= packet;
    if (packet > 0) fly(x, y, i, packet, per_splash_number * thrown / static_cast<float>(impacts[i]));
    creep_down(x, y, i, thrown * share);
  }
  DESERT_HD void fly(int x, int y, int i, Quanta packet, float impact_speed) const {
    RandomSequence words{hop.word(i)};
    const Bed bed = flights.bed_from(x, y, words);
    Grain g{0.0f, 0.0f, bed.at(0.0f, 0.0f).height, 0.0f, 0.0f, 0.0f};
    flights.starts.splash(flights.air, impact_speed, words, g);
    int rest = i;
    Surface hit{};
    if (g.velocity_z > 0.0f && flights.next_impact(bed, g.velocity_z, g, hit, rest, Unseen{}) < 0)
      return flights.leave(i, packet);
    atomic_add(&flights.landed[rest], packet);
  }
  DESERT_HD void creep_down(int x, int y, int i, float thrown) const {
    const Bed bed = flights.bed_at(x, y);
    RandomSequence words{creep_amount.word(i)};
    for (int k = 0; k < 4; ++k) {
      const int dx = Neighbours::dx(k), dy = Neighbours::dy(k);
      const int to = neighbour_index(bed.order.grid, x + dx, y + dy);
      if (to < 0 || flights.solid(to)) continue;
      const Quanta drop = bed.reference - bed.column(x + dx, y + dy).surface;
      if (drop <= 0) continue;
      const float wanted = thrown * creep * static_cast<float>(drop) * flights.quantum;
      const Quanta moved = Die::whole_at_most(wanted, loose.sand[i], words.next());
      loose.sand[i] -= moved;
      atomic_add(&flights.landed[to], moved);
    }
  }
};

struct Settle {
  Grid grid;
  float quantum;
  const Quanta* landed;
  Quanta* sand;
  float* impact_strength;

  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    sand[i] += landed[i];
    if (impact_strength) impact_strength[i] = static_cast<float>(landed[i]) * quantum;
  }
};

}  // namespace desert_sim::particles
