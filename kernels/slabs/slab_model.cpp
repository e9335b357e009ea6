/// The step of slab_model.hpp; compiled once for each backend.
#include "kernels/slabs/slab_model.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/backend/loops.hpp"
#include "kernels/slabs/slab_laws.hpp"
#include "src/core/constants.hpp"

namespace desert_sim::slabs {

struct SurfaceSum {
  Lattice lattice;
  DESERT_HD long long operator()(int x, int y) const { return lattice.height[lattice.order.slot(x, y)]; }
};
struct DeviationSum {
  Lattice lattice;
  Quanta mean;
  DESERT_HD long long operator()(int x, int y) const {
    const Quanta above = lattice.height[lattice.order.slot(x, y)] - mean;
    return above < 0 ? -above : above;
  }
};

/// h_ref [quanta].
template <class E>
float reference_height(E& exec, const Grid& grid, const Lattice& lattice, SlabKind kind) {
  if (kind == SlabKind::werner) return 0.0f;
  const double cells = grid.cells();
  const double mean = static_cast<double>(sum_cells(exec, grid, SurfaceSum{lattice})) / cells;
  if (kind == SlabKind::momiji) return static_cast<float>(mean);
  const auto sum = sum_cells(exec, grid, DeviationSum{lattice, static_cast<Quanta>(std::lround(mean))});
  return static_cast<float>(mean - 0.5 * static_cast<double>(sum) / cells);
}

inline std::uint32_t probability(float p) {
  return static_cast<std::uint32_t>(std::min(4294967295.0, static_cast<double>(p) * 4294967296.0));
}

inline Lattice make_lattice(const TerrainView& t, const SlabModelParameters& p, wind::Vector above,
                            const Workspace& work) {
  const Downwind order(t.grid, above);
  const auto quanta = [&](double metres) {
    return static_cast<Quanta>(std::lround(metres * static_cast<double>(t.quanta_per_metre)));
  };
  return {order,
          to_fixed_point(order.shift(above.x, above.y)),
          std::max(quanta(static_cast<double>(p.slab_height)), Quanta{1}),
          quanta(std::tan(p.repose_deg * pi / 180.0) * static_cast<double>(t.grid.cell_size)),
          work.height.data(),
          work.sand.data(),
          work.shade.data(),
          work.arriving.data()};
}

template <class E>
void blow(E& exec, const TerrainView& t, wind::Vector above) {
  for_each_cell(exec, t.grid, Blow{t.grid, above, t.real(Layer::wind_x), t.real(Layer::wind_y)});
}

/// Everything of a step that its rounds share.
struct Round {
  Lattice lattice;
  Blocks blocks;
  FindShade find_shade;
  Polls polls;
  Fly fly;
  int count;           ///< rounds of the step
  int shaded_from;     ///< first line of the sweep for the shadow
  bool spares_shadow;  ///< no slab is taken there
  float entering;      ///< slabs that the wind brings to a place of an open edge in a round
};

inline Round make_round(const TerrainView& t, const StepInputs& in, const Lattice& lattice, float reference,
                        const Dice& dice, LedgerView ledger, const Workspace& work) {
  const SlabModelParameters& p = in.model;
  const Downwind& order = lattice.order;
  const double cell = static_cast<double>(t.grid.cell_size),
               per_metre = static_cast<double>(t.quanta_per_metre), slab = static_cast<double>(lattice.slab);
  const double path =
      std::hypot(1.0, static_cast<double>(order.shift(in.above.x, in.above.y)));  // [cells a line]
  const auto lines = [&](double cells) { return static_cast<float>(cells / path); };
  const double polls = static_cast<double>(in.time_step) / static_cast<double>(p.poll_time);
  const int count = std::max(1, static_cast<int>(std::ceil(rounds_a_poll * polls)));
  const auto per_round = static_cast<std::uint32_t>(std::lround(polls / count * 1048576.0));
  const Blocks blocks{BlockAxis(order.lines(), order.periodic_along()),
                      BlockAxis(order.length(), order.periodic_across()), dice[Roll::slab_blocks]};
  const double speed = std::hypot(static_cast<double>(in.above.x), static_cast<double>(in.above.y));
  const bool speeds_up = p.kind != SlabKind::werner;
  const Fly fly{lattice,
                work.taken.data(),
                lines(speed * static_cast<double>(p.hop_time) / cell),
                speeds_up ? lines(static_cast<double>(p.linear_speedup) / slab) : 0.0f,
                speeds_up ? lines(static_cast<double>(p.square_speedup) / (slab * slab)) : 0.0f,
                reference,
                probability(p.deposit_on_sand),
                probability(p.deposit_on_rock),
                work.cliffs.data(),
                dice[Roll::slab_hops],
                ledger};
  const double fall = std::tan(p.shadow_deg * pi / 180.0) * path * cell * per_metre;
  const auto shaded_lines =
      static_cast<int>(std::ceil(static_cast<double>(p.longest_shadow) / (path * cell)));
  return {lattice,
          blocks,
          {lattice, static_cast<Quanta>(std::lround(fall))},
          {p.polling, per_round, most_polls(blocks.most_cells(), per_round), dice[Roll::slab_polls]},
          fly,
          count,
          order.periodic_along() ? -std::min(order.lines(), shaded_lines) : 0,
          speeds_up,
          order.periodic_along() ? 0.0f
                                 : static_cast<float>(static_cast<double>(in.influx * in.time_step) / count /
                                                      cell * per_metre / slab)};
}

template <class E>
void do_round(E& exec, const Round& of, int round, const Dice& dice, Workspace& work) {
  const Downwind& order = of.lattice.order;
  const int at_once = of.blocks.most_of_a_colour();
  Fly fly = of.fly;
  if (round % rounds_a_shadow == 0)
    for_each_line_in_turn(exec, of.shaded_from, order.lines(), order.length(), work.lines.data(),
                          of.find_shade);
  if (of.entering > 0.0f) {
    fly.die = of.fly.die.of_part(-1 - round);
    for_each_item(exec, order.length(), Enter{fly, of.entering, dice[Roll::influx].of_part(round)});
  }
  for (int turn = 0; turn < Blocks::colours; ++turn) {
    for_each_item(
        exec, at_once,
        TakeTurn{of.lattice, of.blocks, of.polls, of.spares_shadow, round, turn, work.taken.data()});
    fly.die = of.fly.die.of_part(round * Blocks::colours + turn);
    for_each_item(exec, at_once * of.polls.most, fly);
  }
}

template <class E>
void step(E& exec, const TerrainView& t, const StepInputs& in, const Dice& dice, LedgerView ledger,
          Workspace& work) {
  const Lattice lattice = make_lattice(t, in.model, in.above, work);
  const float* const obstacle = t.real(Layer::obstacle);
  exec.set_zero(work.cliffs.data(), sizeof(Quanta));
  for_each_cell(exec, t.grid,
                TakeStacks{lattice, t.quanta(Layer::bedrock), t.quanta(Layer::soil), t.quanta(Layer::sand),
                           obstacle, work.cliffs.data()});
  const Round all =
      make_round(t, in, lattice, reference_height(exec, t.grid, lattice, in.model.kind), dice, ledger, work);
  const bool windy = in.above.x != 0.0f || in.above.y != 0.0f;
  for (int round = 0; windy && round < all.count; ++round) do_round(exec, all, round, dice, work);
  constexpr int rounds_to_rest = 2;
  for (int turn = 0; turn < rounds_to_rest * Blocks::colours; ++turn)
    for_each_item(exec, all.blocks.most_of_a_colour(), Settle{lattice, all.blocks, turn % Blocks::colours});
  for_each_cell(exec, t.grid, PutSand{lattice, obstacle, t.quanta(Layer::sand)});
  blow(exec, t, in.above);
}

template void blow(Backend&, const TerrainView&, wind::Vector);
template void step(Backend&, const TerrainView&, const StepInputs&, const Dice&, LedgerView, Workspace&);

}  // namespace desert_sim::slabs
