#pragma once
/// What flows through virtual pipes (virtual_pipes.hpp): the state that its laws look at, and how they are
/// run.

#include "kernels/backend/for_each.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/math.hpp"

namespace desert_sim::virtual_pipes {

constexpr float gravity = 9.81f;  ///< [m/s²]

/// What the laws look at. `inside`: of cells that have all four neighbours beside them, so that rows of cells
/// can be vectors.
template <bool inside>
struct Flow {
  Grid grid;
  float time_step, quantum, quanta_per_metre;  ///< of a part of a step [s]
  float highest_face;                          ///< [quanta]
  bool sea;
  Quanta sea_level;
  const Quanta *bedrock, *soil, *sand;
  Quanta* water;
  float *flux_x, *flux_y;  ///< through the east and the north face [m³/s]
  float* held;
  Quanta *sediment, *sediment_next;  ///< null: the water carries none; what it has after this part

  DESERT_HD Quanta bed(int i) const { return bedrock[i] + value_or_zero(soil, i) + sand[i]; }
  DESERT_HD int east(int x, int y) const {
    return inside ? grid.index(x, y) + 1 : neighbour_index(grid, x + 1, y);
  }
  DESERT_HD int west(int x, int y) const {
    return inside ? grid.index(x, y) - 1 : neighbour_index(grid, x - 1, y);
  }
  DESERT_HD int north(int x, int y) const {
    return inside ? grid.index(x, y) + grid.width : neighbour_index(grid, x, y + 1);
  }
  DESERT_HD int south(int x, int y) const {
    return inside ? grid.index(x, y) - grid.width : neighbour_index(grid, x, y - 1);
  }

  /// Quanta of depth that a flux moves in this time.
  DESERT_HD float amount(float flux) const {
    return flux * (time_step * quanta_per_metre / (grid.cell_size * grid.cell_size));
  }
  /// What leaves over an open edge [quanta], `through`: what comes through the opposite face towards it
  /// [m³/s].
  DESERT_HD float over_edge(int i, float through) const {
    const Quanta above = sea ? bed(i) + water[i] - sea_level : water[i];
    const Quanta free = above < water[i] ? above : water[i];
    if (free <= 0) return 0.0f;
    const float depth = static_cast<float>(free) * quantum;
    const float sill = grid.cell_size * depth * sqrtf(gravity * depth);
    return minimum(amount(maximum(sill, through)), static_cast<float>(free));
  }

  /// What a cell's faces let out, positive [quanta], before supply holds it back; fluxes through faces.
  struct Faces {
    int east, west, north, south;  ///< neighbours, −1: an open edge
    float to_east, to_west, to_north, to_south;
  };
  DESERT_HD Faces faces(int x, int y) const {
    const int i = grid.index(x, y);
    Faces f{east(x, y), west(x, y), north(x, y), south(x, y), 0.0f, 0.0f, 0.0f, 0.0f};
    const float qe = inside || f.east >= 0 ? flux_x[i] : 0.0f,
                qw = inside || f.west >= 0 ? flux_x[f.west] : 0.0f;
    const float qn = inside || f.north >= 0 ? flux_y[i] : 0.0f,
                qs = inside || f.south >= 0 ? flux_y[f.south] : 0.0f;
    if (inside) {
      f.to_east = amount(qe);
      f.to_west = amount(-qw);
      f.to_north = amount(qn);
      f.to_south = amount(-qs);
      return f;
    }
    f.to_east = f.east >= 0 ? amount(qe) : over_edge(i, qw);
    f.to_west = f.west >= 0 ? amount(-qw) : over_edge(i, -qe);
    f.to_north = f.north >= 0 ? amount(qn) : over_edge(i, qs);
    f.to_south = f.south >= 0 ? amount(-qs) : over_edge(i, -qn);
    return f;
  }

  /// Whole quanta of an amount from a donor that has water for a share of it: to the nearest where it has
  /// plenty, down where not.
  DESERT_HD static Quanta whole(float amount, float share) {
    return static_cast<Quanta>(share < 1.0f ? amount * share : rintf(amount));
  }
  /// Net amount through the face between i and j (−1: an open edge) that lets `out` out of i, or −out in.
  DESERT_HD Quanta through(int i, int j, float out) const {
    return whole(out, out > 0.0f || (!inside && j < 0) ? held[i] : held[j]);
  }
};

/// A law for all cells.
template <template <bool> class Law, class E, class... Rest>
void for_each_pipe(E& exec, const Flow<true>& flow, const Rest&... rest) {
  const Flow<false> border{flow.grid,         flow.time_step, flow.quantum,   flow.quanta_per_metre,
                           flow.highest_face, flow.sea,       flow.sea_level, flow.bedrock,
                           flow.soil,         flow.sand,      flow.water,     flow.flux_x,
                           flow.flux_y,       flow.held,      flow.sediment,  flow.sediment_next};
  for_each_cell(
      exec, flow.grid,
      Bordered<Law<true>, Law<false>>{flow.grid, 1, Law<true>{flow, rest...}, Law<false>{border, rest...}});
}

}  // namespace desert_sim::virtual_pipes
