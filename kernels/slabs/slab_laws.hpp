#pragma once
/// The laws of slab_model.hpp: turns of blocks, flights, the shadow. How slabs roll is in rolling.hpp.

#include "kernels/slabs/rolling.hpp"
#include "kernels/slabs/slab_model.hpp"

namespace desert_sim::slabs {

/// Stacks of the terrain, and whether there are cliffs of rock.
struct TakeStacks {
  Lattice lattice;
  const Quanta *bedrock, *soil, *sand;
  const float* obstacle;
  Quanta* cliffs;

  /// Of what slabs cannot be taken from: rock, soil, and obstacles with what lies on them.
  DESERT_HD Quanta ground(int i) const {
    const bool solid = value_or_zero(obstacle, i) > 0.0f;
    return bedrock[i] + value_or_zero(soil, i) + (solid ? sand[i] : 0);
  }
  DESERT_HD void operator()(int x, int y) const {
    const Grid& grid = lattice.order.grid;
    const int i = grid.index(x, y), n = lattice.order.slot(x, y);
    const Quanta here = ground(i), loose = value_or_zero(obstacle, i) > 0.0f ? 0 : sand[i];
    lattice.height[n] = bedrock[i] + value_or_zero(soil, i) + sand[i];
    lattice.sand[n] = loose;
    lattice.arriving[n] = 0;
    Quanta most = 0;
    unrolled<4>([&](auto k) DESERT_INLINE {  // east, north, and the diagonals to the north
      const int x_there = k == 0 || k == 2 ? x + 1 : k == 3 ? x - 1 : x, y_there = k == 0 ? y : y + 1;
      const bool there_is = (grid.periodic_x || (x_there >= 0 && x_there < grid.width)) &&
                            (grid.periodic_y || y_there < grid.height);
      const int there = grid.index(wrap_once(x_there, grid.width), wrap_once(y_there, grid.height));
      const Quanta rise = there_is ? ground(there) - here : 0, step = rise < 0 ? -rise : rise;
      most = step > most ? step : most;
    });
    if (most > lattice.repose - lattice.slab && is_flag_clear(cliffs)) set_flag(cliffs);
  }
};

/// The sand of the stacks, with slabs that still roll.
struct PutSand {
  Lattice lattice;
  const float* obstacle;
  Quanta* sand;

  DESERT_HD void operator()(int x, int y) const {
    const int i = lattice.order.grid.index(x, y), n = lattice.order.slot(x, y);
    const Quanta left = value_or_zero(obstacle, i) > 0.0f ? sand[i] : 0;
    const auto rolling = static_cast<Quanta>(lattice.arriving[n] & (Lattice::one_hole - 1u));
    sand[i] = left + lattice.sand[n] + rolling * lattice.slab;
  }
};

/// The layers of the wind: everywhere the undisturbed one.
struct Blow {
  Grid grid;
  wind::Vector above;
  float *wind_x, *wind_y;

  DESERT_HD void operator()(int x, int y) const {
    wind_x[grid.index(x, y)] = above.x;
    wind_y[grid.index(x, y)] = above.y;
  }
};

/// The shadow over each cell: from a line to the next, along the wind's ways, it falls by `fall`, or begins
/// anew at a higher cell.
struct FindShade {
  static constexpr int words = 1, reach = 0;
  using Word = Quanta;
  struct Loaded {
    Quanta height;
    bool begins;  ///< the way comes in over an open edge
    int slot;
  };
  struct Result {
    Quanta shade;
    int slot;
  };
  Lattice lattice;
  Quanta fall;  ///< [quanta a line]
  static constexpr Quanta none = -wall_height;

  DESERT_HD bool around() const { return false; }
  DESERT_HD Quanta beyond(int, Quanta nearest) const { return nearest; }
  DESERT_HD Quanta before_first(int, int) const { return none; }
  DESERT_HD Loaded load(int line, int way) const {
    const Downwind& order = lattice.order;
    const int length = order.length(), offset = lattice.offset(line),
              step = offset - lattice.offset(line - 1);
    const int unwrapped = way + wrap(offset, length);
    const int place = unwrapped - (unwrapped >= length ? length : 0), before = place - step;
    const bool begins = !order.periodic_across() && (before < 0 || before >= length);
    const int slot = (line < 0 ? line + order.lines() : line) * length + place;
    return {lattice.height[slot], begins, slot};
  }
  template <class Before, class After>
  DESERT_HD Result pass(const Loaded& here, const Before& before, const After& after) const {
    const Quanta fallen = before(0) - fall, shade = here.begins || fallen < none ? none : fallen;
    after(0) = here.height > shade ? here.height : shade;
    return {shade, here.slot};
  }
  DESERT_HD void store(int line, int, const Result& result) const {
    if (line >= 0) lattice.shade[result.slot] = result.shade;
  }
};

/// How often the cells of a block are polled in a round. Polls at random follow each other by Poisson's law:
/// an equal number for all blocks would make the bed smoother than it is where each poll may be anywhere.
struct Polls {
  SlabPolling polling;
  std::uint32_t per_round;  ///< polls of a cell [2⁻²⁰]
  int most;                 ///< of a block
  Die die;

  struct Range {
    int begin, end;
  };
  /// Polls of a block of so many cells, numbered through the step.
  DESERT_HD Range of(int round, int cells, std::uint32_t word) const {
    if (polling == SlabPolling::repeated) {
      const float mean = static_cast<float>(cells) * static_cast<float>(per_round) * (1.0f / 1048576.0f);
      return {round * most,
              round * most + poisson(mean, scrambled(word + static_cast<std::uint32_t>(round)))};
    }
    return {before(round, cells, word), before(round + 1, cells, word)};
  }

 private:
  /// Polls of a permutation of n numbers before a round: they add up, whatever the share is.
  DESERT_HD int before(int round, int n, std::uint32_t word) const {
    const std::uint64_t polls = static_cast<std::uint64_t>(round) * per_round * static_cast<std::uint64_t>(n);
    return static_cast<int>((polls + (word >> 12)) >> 20);
  }
  DESERT_HD int poisson(float mean, std::uint32_t word) const {
    const float u = static_cast<float>(word >> 8) * (1.0f / 16777216.0f);
    float term = exp_negative(mean), sum = term;
    int n = 0;
    while (u >= sum && n < most) {
      ++n;
      term *= mean / static_cast<float>(n);
      sum += term;
    }
    return n;
  }
};

/// The turn of a block: what has come settles, then its cells are polled.
struct TakeTurn {
  Lattice lattice;
  Blocks blocks;
  Polls polls;
  bool shadow_protects;
  int round, turn;
  int* taken;  ///< `most` polls of each block of a colour, block after block

  DESERT_HD void operator()(int item) const {
    const Block block = blocks.block(turn, item);
    int* const to = taken + item * polls.most;
    int done = 0;
    if (block.cells() > 0)
      with_rolling(lattice, block, [&](const auto& rolling) DESERT_INLINE {
        settle(rolling);
        done = poll(rolling, block, to);
      });
    for (; done < polls.most; ++done) to[done] = -1;
  }
  template <class Rolling>
  DESERT_HD int poll(const Rolling& rolling, const Block& block, int* to) const {
    const int cells = block.cells();
    int bits = 0;
    while ((1 << bits) < cells) ++bits;
    const std::uint32_t key = polls.die.word(lattice.slot(block.line, block.place));
    const bool each_once = polls.polling == SlabPolling::non_repeated;
    const int numbers = each_once ? 1 << bits : cells;
    const typename Polls::Range range = polls.of(round, numbers, key);
    const int row_of = block.row_factor();
    for (int poll = range.begin; poll < range.end; ++poll) {
      const int cell =
          each_once ? permuted(poll & (numbers - 1), bits, key + static_cast<std::uint32_t>(poll >> bits))
                    : static_cast<int>(
                          multiply_high(scrambled(key + static_cast<std::uint32_t>(poll) * 0x9e3779b9u),
                                        static_cast<std::uint32_t>(cells)));
      const int row = block.row(cell, row_of), column = cell - row * block.places;
      to[poll - range.begin] =
          cell < cells ? take(rolling, rolling.cell(block.line + row, block.place + column)) : -1;
    }
    return range.end - range.begin;
  }
  template <class Rolling, class Cell>
  DESERT_HD int take(const Rolling& rolling, Cell from) const {
    const int n = from.slot;
    if (!lattice.has_slab(n) || (shadow_protects && lattice.height[n] < lattice.shade[n])) return -1;
    rolling.take(from);
    return n;
  }
};

/// A slab that was taken flies until it stays.
struct Fly {
  Lattice lattice;
  const int* taken;
  float hop;                                   ///< L_0 [lines]
  float linear, square;                        ///< C_1, C_2 [lines/quantum, lines/quantum²]
  float reference;                             ///< h_ref [quanta]
  std::uint32_t stays_on_sand, stays_on_rock;  ///< probabilities [2⁻³²]
  const Quanta* cliffs;                        ///< whether there is any rock steeper than repose
  Die die;                                     ///< of the turn
  LedgerView ledger;

  static constexpr int most_hops = 4096;

  DESERT_HD void operator()(int item) const {
    const int from = taken[item];
    if (from < 0) return;
    const int length = lattice.order.length(), line = from / length;
    fly(line, from - line * length, from, item);
  }
  DESERT_HD int lines_of_hop(Quanta height, std::uint32_t word) const {
    const float above = static_cast<float>(height) - reference;
    const float lines = hop + above * (linear + maximum(above, 0.0f) * square);
    const int whole = static_cast<int>(minimum(lines, static_cast<float>(max_displacement)) +
                                       static_cast<float>(word >> 8) * (1.0f / 16777216.0f));
    return whole > 1 ? whole : 1;
  }
  DESERT_HD void fly(int line, int place, int from, int number) const {
    Quanta height = from < 0 ? static_cast<Quanta>(reference) : lattice.height[from];
    std::uint32_t word = die.word(number);
    const bool has_cliffs = *cliffs != 0;
    for (int hops = 0; hops < most_hops; ++hops) {
      word = scrambled(word + 0x9e3779b9u);
      const int lines = lines_of_hop(height, word);
      int landed = -1;
      if (has_cliffs && hits_rock(line, place, lines, landed)) return stay(landed);
      place += lattice.offset(line + lines) - lattice.offset(line);
      line += lines;
      const int n = lattice.slot(line, place);
      if (n < 0) return ledger.book_out(Material::sand, number, lattice.slab);
      if (lattice.order.periodic_along()) line = wrap(line, lattice.order.lines());
      if (lattice.order.periodic_across()) place = wrap(place, lattice.order.length());
      height = lattice.height[n];
      word = scrambled(word + 0x9e3779b9u);
      if (height < lattice.shade[n] || word < (lattice.has_slab(n) ? stays_on_sand : stays_on_rock))
        return stay(n);
      if (hops + 1 == most_hops) stay(n);
    }
  }
  DESERT_HD void stay(int n) const { atomic_add(&lattice.arriving[n], Lattice::one_slab); }
  /// Whether rock that is steeper than repose rises before the end of a hop; `before`: the cell before it.
  DESERT_HD bool hits_rock(int line, int place, int lines, int& before) const {
    int last = lattice.slot(line, place);
    for (int d = 1; d <= lines; ++d) {
      const int n = lattice.slot(line + d, place + lattice.offset(line + d) - lattice.offset(line));
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
    const Quanta count = die.whole_at_most(slabs, 65535, place);
    for (Quanta n = 0; n < count; ++n) {
      fly.ledger.book_in(Material::sand, place, fly.lattice.slab);
      fly.fly(-1, place, -1, -1 - place - n * fly.lattice.order.length());
    }
  }
};

}  // namespace desert_sim::slabs
