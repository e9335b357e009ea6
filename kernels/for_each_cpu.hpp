#pragma once
/// Loops over cells and tiles on the CPU, with OpenMP; see for_each.hpp.

#include "desert_sim/kernels/for_each.hpp"

/// A function compiled for several instruction sets, of which the loader takes the widest that the processor
/// has. Sanitizers are not up yet when the loader chooses.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define DESERT_CLONES __attribute__((noinline, target_clones("default", "avx2", "arch=skylake-avx512")))
#else
#define DESERT_CLONES
#endif

namespace desert_sim {

/// One thread as the whole team that works on a tile.
struct CpuTeam {
  char* scratch;

  /// Calls body(i) for i in 0…n−1; all of it is done when it returns.
  template <class Body>
  DESERT_HD void for_each(int n, const Body& body) const {
    for (int i = 0; i < n; ++i) body(i);
  }
  /// Whether predicate(i) holds for any i in 0…n−1.
  template <class Predicate>
  DESERT_HD bool any(int n, const Predicate& predicate) const {
    for (int i = 0; i < n; ++i)
      if (predicate(i)) return true;
    return false;
  }
  /// Calls body(y) for the rows of a tile; all are done when it returns.
  template <class Body>
  DESERT_HD void for_each_row(const Body& body) const {
    for (int y = 0; y < Tiles::side; ++y) body(y);
  }
  /// Inside a row: body(x) for its cells, which do not depend on each other.
  template <class Body>
  DESERT_HD void for_each_in_row(const Body& body) const {
#pragma omp simd
    for (int x = 0; x < Tiles::side; ++x) body(x);
  }
  /// Inside a row: runs body(x) for all its cells; whether it returned true for any.
  template <class Body>
  DESERT_HD bool any_in_row(const Body& body) const {
    int any = 0;
#pragma omp simd reduction(| : any)
    for (int x = 0; x < Tiles::side; ++x) any |= body(x) ? 1 : 0;
    return any != 0;
  }
  /// Inside a row: whether this is the one thread that writes what the row shares.
  DESERT_HD bool leads_row() const { return true; }
};

/// One tile. No instruction set fuses multiplications with additions (-ffp-contract=off): all give the same
/// bits.
template <class Law>
DESERT_CLONES void run_tile(const Law& law, const CpuTeam& team, int column, int row) {
  law(team, column, row);
}

/// One row of cells, likewise.
template <class Law>
DESERT_CLONES void run_row(const Law& law, int y, int width) {
  for (int x = 0; x < width; ++x) law(x, y);
}

/// Below so many cells, waking other threads costs more than they bring.
constexpr int worth_threads = 16384;

template <class Law>
void for_each_cell(CpuExec& exec, const Grid& grid, const Law& law) {
#pragma omp parallel for schedule(static) num_threads(exec.threads()) if (grid.cells() >= worth_threads)
  for (int y = 0; y < grid.height; ++y) run_row(law, y, grid.width);
}

/// `Law::scratch_bytes` of memory are shared by the team; law(team, column, row).
template <class Law>
void for_each_tile(CpuExec& exec, const Tiles& tiles, const Law& law) {
  const int columns = tiles.columns(), count = tiles.count();
#pragma omp parallel num_threads(exec.threads()) if (tiles.grid.cells() >= worth_threads)
  {
    alignas(64) char scratch[Law::scratch_bytes];
    const CpuTeam team{scratch};
#pragma omp for schedule(static)
    for (int t = 0; t < count; ++t) run_tile(law, team, t % columns, t / columns);
  }
}

template <class Law>
long long sum_cells(CpuExec& exec, const Grid& grid, const Law& law) {
  long long total = 0;
#pragma omp parallel for schedule(static) num_threads(exec.threads()) if (grid.cells() >= worth_threads) reduction(+ : total)
  for (int y = 0; y < grid.height; ++y)
    for (int x = 0; x < grid.width; ++x) total += law(x, y);
  return total;
}

template <class Law>
float max_cells(CpuExec& exec, const Grid& grid, const Law& law) {
  float largest = 0;
#pragma omp parallel for schedule(static) num_threads(exec.threads()) if (grid.cells() >= worth_threads) reduction(max : largest)
  for (int y = 0; y < grid.height; ++y)
    for (int x = 0; x < grid.width; ++x) {
      const float value = law(x, y);
      largest = value > largest ? value : largest;
    }
  return largest;
}

}  // namespace desert_sim
