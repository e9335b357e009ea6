#pragma once
/// Parallel loops on the CPU, with OpenMP; see for_each.hpp.

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernels/backend/for_each.hpp"
#include "kernels/backend/instruction_set.hpp"
#include "kernels/base/quanta.hpp"

namespace desert_sim {

// ---- Loops for several sets of instructions: instruction_set.hpp

template <class Work>
void with_generic_instructions(const Work& work) {
  work();
}
template <class Work>
DESERT_FOR_AVX2 void with_avx2(const Work& work) {
  work();
}
template <class Work>
DESERT_FOR_AVX512_MASKS void with_avx512_masks(const Work& work) {
  work();
}
template <class Work>
DESERT_FOR_AVX512 void with_avx512(const Work& work) {
  work();
}
/// Calls work(), a lambda marked DESERT_INLINE, with vectors of at most 256 bits. Wider ones made most laws
/// no faster and the wind slower; the masked instructions of AVX-512 make many laws faster.
template <class Work>
void with_wide_instructions(const Work& work) {
  if constexpr (is_compiled(InstructionSet::avx512))
    if (instruction_set == InstructionSet::avx512) return with_avx512_masks(work);
  if constexpr (is_compiled(InstructionSet::avx2))
    if (instruction_set == InstructionSet::avx2) return with_avx2(work);
  if constexpr (is_compiled(InstructionSet::generic)) with_generic_instructions(work);
}
/// The same with the widest vectors, which make sweeps of tiles a third faster: these are nothing but
/// arithmetic.
template <class Work>
void with_widest_instructions(const Work& work) {
  if constexpr (is_compiled(InstructionSet::avx512))
    if (instruction_set == InstructionSet::avx512) return with_avx512(work);
  if constexpr (is_compiled(InstructionSet::avx2))
    if (instruction_set == InstructionSet::avx2) return with_avx2(work);
  if constexpr (is_compiled(InstructionSet::generic)) with_generic_instructions(work);
}

/// One thread as the team that works on a tile.
struct CpuTeam {
  static constexpr int patch_lanes = 8;  ///< patches beside each other that form a vector
  char* scratch;

  /// Calls body(i) for i in 0…n−1. All calls are complete when it returns.
  template <class Body>
  DESERT_HD void for_each(int n, const Body& body) const {
    for (int i = 0; i < n; ++i) body(i);
  }
  /// Minimum of value(i) for i in 0…n−1.
  template <class Value>
  DESERT_HD int min_of(int n, const Value& value) const {
    int least = value(0);
    for (int i = 1; i < n; ++i) least = value(i) < least ? value(i) : least;
    return least;
  }
  /// Maximum of 0 and value(i) for i in 0…n−1; value(i) is called exactly once for each i.
  template <class Value>
  DESERT_HD float max_of(int n, const Value& value) const {
    float greatest = 0;
    for (int i = 0; i < n; ++i) {
      const float v = value(i);
      greatest = v > greatest ? v : greatest;
    }
    return greatest;
  }
  /// The same for x in 0…width−1 and y in 0…height−1; the calls must not depend on each other.
  template <class Body>
  DESERT_HD void for_each(int width, int height, const Body& body) const {
    for (int y = 0; y < height; ++y) {
#pragma omp simd
      for (int x = 0; x < width; ++x) body(x, y);
    }
  }
  template <class Value>
  DESERT_HD int min_of(int width, int height, const Value& value) const {
    int least = value(0, 0);
    for (int y = 0; y < height; ++y) {
#pragma omp simd reduction(min : least)
      for (int x = 0; x < width; ++x) {
        const int v = value(x, y);
        least = v < least ? v : least;
      }
    }
    return least;
  }
  /// Asks for a row of values that are read soon.
  template <class Value>
  DESERT_HD void fetch_ahead(const Value* row, int count) const {
    constexpr int cache_line = 64 / sizeof(Value);
    for (int n = 0; n < count; n += cache_line) __builtin_prefetch(row + n);
    __builtin_prefetch(row + count - 1);
  }
  /// Calls body(y) for each row of a tile. All calls are complete when it returns.
  template <class Body>
  DESERT_HD void for_each_row(const Body& body) const {
    for (int y = 0; y < Tiles::side; ++y) body(y);
  }
  /// Inside a row: calls body(n, k) for the cells n · count + k, which must not depend on each other. k is a
  /// compile-time constant here, but not on a GPU.
  template <int count, class Body>
  DESERT_HD void for_each_in_row(const Body& body) const {
#pragma omp simd
    for (int n = 0; n < Tiles::side / count; ++n) unrolled<count>([&](auto k) DESERT_INLINE { body(n, k); });
  }
};

/// Grids with fewer cells are left to one thread, because waking others costs more than it saves.
constexpr int min_parallel_cells = 16384;
/// Whether a grid of calls of a law is worth several threads.
template <class Law>
bool is_parallel(const Grid& calls) {
  return calls.cells() >= min_parallel_cells / CellsOfACall<Law>::value;
}

/// Work items 0 … count − 1, shared by the threads of a team (work stealing). Each thread takes items of its
/// own part, a few at a time, and then those that are left of other parts. Threads thus do not wait for one
/// that has lost its processor, and otherwise each works on the same memory in every pass.
class WorkStealingRange {
 public:
  WorkStealingRange(int threads, int count) : parts_(std::clamp(threads, 1, max_parts)) {
    const auto start = [&](int part) { return std::int64_t{count} * part / parts_; };
    for (int n = 0; n < parts_; ++n) {
      part_[n].next = start(n);
      part_[n].end = start(n + 1);
    }
    chunk_size_ = std::max(1, count / (parts_ * 16));
  }
  /// To be called by each thread of the team: calls body(n) until no items are left.
  template <class Body>
  void work(const Body& body) {
    const int own = omp_get_thread_num();
    for (int n = 0; n < parts_; ++n) {
      Part& part = part_[(own + n) % parts_];
      for (;;) {
        const std::int64_t first = part.next.fetch_add(chunk_size_, std::memory_order_relaxed);
        if (first >= part.end) break;
        const std::int64_t end = std::min(first + chunk_size_, part.end);
        for (std::int64_t i = first; i < end; ++i) body(static_cast<int>(i));
      }
    }
  }

 private:
  static constexpr int max_parts = 64;
  struct alignas(64) Part {
    std::atomic<std::int64_t> next{0};
    std::int64_t end = 0;
  };
  int parts_;
  std::int64_t chunk_size_;
  Part part_[max_parts];
};

/// Calls law(x, y) for x in first … end−1. The law is copied to a local variable, so that the compiler sees
/// that no cell changes it.
template <class Law>
void for_each_in_row(const Law& law, int first, int end, int y) {
  with_wide_instructions([&]() DESERT_INLINE {
    const Law own = law;
    const int from = first, to = end, row = y;
#pragma omp simd
    for (int x = from; x < to; ++x) own(x, row);
  });
}

template <class Law>
void for_each_cell(CpuExec& exec, const Grid& grid, const Law& law) {
  WorkStealingRange rows(exec.threads(), grid.height);
#pragma omp parallel num_threads(exec.threads()) if (is_parallel <Law>(grid))
  rows.work([&](int y) { for_each_in_row(law, 0, grid.width, y); });
}

template <class Inside, class Border>
void for_each_cell(CpuExec& exec, const Grid& grid, const Bordered<Inside, Border>& law) {
  WorkStealingRange rows(exec.threads(), grid.height);
#pragma omp parallel num_threads(exec.threads()) if (grid.cells() >= min_parallel_cells)
  rows.work([&](int y) {
    const bool inside = law.is_inside(y, grid.height);
    const int begin = inside ? std::min(law.margin, grid.width) : grid.width;
    const int end = std::max(begin, grid.width - law.margin);
    for_each_in_row(law.border, 0, begin, y);
    for_each_in_row(law.inside, begin, end, y);
    for_each_in_row(law.border, end, grid.width, y);
  });
}

/// Lets the cells of a row send their amounts through `add`.
template <class Law, class Add>
void add_row(const Law& law, int width, int y, const Add& add) {
  with_wide_instructions([&]() DESERT_INLINE {
    constexpr int batch = 64;
    typename Law::template Parcels<batch> parcels;
    const Law own = law;
    const Add own_add = add;
    const int row = y, end = width;
    for (int first = 0; first < end; first += batch) {
      const int count = std::min(batch, end - first);
#pragma omp simd
      for (int n = 0; n < count; ++n) own.prepare(first + n, row, parcels, n);
      for (int n = 0; n < count; ++n) own.deliver(first + n, row, parcels, n, own_add);
    }
  });
}

/// Adds amounts to the cells of the band of rows that a thread owns. Amounts for other bands are kept until
/// all threads are done with their own bands. (With atomic additions everywhere, saltation took three times
/// as long.)
struct AddToBand {
  struct Deferred {
    int cell;
    Quanta amount;
  };
  Quanta* sums;
  std::size_t first, count;  ///< cells of the band
  std::vector<Deferred>* deferred;

  void operator()(int cell, Quanta amount) const {
    if (static_cast<std::size_t>(cell) - first < count)
      sums[cell] += amount;
    else
      defer(cell, amount);
  }
  void square(int south, int width, Quanta south_west, Quanta south_east, Quanta north_west,
              Quanta north_east) const {
    (*this)(south, south_west);
    (*this)(south + 1, south_east);
    (*this)(south + width, north_west);
    (*this)(south + width + 1, north_east);
  }

 private:
  __attribute__((noinline)) void defer(int cell, Quanta amount) const { deferred->push_back({cell, amount}); }
};

template <class Law>
void for_each_cell_scatter(CpuExec& exec, const Grid& grid, Quanta* sums, const Law& law) {
#pragma omp parallel num_threads(exec.threads()) if (grid.cells() >= min_parallel_cells)
  {
    const int thread = omp_get_thread_num(), threads = omp_get_num_threads();
    const auto row_of = [&](int t) {
      return static_cast<int>(static_cast<long long>(grid.height) * t / threads);
    };
    const int begin = row_of(thread), end = row_of(thread + 1);
    std::vector<AddToBand::Deferred> deferred;
    const auto width = static_cast<std::size_t>(grid.width);
    const AddToBand band{sums, width * begin, width * (end - begin), &deferred};
    std::fill_n(sums + band.first, band.count, 0);
    for (int y = begin; y < end; ++y) add_row(law, grid.width, y, band);
#pragma omp barrier
    for (const AddToBand::Deferred& k : deferred) atomic_add(sums + k.cell, k.amount);
  }
}

/// Calls law(team, column, row) for each tile. The team shares `Law::scratch_bytes<Team>` bytes of memory.
template <class Tiling, class Law>
void for_each_tile(CpuExec& exec, const Tiling& tiles, const Law& law) {
  const int columns = tiles.columns();
  WorkStealingRange all(exec.threads(), tiles.count());
#pragma omp parallel num_threads(exec.threads()) if (tiles.grid.cells() >= min_parallel_cells)
  {
    alignas(64) char scratch[Law::template scratch_bytes<CpuTeam>];
    const CpuTeam team{scratch};
    all.work([&](int t) {
      with_widest_instructions([&]() DESERT_INLINE { law(team, t % columns, t / columns); });
    });
  }
}

/// Shorter lines are left to one thread.
constexpr int min_parallel_line = 2048;

/// A place of a line; a function of its own, because what is declared in a loop over vectors is kept in
/// memory, and no loop with that is vectorised.
template <class Law, class Words>
DESERT_HD void pass_place(const Law& law, int line, int place, const Words& before, const Words& after) {
  law.store(line, place, law.pass(law.load(line, place), before.from(place), after.from(place)));
}

template <class Law, class Words>
DESERT_HD void complete_place(const Law& law, int place, const Words& words) {
  law.complete(words.from(place));
}

/// The places first … end − 1 of a line that has been passed.
template <class Law>
void complete_line(const Law& law, int first, int end, const LineWords<typename Law::Word>& words) {
  with_wide_instructions([&]() DESERT_INLINE {
    const Law own = law;
    const LineWords<typename Law::Word> passed = words;
    const int begin = first, last = end;
#pragma omp simd
    for (int m = begin; m < last; ++m) complete_place(own, m, passed);
  });
}

/// The places first … end − 1 of a line.
template <class Law>
void pass_line(const Law& law, int line, int first, int end, const LineWords<typename Law::Word>& before,
               const LineWords<typename Law::Word>& after) {
  with_wide_instructions([&]() DESERT_INLINE {
    const Law own = law;
    const LineWords<typename Law::Word> old_words = before, new_words = after;
    const int n = line, begin = first, last = end;
#pragma omp simd
    for (int m = begin; m < last; ++m) pass_place(own, n, m, old_words, new_words);
  });
}

template <class Inside, class Ends>
void pass_line(const LineWithEnds<Inside, Ends>& law, int line, int first, int end,
               const LineWords<typename Ends::Word>& before, const LineWords<typename Ends::Word>& after) {
  const Ends& ends = law;
  const int inside = std::clamp(1, first, end), last = std::clamp(law.length - 1, inside, end);
  pass_line(ends, line, first, inside, before, after);
  pass_line(law.inside, line, inside, last, before, after);
  pass_line(ends, line, last, end, before, after);
}

/// Fills the places beyond the ends of a line that follow from its places first … end − 1.
template <class Law>
void fill_beyond(const Law& law, int length, int first, int end, const LineWords<typename Law::Word>& line) {
  for (int n = 0; n < 2 * Law::reach; ++n) {
    const int place = n < Law::reach ? n - Law::reach : length + n - Law::reach;
    const int from = law.around() ? wrap(place, length) : clamp_index(place, length);
    if (from < first || from >= end) continue;
    for (int w = 0; w < Law::words; ++w)
      line(w, place) = law.around() ? line(w, from) : law.beyond(w, line(w, from));
  }
}

template <class Law>
void for_each_line_in_turn(CpuExec& exec, int first, int end, int length, typename Law::Word* words,
                           const Law& law) {
  using Words = LineWords<typename Law::Word>;
  const Words lines[] = {{words, length, Law::reach},
                         {words + words_of_line(Law::words, Law::reach, length), length, Law::reach}};
  for (int w = 0; w < Law::words; ++w)
    for (int m = 0; m < length; ++m) lines[0](w, m) = law.before_first(w, m);
  fill_beyond(law, length, 0, length, lines[0]);
#pragma omp parallel num_threads(exec.threads()) if (length >= min_parallel_line)
  {
    const long long thread = omp_get_thread_num(), threads = omp_get_num_threads();
    const int from = static_cast<int>(length * thread / threads);
    const int to = static_cast<int>(length * (thread + 1) / threads);
    for (int n = first; n < end; ++n) {
      const Words &before = lines[(n - first) % 2], &after = lines[(n - first + 1) % 2];
      pass_line(law, n, from, to, before, after);
      fill_beyond(law, length, from, to, after);
#pragma omp barrier
      if constexpr (CompletesLines<Law>::value) {
        complete_line(law, from, to, after);
        fill_beyond(law, length, from, to, after);
#pragma omp barrier
      }
    }
  }
}

/// Calls law(n) for each item. An item is taken to be as much work as hundreds of cells.
template <class Law>
void for_each_item(CpuExec& exec, int count, const Law& law) {
  constexpr int min_parallel_items = 256;
#pragma omp parallel for schedule(static) num_threads(exec.threads()) if (count >= min_parallel_items)
  for (int n = 0; n < count; ++n) law(n);
}

template <class Law>
long long sum_cells(CpuExec& exec, const Grid& grid, const Law& law) {
  long long total = 0;
#pragma omp parallel for schedule(static) num_threads(exec.threads()) if (grid.cells() >= min_parallel_cells) \
    reduction(+ : total)
  for (int y = 0; y < grid.height; ++y)
    for (int x = 0; x < grid.width; ++x) total += law(x, y);
  return total;
}

template <class Law>
float max_cells(CpuExec& exec, const Grid& grid, const Law& law) {
  float largest = 0;
#pragma omp parallel for schedule(static)                                             \
    num_threads(exec.threads()) if (grid.cells() >= min_parallel_cells) reduction(max \
                                                                                  : largest)
  for (int y = 0; y < grid.height; ++y)
    for (int x = 0; x < grid.width; ++x) {
      const float value = law(x, y);
      largest = value > largest ? value : largest;
    }
  return largest;
}

}  // namespace desert_sim
