/// The step of slab_model.hpp; compiled once for each backend.
#include "kernels/slabs/slab_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/backend/loops.hpp"
#include "kernels/slabs/resistance.hpp"
#include "kernels/slabs/slab_laws.hpp"
#include "kernels/slabs/stacks.hpp"
#include "src/core/elementary.hpp"

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
  if (!speeds_up(kind)) return 0.0f;
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

inline Lattice make_lattice(const TerrainView& t, const StepInputs& in, const Workspace& work) {
  const SlabModelParameters& p = in.model;
  const Downwind order(t.grid, in.above);
  const auto quanta = [&](double metres) {
    return static_cast<Quanta>(std::lround(metres * static_cast<double>(t.quanta_per_metre)));
  };
  const auto repose = [&](float degrees) {
    return quanta(elementary::tan_deg(degrees) * static_cast<double>(t.grid.cell_size));
  };
  // Rounded down, so that a bed of n slab heights, which is rounded to the nearest, has n slabs.
  const auto slab = static_cast<Quanta>(std::floor(static_cast<double>(p.slab_height) * t.quanta_per_metre));
  const bool plants = in.kind == SlabKind::nield_baas;
  return {order,
          to_fixed_point(order.shift(in.above.x, in.above.y)),
          std::max(slab, Quanta{1}),
          repose(p.repose_deg),
          work.height.data(),
          work.base.data(),
          work.shade.data(),
          work.state.data(),
          work.pending.data(),
          Lattice::quarter_of(order.length()),
          4 * Lattice::quarter_of(order.length()),
          has_resistance(in.kind) ? work.resistance.data() : nullptr,
          plants ? in.plants.held_from : std::numeric_limits<float>::infinity(),
          repose(plants ? in.plants.held_repose_deg : p.repose_deg)};
}

template <class E>
void blow(E& exec, const TerrainView& t, wind::Vector above) {
  for_each_cell(exec, t.grid, wind::Blow{t.grid, above, t.real(Layer::wind_x), t.real(Layer::wind_y)});
}

/// When a turn begins, and how long it lasts [poll times since the step began]. No turn lasts from one poll
/// time into the next.
struct TurnTime {
  double begin, length;
};
/// Of the turn with this number, of a step of so many poll times.
inline TurnTime time_of_turn(int turn, double poll_times) {
  const double whole = std::floor(poll_times);
  if (turn < whole * turns_a_poll) return {static_cast<double>(turn) / turns_a_poll, 1.0 / turns_a_poll};
  const double rest = poll_times - whole, length = rest / std::ceil(rest * turns_a_poll - 1e-6);
  return {whole + (turn - whole * turns_a_poll) * length, length};
}
inline Polls polls_of_turn(SlabPolling polling, int turn, const TurnTime& time, Die die) {
  Polls polls{polling, {}, 0, 0, die, static_cast<std::uint32_t>(turn)};
  const double mean = time.length * Colours::longest_run;
  double term = elementary::exp(-mean), up_to = term;
  for (int n = 0; n < Polls::most; ++n) {
    polls.more_than[n] = static_cast<std::uint32_t>(std::max(0.0, 1.0 - up_to) * 4294967296.0);
    term *= mean / (n + 1);
    up_to += term;
  }
  const auto fixed_point = [](double t) {
    return static_cast<std::uint64_t>(std::llround(t * 4294967296.0));
  };
  polls.begin = fixed_point(time.begin);
  polls.last = static_cast<std::uint32_t>(fixed_point(time.begin + time.length) - 1);
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
  const double path = elementary::hypot(1, order.shift(in.above.x, in.above.y));  // [cells a line]
  const auto lines = [&](double cells) { return static_cast<float>(cells / path); };
  const double poll_times = static_cast<double>(in.time_step) / static_cast<double>(p.poll_time);
  const int count = turns_of(poll_times);
  const double speed = elementary::hypot(in.above.x, in.above.y);
  const bool speeding = speeds_up(in.kind);
  const Taken taken{work.taken_cells.data(), work.taken_counts.data(), Taken::capacity_of(order.length())};
  const Fly fly{lattice,
                taken,
                parts(order.length(), Fly::cells_of_a_call),
                lines(speed * static_cast<double>(p.hop_time) / cell),
                speeding ? lines(static_cast<double>(p.linear_speedup) / slab) : 0.0f,
                speeding ? lines(static_cast<double>(p.square_speedup) / (slab * slab)) : 0.0f,
                reference,
                probability(p.deposit_on_sand),
                probability(p.deposit_on_rock),
                work.cliffs.data(),
                dice[Roll::slab_hops],
                ledger};
  const double fall = elementary::tan_deg(p.shadow_deg) * path * cell * per_metre;
  const auto shaded_lines =
      static_cast<int>(std::ceil(static_cast<double>(p.longest_shadow) / (path * cell)));
  const double entering = static_cast<double>(in.influx * in.time_step) / count / cell * per_metre / slab,
               most_entering = most_influx / slab / count;
  return {lattice,
          {{order.lines(), order.periodic_along()}, {order.length(), order.periodic_across()}},
          {lattice, static_cast<Quanta>(std::lround(fall)), std::min(order.lines(), shaded_lines)},
          p.polling,
          taken,
          fly,
          poll_times,
          count,
          speeding,
          order.periodic_along() ? 0.0f : static_cast<float>(std::min(entering, most_entering))};
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
void do_turn(E& exec, const Turns& of, int turn, const TurnTime& time, const Dice& dice) {
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
  const Polls polls = polls_of_turn(of.polling, turn, time, dice[Roll::slab_polls]);
  const Die erosion = dice[Roll::slab_erosion].of_part(turn);
  exec.set_zero(of.taken.counts, sizeof(int) * static_cast<std::size_t>(order.lines()));
  for_each_colour(exec, of.colours, [&](int colour) {
    return TakeTurn{of.lattice, of.colours, colour, polls, of.spares_shadow, erosion, of.taken};
  });
  fly.die = of.fly.die.of_part(turn);
  for_each_cell(exec, columns_and_rows(fly.columns, order.lines()), fly);
  settle_all(exec, of);
}

struct TakenSum {
  const int* counts;
  DESERT_HD long long operator()(int line, int) const { return counts[line]; }
};
/// Slabs that were taken in the last turn. The host waits for the device.
template <class E>
long long count_taken(E& exec, const Turns& of) {
  return sum_cells(exec, columns_and_rows(of.lattice.order.lines(), 1), TakenSum{of.taken.counts});
}

/// All turns of the step, and with forced erosion those for the slabs that are missing then.
template <class E>
void do_turns(E& exec, Turns of, bool forced, const Dice& dice) {
  long long taken = 0;
  for (int turn = 0; turn < of.count; ++turn) {
    do_turn(exec, of, turn, time_of_turn(turn, of.poll_times), dice);
    if (forced) taken += count_taken(exec, of);
  }
  if (!forced) return;
  constexpr double full = 1.0 / turns_a_poll, shortest = 1.0 / 65536;
  const double cells = of.lattice.order.grid.cells(), due = cells * of.poll_times, scatter = std::sqrt(due);
  double share = std::max(1.0, static_cast<double>(taken)) / due;  // of polls that took a slab
  of.entering = 0.0f;
  int idle = 0;
  for (int turn = of.count; turn < most_forced_turns * of.count && idle < turns_a_poll; ++turn) {
    const double missing = due - static_cast<double>(taken);
    if (missing <= scatter) break;
    const double length = std::clamp(missing / (cells * share), shortest, full);
    const double begin = std::ceil(of.poll_times) + (turn - of.count) * full;
    do_turn(exec, of, turn, {begin, length}, dice);
    const long long now = count_taken(exec, of);
    taken += now;
    idle = now == 0 && length == full ? idle + 1 : 0;
    share = std::max(1.0, static_cast<double>(now)) / (cells * length);
  }
}

template <class E>
void step(E& exec, const TerrainView& t, const StepInputs& in, const Dice& dice, LedgerView ledger,
          Workspace& work) {
  const Lattice lattice = make_lattice(t, in, work);
  const float* const obstacle = t.real(Layer::obstacle);
  exec.set_zero(work.cliffs.data(), sizeof(Quanta));
  for_each_cell(exec, t.grid,
                TakeStacks{lattice, t.quanta(Layer::bedrock), t.quanta(Layer::soil), t.quanta(Layer::sand),
                           obstacle, work.base.data(), work.cliffs.data()});
  find_resistance(exec, t, in, lattice, work.resistance.data());
  const Turns all =
      make_turns(t, in, lattice, reference_height(exec, t.grid, lattice, in.kind), dice, ledger, work);
  if (in.above.x != 0.0f || in.above.y != 0.0f) do_turns(exec, all, in.model.forced_erosion, dice);
  constexpr int turns_to_rest = 2;
  for (int turn = 0; turn < turns_to_rest; ++turn) settle_all(exec, all);
  Quanta* const burial = in.kind == SlabKind::nield_baas ? t.quanta(Layer::burial) : nullptr;
  for_each_cell(exec, t.grid, PutSand{lattice, obstacle, t.quanta(Layer::sand), burial});
  change_resistance(exec, t, in);
  blow(exec, t, in.above);
}

template void blow(Backend&, const TerrainView&, wind::Vector);
template void step(Backend&, const TerrainView&, const StepInputs&, const Dice&, LedgerView, Workspace&);

}  // namespace desert_sim::slabs
