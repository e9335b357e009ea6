#pragma once
/// Parallel loops over cells and tiles, called in the same way on both backends. A "law" is a function object
/// that is copied to the device and called for each cell, tile or item:
///
///     for_each_cell(exec, grid, law);              // law(x, y)
///     for_each_cell_scatter(exec, grid, sums, law); // sums[n] = Σ of the amounts that cells send to cell n
///     for_each_tile(exec, tiles, law);             // law(team, column, row): threads share a tile
///     for_each_item(exec, count, law);             // law(n) for n = 0 … count − 1
///     for_each_cell_of_rows(exec, grid, first, rows, law);  // law(x, y) in `rows` rows from `first` on,
///                                                           // wrapped over the north edge
///     for_each_line_in_turn(exec, first, end, length, words, law); // lines first … end − 1 in turn
///     sum_cells(exec, grid, law) -> long long      // Σ law(x, y), exact
///     max_cells(exec, grid, law) -> float          // maximum of 0 and all law(x, y)
///
/// The calls of for_each_cell() must not depend on each other: a CPU processes several cells of a row at
/// once, as SIMD vectors.
///
/// A law whose calls take as long as many cells says so in `cells_of_a_call`: a CPU leaves small grids to one
/// thread, because waking others costs more than it saves.
///
/// A law that sends amounts to other cells has two parts: law.prepare(x, y, parcels, n) fills the nth element
/// of Law::Parcels<count>, a structure of arrays, and law.deliver(x, y, parcels, n, add) sends it with
/// add(cell, amount), or with add.square(…) to a square of 2 × 2 cells. A CPU prepares several cells at once.
/// Neither part may read `sums`.
///
/// A law of for_each_line_in_turn() hands Law::words values of type Law::Word from each of the `length`
/// places of a line to the next line, to places at most Law::reach cells to the side.
///
///     law.load(line, place)             what does not depend on the line before; read ahead of its turn
///     law.pass(loaded, before, after)   finds in before(w, k) word w of the line before, k places further
///                                       on, and sets after(w) for all w; the result goes to law.store()
///     law.complete(here)                only of a law that `completes`: once all places of a line are
///                                       passed, sets here(w) for its last words by the first ones of its
///                                       own and the two places beside, here(w, k)
///     law.store(line, place, result)    is called once for each cell
///     law.before_first(w, place)        what the first line finds
///     law.around()                      whether a line is a ring; if not,
///     law.beyond(w, nearest)            is what is found beyond its ends; `nearest`: word w of the end
///
/// `words` is memory for words_for_lines(Law::words, Law::reach, length) words. A pass may be repeated, with
/// the same result.
///
/// The loops are implemented in for_each_cpu.hpp and for_each_cuda.cuh; sources of processes include
/// loops.hpp.

#include <type_traits>

#include "kernels/backend/atomics.hpp"
#include "kernels/backend/exec.hpp"
#include "kernels/base/grid.hpp"
#include "kernels/base/quanta.hpp"

namespace desert_sim {

/// Law::cells_of_a_call, or 1.
template <class Law, class = void>
struct CellsOfACall {
  static constexpr int value = 1;
};
template <class Law>
struct CellsOfACall<Law, std::void_t<decltype(Law::cells_of_a_call)>> {
  static constexpr int value = Law::cells_of_a_call;
};

/// Law::completes, or false.
template <class Law, class = void>
struct CompletesLines : std::false_type {};
template <class Law>
struct CompletesLines<Law, std::void_t<decltype(Law::completes)>> : std::bool_constant<Law::completes> {};

/// Combines a law for cells at least `margin` cells away from every edge of the grid with one for all others.
template <class Inside, class Border>
struct Bordered {
  Grid grid;
  int margin;
  Inside inside;
  Border border;

  DESERT_HD bool is_inside(int n, int cells) const { return n >= margin && n < cells - margin; }
  DESERT_HD void operator()(int x, int y) const {
    if (is_inside(x, grid.width) && is_inside(y, grid.height))
      inside(x, y);
    else
      border(x, y);
  }
};

/// A law for a band of rows from row `first` on, which continue in the south beyond the north edge.
template <class Law>
struct RowBandLaw {
  Law law;
  int first, height;
  DESERT_HD void operator()(int x, int y) const { law(x, wrap(first + y, height)); }
};
template <class E, class Law>
void for_each_cell_of_rows(E& exec, const Grid& grid, int first, int rows, const Law& law) {
  Grid band = grid;
  band.height = rows;
  for_each_cell(exec, band, RowBandLaw<Law>{law, first, grid.height});
}

/// Combines a law of for_each_line_in_turn() for the places between the ends of a line with one for the ends.
template <class Inside, class Ends>
struct LineWithEnds : Ends {
  Inside inside;
  int length;

  LineWithEnds(const Inside& between, const Ends& ends, int places)
      : Ends(ends), inside(between), length(places) {}
};

/// What the places of a line hand on: word after word, so that neighbouring places lie beside each other,
/// with `reach` more places at either end.
template <class Word>
struct LineWords {
  Word* first;  ///< of place 0
  int pitch;    ///< from a word of a place to its next word

  LineWords() = default;
  DESERT_HD LineWords(Word* memory, int length, int reach)
      : first(memory + reach), pitch(length + 2 * reach) {}
  DESERT_HD Word& operator()(int word, int place) const { return first[word * pitch + place]; }
  /// As seen from a place.
  struct From {
    Word* here;
    int pitch;
    DESERT_HD Word& operator()(int word, int further = 0) const { return here[word * pitch + further]; }
  };
  DESERT_HD From from(int place) const { return {first + place, pitch}; }
};

/// Words of a line, with those beyond its ends.
constexpr std::size_t words_of_line(int words, int reach, int length) {
  return static_cast<std::size_t>(words) * static_cast<std::size_t>(length + 2 * reach);
}
/// Words of the memory of for_each_line_in_turn().
constexpr std::size_t words_for_lines(int words, int reach, int length) {
  return 2 * words_of_line(words, reach, length);
}

/// Calls body(n) for n = 0 … count − 1 as compile-time constants. Loops over cells vectorise only around
/// straight-line code.
template <int count, class Body>
DESERT_HD void unrolled(const Body& body) {
  if constexpr (count > 0) {
    unrolled<count - 1>(body);
    body(std::integral_constant<int, count - 1>());
  }
}

/// Whether a backend processes neighbouring cells of a row at once, as SIMD vectors. There, it does not pay
/// if a law loops over rows in order to share values between cells above each other.
template <class E>
constexpr bool vectorises_rows = std::is_same_v<E, CpuExec>;

/// Square tiles over a grid, shifted by an offset so that the seams of one pass lie inside the tiles of
/// another.
struct Tiles {
  static constexpr int side = 32;
  Grid grid;
  int offset = 0;  ///< 0 … side−1: the first tile begins at −offset

  /// Number of tiles along an axis. On a periodic axis the first tile also holds the last `offset` cells.
  DESERT_HD int tiles_along(int cells, bool periodic) const {
    return (cells + (periodic ? 0 : offset) + side - 1) / side;
  }
  DESERT_HD int columns() const { return tiles_along(grid.width, grid.periodic_x); }
  DESERT_HD int rows() const { return tiles_along(grid.height, grid.periodic_y); }
  DESERT_HD int count() const { return columns() * rows(); }
  /// Column and row of the tile that cell (x, y) lies in. Places beyond the grid are wrapped or clamped, as
  /// in sample_index().
  DESERT_HD int column_of(int x) const { return tile_of(x, grid.width, grid.periodic_x); }
  DESERT_HD int row_of(int y) const { return tile_of(y, grid.height, grid.periodic_y); }

 private:
  DESERT_HD int tile_of(int n, int cells, bool periodic) const {
    return (periodic ? wrap(n + offset, cells) : clamp_index(n, cells) + offset) / side;
  }
};

}  // namespace desert_sim
