#pragma once
/// The laws of slab_model.hpp: polls, flights, the shadow. How slabs roll is in rolling.hpp, how layers
/// become stacks is in stacks.hpp.

#include "kernels/slabs/rolling.hpp"
#include "kernels/slabs/slab_model.hpp"

namespace desert_sim::slabs {

/// The shadow over each cell: from a line to the next, along the wind's ways, it falls by `fall`, or begins
/// anew at a higher cell. The lines are divided among threads, each of which begins `lead` lines before its
/// own: shadows are at least as long. The ways of a line are numbered as the places of line 0 lie in memory.
struct FindShade {
  Lattice lattice;
  Quanta fall;  ///< [quanta a line]
  int lead;

  static constexpr Quanta none = -wall_height;
  static constexpr int lines_of_a_thread = 256;
  /// A CPU follows many ways at once, as vectors; a GPU loads cells ahead of their turn.
#if defined(__CUDACC__)
  static constexpr int at_once = 1, ahead = 8;
#else
  static constexpr int at_once = 64, ahead = 1;
#endif
  static constexpr int cells_of_a_call = at_once * lines_of_a_thread;
  struct Cell {
    Quanta height;
    bool begins;  ///< the way comes in over an open edge
    int slot;
  };

  DESERT_HD void operator()(int column, int part) const {
    const int own = part * lines_of_a_thread, lines = lattice.order.lines(),
              begin = lattice.order.periodic_along() || own > lead ? own - lead : 0,
              end = own + lines_of_a_thread < lines ? own + lines_of_a_thread : lines;
    const int first_way = column * at_once, left = lattice.pitch - first_way,
              ways = left < at_once ? left : at_once;
    Quanta shade[at_once];
    for (int n = 0; n < ways; ++n) shade[n] = none;
    Cell cells[ahead];
    for (int first = begin; first < end; first += ahead) {
      if (at_once > 1) {
        pass_line(first, first_way, ways, first >= own, shade);
      } else {
        unrolled<ahead>(
            [&](auto n) DESERT_INLINE { cells[n] = load(first + n < end ? first + n : end - 1, first_way); });
        unrolled<ahead>([&](auto n) DESERT_INLINE {
          if (first + n < end) pass(cells[n], first + n >= own, shade[0]);
        });
      }
    }
  }

 private:
  DESERT_HD void pass_line(int line, int first_way, int ways, bool is_own, Quanta* shade) const {
#if !defined(__CUDACC__)
#pragma omp simd
#endif
    for (int n = 0; n < ways; ++n) pass(load(line, first_way + n), is_own, shade[n]);
  }
  DESERT_HD Cell load(int line, int way) const {
    const Downwind& order = lattice.order;
    const int length = order.length(), offset = lattice.offset(line),
              step = offset - lattice.offset(line - 1), l = line < 0 ? line + order.lines() : line;
    const int first = lattice.place_of_slot(way), unwrapped = first + wrap(offset, length);
    const int place = unwrapped - (unwrapped >= length ? length : 0), before = place - step;
    const bool begins = !order.periodic_across() && (before < 0 || before >= length);
    const int slot = first < length ? lattice.slot(l, place) : l * lattice.pitch + way;  // unused words
    return {lattice.height[slot], begins, slot};
  }
  DESERT_HD void pass(const Cell& here, bool is_own, Quanta& shade) const {
    const Quanta fallen = shade - fall, found = here.begins || fallen < none ? none : fallen;
    shade = here.height > found ? here.height : found;
    if (!is_own) return;
    lattice.shade[here.slot] = found;
    lattice.set_state(here.slot, here.height, found);
  }
};

/// Which cells of a run are polled in a turn. At random, their number follows Poisson's law.
struct Polls {
  static constexpr int most = 8;  ///< in a run and turn; more would come once in a million

  SlabPolling polling;
  std::uint32_t more_than[most];  ///< probability of more than n polls in a run [2⁻³²]
  std::uint64_t begin;            ///< of the turn in the step [poll times; 2⁻³²]
  std::uint32_t last;             ///< of the turn in that poll time, which it does not leave [2⁻³²]
  Die die;                        ///< of the step
  std::uint32_t turn;

  /// Calls poll(n) for cells of a run, which begins at slot `first`.
  template <class Poll>
  DESERT_HD void of(const Run& run, int first, const Poll& poll) const {
    if (polling == SlabPolling::non_repeated) return each_once(run, first, poll);
    const std::uint32_t word = scrambled(die.word(first) + turn * 0x9e3779b9u);
    int count = 0;
    unrolled<most>([&](auto n) DESERT_INLINE { count += word < more_than[n]; });
    std::uint32_t cells = scrambled(word + 0x9e3779b9u);
    static_assert(Colours::longest_run == 16 && most == 8, "four bits a poll");
    for (; count > 0; --count, cells >>= 4)
      if (static_cast<int>(cells & 15u) < run.count) poll(static_cast<int>(cells & 15u));
  }

 private:
  /// A cell has its turn at a time of its own in each poll time.
  template <class Poll>
  DESERT_HD void each_once(const Run& run, int first, const Poll& poll) const {
    const auto time = static_cast<std::uint32_t>(begin >> 32);
    for (int n = 0; n < run.count; ++n) {
      const std::uint32_t own = scrambled(die.word(first + n) + time * 0x9e3779b9u);
      if (own >= static_cast<std::uint32_t>(begin) && own <= last) poll(n);
    }
  }
};

/// Slabs that were taken in a turn: their cells, line by line. Threads never share a line.
struct Taken {
  std::uint32_t* cells;  ///< numbers in the line · 16 + number of the slab in its run
  int* counts;           ///< of a line
  int capacity;          ///< of a line

  static int capacity_of(int length) {
    const int runs = (Lattice::quarter_of(length) + Colours::longest_run - 1) / Colours::longest_run;
    return Colours::longest_run * (4 * runs + 3);
  }
  DESERT_HD void append(int line, std::uint32_t cell, std::uint32_t number) const {
    cells[of_line(line) + static_cast<std::size_t>(add_in_row(&counts[line], 1))] =
        cell * 16u + (number & 15u);
  }
  DESERT_HD std::size_t of_line(int line) const {
    return static_cast<std::size_t>(line) * static_cast<std::size_t>(capacity);
  }
};

/// The turn of a colour: what is pending settles, then cells are polled.
struct TakeTurn {
  static constexpr int cells_of_a_call = Colours::longest_run;
  Lattice lattice;
  Colours colours;
  int colour;
  Polls polls;
  bool shadow_protects;
  Die erosion;  ///< of the turn, where the wind does not take all slabs
  Taken taken;

  DESERT_HD void operator()(int column, int row) const {
    const Run run = colours.run(colour, column, row);
    if (run.count <= 0) return;
    with_rolling(lattice, run, [&](const auto& rolling) DESERT_INLINE {
      rolling.settle();
      std::uint32_t number = 0, polled = 0;
      polls.of(run, rolling.first, [&](int n) DESERT_INLINE {
        const int at = rolling.first + n;
        if (!lattice.can_give(at) || (shadow_protects && lattice.is_shaded(at))) return;
        if (lattice.resistance != nullptr &&
            lattice.withstands(at, erosion.word(at + static_cast<int>(polled++ * 0x9e3779b9u))))
          return;
        rolling.make_hole(n);
        taken.append(run.line, static_cast<std::uint32_t>(at - run.line * lattice.pitch), number++);
      });
    });
  }
};

/// A slab that was taken flies until it stays.
struct Fly {
  Lattice lattice;
  Taken taken;
  int columns;                                 ///< threads that share the slabs of a line
  float hop;                                   ///< L_0 [lines]
  float linear, square;                        ///< C_1, C_2 [lines/quantum, lines/quantum²]
  float reference;                             ///< h_ref [quanta]
  std::uint32_t stays_on_sand, stays_on_rock;  ///< probabilities [2⁻³²]
  const Quanta* cliffs;                        ///< whether there is any rock steeper than repose
  Die die;                                     ///< of the turn
  LedgerView ledger;

  struct Flight {
    int line, place;
    Quanta height;       ///< from which it takes its next hop
    std::uint32_t word;  ///< random
  };
  static constexpr int most_hops = 4096;
  /// What a hop returns if the slab flies on, or has left the grid.
  static constexpr int on = -1, out = -2;
  /// A CPU lets many slabs hop in turn, so that none waits for the memory that another needs, nor for a guess
  /// of how many hops there are.
#if defined(__CUDACC__)
  static constexpr int at_once = 1;
#else
  static constexpr int at_once = 64;
#endif
  static constexpr int cells_of_a_call = 8 * at_once;

  DESERT_HD void operator()(int column, int line) const {
    const int count = taken.counts[line];
    Flight flights[at_once];
    for (int first = column * at_once; first < count; first += columns * at_once) {
      const int slabs = count - first < at_once ? count - first : at_once;
      for (int n = 0; n < slabs; ++n)
        flights[n] = start(line, taken.cells[taken.of_line(line) + static_cast<std::size_t>(first + n)]);
      fly(flights, slabs, line);
    }
  }
  DESERT_HD Flight start(int line, std::uint32_t cell) const {
    const int from = static_cast<int>(cell / 16u), at = line * lattice.pitch + from;
    return {line, lattice.place_of_slot(from), lattice.height[at],
            die.word(at + static_cast<int>((cell & 15u) * 0x9e3779b9u))};
  }
  /// `number`: of the account for what leaves the grid.
  DESERT_HD void fly(Flight* flights, int slabs, int number) const {
    int stayed[at_once], gone = 0;
    for (int hops = 0; slabs > 0; ++hops) {
      int flying = 0, staying = 0;
      for (int n = 0; n < slabs; ++n) {
        Flight flight = flights[n];
        const int to = do_hop(flight, hops == most_hops);
        flights[flying] = flight;
        stayed[staying] = to;
        flying += to == on;
        staying += to >= 0;
        gone += to == out;
      }
      for (int n = 0; n < staying; ++n) atomic_add(&lattice.pending[stayed[n]], Lattice::one_slab);
      slabs = flying;
    }
    if (gone > 0) ledger.book_out(Material::sand, number, gone * lattice.slab);
  }
  /// The cell where the slab stays, `on` or `out`.
  DESERT_HD int do_hop(Flight& flight, bool is_last) const {
    const Downwind& order = lattice.order;
    flight.word = scrambled(flight.word + 0x9e3779b9u);
    const int lines = lines_of_hop(flight.height, flight.word);
    int before = -1;
    if (*cliffs != 0 && hits_rock(flight.line, flight.place, lines, before)) return before;
    const int offset = lattice.offset(flight.line + lines) - lattice.offset(flight.line);
    flight.line += lines;
    flight.place += offset;
    if (order.periodic_along()) flight.line = wrap(flight.line, order.lines());
    if (order.periodic_across()) flight.place = wrap(flight.place, order.length());
    if (static_cast<unsigned>(flight.line) >= static_cast<unsigned>(order.lines()) ||
        static_cast<unsigned>(flight.place) >= static_cast<unsigned>(order.length()))
      return out;
    const int n = lattice.slot(flight.line, flight.place);
    if (linear != 0.0f || square != 0.0f) flight.height = lattice.height[n];
    flight.word = scrambled(flight.word + 0x9e3779b9u);
    const std::uint8_t state = lattice.state[n];
    const std::uint32_t chance = (state & Lattice::has_slab_bit) != 0 ? stays_on_sand : stays_on_rock;
    const bool rests =
        lattice.resistance == nullptr ? flight.word < chance : lattice.keeps(n, chance, flight.word);
    const bool stays = ((state & Lattice::shaded_bit) != 0) | rests | is_last;
    return stays ? n : on;
  }
  DESERT_HD int lines_of_hop(Quanta height, std::uint32_t word) const {
    const float above = static_cast<float>(height) - reference;
    const float lines = hop + above * (linear + maximum(above, 0.0f) * square);
    const int whole =
        static_cast<int>(minimum(lines, static_cast<float>(max_displacement)) + unit_from(word));
    return whole > 1 ? whole : 1;
  }
  /// Whether rock that is steeper than repose rises before the end of a hop; `before`: the cell before it.
  DESERT_HD bool hits_rock(int line, int place, int lines, int& before) const {
    int last = lattice.slot_within(line, place);
    for (int d = 1; d <= lines; ++d) {
      const int n = lattice.slot_within(line + d, place + lattice.offset(line + d) - lattice.offset(line));
      if (n < 0) return false;
      if (last >= 0 && !lattice.has_slab(n) && lattice.height[n] - lattice.height[last] > lattice.repose) {
        before = last;
        return true;
      }
      last = n;
    }
    return false;
  }
};

/// What the wind brings over an open edge flies on from the line before the first.
struct Enter {
  Fly fly;
  float slabs;  ///< a place
  Die die;

  DESERT_HD void operator()(int place) const {
    if (fly.lattice.height[fly.lattice.slot(0, place)] >= fill_limit) return;  // there is no room
    const Quanta count = die.whole_at_most(slabs, 65535, place);
    for (Quanta n = 0; n < count; ++n) {
      fly.ledger.book_in(Material::sand, place, fly.lattice.slab);
      Fly::Flight flight{-1, place, static_cast<Quanta>(fly.reference),
                         fly.die.word(-1 - place - n * fly.lattice.order.length())};
      fly.fly(&flight, 1, place);
    }
  }
};

}  // namespace desert_sim::slabs
