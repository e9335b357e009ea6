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
  DESERT_HD long long operator()(int x, int y) const { return lattice.height[lattice.slot_of(x, y)]; }
};
struct DeviationSum {
  Lattice lattice;
  Quanta mean;
  DESERT_HD long long operator()(int x, int y) const {
    const Quanta above = lattice.height[lattice.slot_of(x, y)] - mean;
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

/// How many parts of at most `size` a count has.
inline int parts(int count, int size) { return (count + size - 1) / size; }
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
          work.base.data(),
          work.shade.data(),
          work.state.data(),
          work.pending.data(),
          Lattice::quarter_of(order.length()),
          4 * Lattice::quarter_of(order.length())};
}

template <class E>
void blow(E& exec, const TerrainView& t, wind::Vector above) {
  for_each_cell(exec, t.grid, Blow{t.grid, above, t.real(Layer::wind_x), t.real(Layer::wind_y)});
}

/// Polls of the turn with this number, of a step of so many poll times. No turn lasts from one poll time into
/// the next.
inline Polls polls_of_turn(SlabPolling polling, int turn, double poll_times, Die die) {
  const double whole = std::floor(poll_times);
  const bool is_whole = turn < whole * turns_a_poll;
  const double rest = poll_times - whole, rest_turns = std::ceil(rest * turns_a_poll - 1e-6);
  const double length = is_whole ? 1.0 / turns_a_poll : rest / rest_turns;
  const double begin = is_whole ? turn * length : whole + (turn - whole * turns_a_poll) * length;
  Polls polls{polling, {}, 0, 0, die, static_cast<std::uint32_t>(turn)};
  const double mean = length * Colours::longest_run;
  double term = std::exp(-mean), up_to = term;
  for (int n = 0; n < Polls::most; ++n) {
    polls.more_than[n] = static_cast<std::uint32_t>((1.0 - up_to) * 4294967296.0);
    term *= mean / (n + 1);
    up_to += term;
  }
  const auto fixed_point = [](double t) {
    return static_cast<std::uint64_t>(std::llround(t * 4294967296.0));
  };
  polls.begin = fixed_point(begin);
  polls.last = static_cast<std::uint32_t>(fixed_point(begin + length) - 1);
  return polls;
}
inline int turns_of(double poll_times) {
  const double whole = std::floor(poll_times), rest = poll_times - whole;
  return static_cast<int>(whole * turns_a_poll + std::ceil(rest * turns_a_poll - 1e-6));
}

/// Everything of a step that its turns share.
struct Turns {
  Lattice lattice;
  Colours colours;
  FindShade find_shade;
  SlabPolling polling;
  Taken taken;
  Fly fly;
  double poll_times;   ///< of the step
  int count;           ///< turns of the step
  bool spares_shadow;  ///< no slab is taken there
  float entering;      ///< slabs that the wind brings to a place of an open edge in a turn
};

inline Turns make_turns(const TerrainView& t, const StepInputs& in, const Lattice& lattice, float reference,
                        const Dice& dice, LedgerView ledger, const Workspace& work) {
  const SlabModelParameters& p = in.model;
  const Downwind& order = lattice.order;
  const double cell = static_cast<double>(t.grid.cell_size),
               per_metre = static_cast<double>(t.quanta_per_metre), slab = static_cast<double>(lattice.slab);
  const double path =
      std::hypot(1.0, static_cast<double>(order.shift(in.above.x, in.above.y)));  // [cells a line]
  const auto lines = [&](double cells) { return static_cast<float>(cells / path); };
  const double poll_times = static_cast<double>(in.time_step) / static_cast<double>(p.poll_time);
  const int count = turns_of(poll_times);
  const double speed = std::hypot(static_cast<double>(in.above.x), static_cast<double>(in.above.y));
  const bool speeds_up = p.kind != SlabKind::werner;
  const Taken taken{work.taken_cells.data(), work.taken_counts.data(), Taken::capacity_of(order.length())};
  const Fly fly{lattice,
                taken,
                parts(order.length(), 8 * Fly::at_once),
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
          {{order.lines(), order.periodic_along()}, {order.length(), order.periodic_across()}},
          {lattice, static_cast<Quanta>(std::lround(fall)), std::min(order.lines(), shaded_lines)},
          p.polling,
          taken,
          fly,
          poll_times,
          count,
          speeds_up,
          order.periodic_along() ? 0.0f
                                 : static_cast<float>(static_cast<double>(in.influx * in.time_step) / count /
                                                      cell * per_metre / slab)};
}

inline Grid columns_and_rows(int columns, int rows) {
  Grid grid;
  grid.width = columns;
  grid.height = rows;
  return grid;
}
/// Lets all runs of all colours have their turn: law_of(colour)(column, row).
template <class E, class LawOf>
void for_each_colour(E& exec, const Colours& colours, const LawOf& law_of) {
  for (int colour = 0; colour < colours.count(); ++colour) {
    const Grid runs = columns_and_rows(colours.columns(colour), colours.rows(colour));
    if (runs.cells() > 0) for_each_cell(exec, runs, law_of(colour));  // narrow grids lack colours
  }
}
template <class E>
void settle_all(E& exec, const Turns& of) {
  for_each_colour(exec, of.colours, [&](int colour) { return Settle{of.lattice, of.colours, colour}; });
}

template <class E>
void do_turn(E& exec, const Turns& of, int turn, const Dice& dice) {
  const Downwind& order = of.lattice.order;
  if (turn % turns_a_shadow == 0)
    for_each_cell(exec,
                  columns_and_rows(parts(of.lattice.pitch, FindShade::at_once),
                                   parts(order.lines(), FindShade::lines_of_a_thread)),
                  of.find_shade);
  Fly fly = of.fly;
  if (of.entering > 0.0f) {
    fly.die = of.fly.die.of_part(-1 - turn);
    for_each_item(exec, order.length(), Enter{fly, of.entering, dice[Roll::influx].of_part(turn)});
  }
  const Polls polls = polls_of_turn(of.polling, turn, of.poll_times, dice[Roll::slab_polls]);
  exec.set_zero(of.taken.counts, sizeof(int) * static_cast<std::size_t>(order.lines()));
  for_each_colour(exec, of.colours, [&](int colour) {
    return TakeTurn{of.lattice, of.colours, colour, polls, of.spares_shadow, of.taken};
  });
  fly.die = of.fly.die.of_part(turn);
  for_each_cell(exec, columns_and_rows(fly.columns, order.lines()), fly);
  settle_all(exec, of);
}

template <class E>
void step(E& exec, const TerrainView& t, const StepInputs& in, const Dice& dice, LedgerView ledger,
          Workspace& work) {
  const Lattice lattice = make_lattice(t, in.model, in.above, work);
  const float* const obstacle = t.real(Layer::obstacle);
  exec.set_zero(work.cliffs.data(), sizeof(Quanta));
  for_each_cell(exec, t.grid,
                TakeStacks{lattice, t.quanta(Layer::bedrock), t.quanta(Layer::soil), t.quanta(Layer::sand),
                           obstacle, work.base.data(), work.cliffs.data()});
  const Turns all =
      make_turns(t, in, lattice, reference_height(exec, t.grid, lattice, in.model.kind), dice, ledger, work);
  const bool windy = in.above.x != 0.0f || in.above.y != 0.0f;
  for (int turn = 0; windy && turn < all.count; ++turn) do_turn(exec, all, turn, dice);
  constexpr int turns_to_rest = 2;
  for (int turn = 0; turn < turns_to_rest; ++turn) settle_all(exec, all);
  for_each_cell(exec, t.grid, PutSand{lattice, obstacle, t.quanta(Layer::sand)});
  blow(exec, t, in.above);
}

template void blow(Backend&, const TerrainView&, wind::Vector);
template void step(Backend&, const TerrainView&, const StepInputs&, const Dice&, LedgerView, Workspace&);

}  // namespace desert_sim::slabs
