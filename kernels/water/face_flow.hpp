#pragma once
/// Flow of water through the faces between cells, which both models of water share (virtual_pipes.hpp,
/// shallow_water.hpp): the state of their laws, the flow through a cell's faces, and the loop that runs the
/// laws. Each face has one signed flux; a cell stores those of its east and its north face.

#include "kernels/backend/for_each.hpp"
#include "kernels/base/math.hpp"
#include "kernels/field/dice.hpp"
#include "kernels/field/layers.hpp"

namespace desert_sim::face_flow {

/// The fields that the laws of the flow share.
struct FlowFields {
  Grid grid;
  float time_step, quantum, quanta_per_metre;  ///< time_step: of a sub-step [s]
  float gravity;                               ///< g [m/s²]
  bool sea;
  bool passes_through;  ///< what comes to an edge in a sub-step may leave in it, however low the edge is
  float most_froude;    ///< of what flows out of a cell; 0: any
  Quanta sea_level;
  const Quanta *bedrock, *soil, *sand;
  Quanta* water;
  float *flux_x, *flux_y;            ///< through the east and the north face [m³/s]
  float* supply_share;               ///< share of its outflow that a cell has water for
  Quanta *sediment, *sediment_next;  ///< null without sediment; sediment after this sub-step
  float* sediment_share;             ///< sediment that leaves a cell with a quantum of its unlimited outflow
  Die die_x, die_y;                  ///< of the faces towards the east and the north
};

/// Of two depths [quanta], whose sum need not fit: each may reach from the lowest bed up to fill_limit.
DESERT_HD std::uint32_t sum_of_depths(Quanta a, Quanta b) {
  return static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b);
}

/// Depth up to which water is a film, which has no velocity [m]. No parameter: below it a whole quantum a
/// step would count as a fast flow.
constexpr float film = 1e-4f;

/// What four faces may move more than the sum of their amounts, each being rounded to a whole quantum.
constexpr float rounding_of_faces = 3.0f;

/// State of the flow. `inside` is for cells that are not at an edge: their neighbours' indices need no test,
/// so that rows of cells vectorise (SIMD).
template <bool inside>
struct Flow : FlowFields {
  DESERT_HD explicit Flow(const FlowFields& fields) : FlowFields(fields) {}

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

  /// Depth [quanta] that a flux [m³/s] moves in a sub-step.
  DESERT_HD float amount(float flux) const {
    return flux * (time_step * quanta_per_metre / (grid.cell_size * grid.cell_size));
  }
  /// The largest flux [m³/s] through a face into a cell with its surface at `top`, so that four of them do
  /// not fill it over fill_limit.
  DESERT_HD float most_flux_into(Quanta top) const {
    const float room = static_cast<float>(fill_limit - top);
    return 0.25f * maximum(room, 0.0f) * (grid.cell_size * grid.cell_size / (time_step * quanta_per_metre));
  }
  /// Outflow over an open edge [quanta], as over a sill. `through`: flux through the opposite face towards
  /// the edge [m³/s].
  DESERT_HD float over_edge(int i, float through) const {
    const Quanta above = sea ? bed(i) + water[i] - sea_level : water[i];
    const Quanta free = above < water[i] ? above : water[i];
    const float follows = passes_through ? maximum(amount(through), 0.0f) : 0.0f;
    if (free < 0 || (free == 0 && follows == 0.0f)) return 0.0f;
    const float depth = static_cast<float>(free) * quantum;
    const float sill = grid.cell_size * depth * sqrtf(gravity * depth);
    return minimum(amount(maximum(sill, through)), static_cast<float>(free) + follows);
  }

  /// Outflow through each face of a cell [quanta], negative for inflow, before it is limited to the water
  /// that the donor has.
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

  /// Of two opposite faces, the greater outflow to a neighbour, and from two such pairs the whole [quanta].
  DESERT_HD static float to_neighbours(const Faces& f) {
    const auto to = [](int j, float out) { return inside || j >= 0 ? maximum(out, 0.0f) : 0.0f; };
    return hypotenuse(maximum(to(f.east, f.to_east), to(f.west, f.to_west)),
                      maximum(to(f.north, f.to_north), to(f.south, f.to_south)));
  }
  /// The outflow with this Froude number, |u| = Fr √(g w), of a cell with w quanta [quanta]. Films drain as
  /// the deepest of them do, because by their own depth they would never end.
  DESERT_HD float outflow_at(float froude, float quanta) const {
    const float depth = maximum(quanta * quantum, film);
    return amount(froude * (grid.cell_size * depth) * sqrtf(gravity * depth));
  }

  /// Whether what passes the face between i and j (−1: an open edge) comes from i.
  DESERT_HD static bool leaves(int j, float out) { return out > 0.0f || (!inside && j < 0); }

  /// The outflow through each face, where with each quantum so much leaves as the donor's value in `share`.
  DESERT_HD Faces shared(int x, int y, const float* share) const {
    const int i = grid.index(x, y);
    Faces f = faces(x, y);
    // All are loaded whichever is taken, so that compilers vectorise the loop.
    const auto of = [&](int j) { return share[inside || j >= 0 ? j : i]; };
    const float here = share[i], east = of(f.east), west = of(f.west), north = of(f.north),
                south = of(f.south);
    f.to_east *= leaves(f.east, f.to_east) ? here : east;
    f.to_west *= leaves(f.west, f.to_west) ? here : west;
    f.to_north *= leaves(f.north, f.to_north) ? here : north;
    f.to_south *= leaves(f.south, f.to_south) ? here : south;
    return f;
  }
  /// The number of the face between cell i and its western or southern neighbour j.
  DESERT_HD static int face_to(int i, int j) { return inside || j >= 0 ? j : -1 - i; }
};

/// Runs a law for all cells; it is `inside` where cells have `margin` neighbours on each side.
template <template <bool> class Law, int margin = 1, class E, class... Rest>
void for_each_flow(E& exec, const FlowFields& fields, const Rest&... rest) {
  for_each_cell(exec, fields.grid,
                Bordered<Law<true>, Law<false>>{fields.grid, margin, Law<true>{Flow<true>(fields), rest...},
                                                Law<false>{Flow<false>(fields), rest...}});
}

}  // namespace desert_sim::face_flow
