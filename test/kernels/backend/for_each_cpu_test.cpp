// Loops of the CPU backend: what they sum, which law gets which cell, and that threads change no bit.

#include "kernels/backend/for_each_cpu.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <thread>
#include <utility>
#include <vector>

#include "kernels/backend/fft.hpp"

namespace desert_sim {
namespace {

/// One cell to work alone; rows fewer than threads; widths that fill no vector; enough cells for all threads.
const Grid grids[] = {{1, 1}, {7, 3}, {20000, 2}, {3, 7001}, {203, 187}, {256, 256}};

// ---- who does what

TEST(WorkStealingRange, EachPieceIsDoneOnceBySomeTeam) {
  for (int parts : {1, 2, 5, 64, 100})
    for (int team : {1, 2, 4})
      for (int count : {0, 1, 3, 31, 1000}) {
        std::vector<std::atomic<int>> done(static_cast<std::size_t>(count));
        WorkStealingRange all(parts, count);
#pragma omp parallel num_threads(team)
        all.work([&](int n) { ++done[static_cast<std::size_t>(n)]; });
        for (const std::atomic<int>& times : done)
          ASSERT_EQ(times, 1) << parts << ", " << team << ", " << count;
      }
}

/// The first thread comes no further than its first piece until the other has done all but a few.
TEST(WorkStealingRange, NobodyWaitsForAThreadThatIsHeldUp) {
  constexpr int count = 3200, few = count / 32;
  std::atomic<int> done{0}, team{0};
  const auto start = std::chrono::steady_clock::now();
  const auto late = [start] { return std::chrono::steady_clock::now() - start > std::chrono::minutes(2); };
  WorkStealingRange all(2, count);
#pragma omp parallel num_threads(2)
  {
    team = omp_get_num_threads();
#pragma omp barrier
    all.work([&](int) {
      while (omp_get_thread_num() == 0 && team == 2 && done < count - few && !late())
        std::this_thread::yield();
      ++done;
    });
  }
  if (team != 2) GTEST_SKIP() << "no second thread";
  EXPECT_EQ(done, count);
  EXPECT_FALSE(late()) << "what the first thread had not begun was left to it";
}

/// Each cell sends to itself, to the next row (from the last to the first) and to a place anywhere.
struct Spread {
  Grid grid;

  template <int count>
  struct Parcels {
    int anywhere[count];
    Quanta amount[count];
  };
  template <int count>
  void prepare(int x, int y, Parcels<count>& parcels, int n) const {
    const auto i = static_cast<std::uint32_t>(grid.index(x, y));
    parcels.anywhere[n] =
        static_cast<int>(multiply_high(i * 2654435761u, static_cast<std::uint32_t>(grid.cells())));
    parcels.amount[n] = static_cast<Quanta>(i % 1000u) - 300;
  }
  template <int count, class Add>
  void deliver(int x, int y, const Parcels<count>& parcels, int n, const Add& add) const {
    add(grid.index(x, y), parcels.amount[n]);
    add(grid.index(x, y + 1 < grid.height ? y + 1 : 0), 7 * parcels.amount[n]);
    add(parcels.anywhere[n], 11 * parcels.amount[n]);
  }
};

std::vector<Quanta> spread_one_by_one(const Grid& grid) {
  std::vector<Quanta> sums(static_cast<std::size_t>(grid.cells()), 0);
  const Spread law{grid};
  for (int y = 0; y < grid.height; ++y)
    for (int x = 0; x < grid.width; ++x) {
      Spread::Parcels<1> parcel;
      law.prepare(x, y, parcel, 0);
      law.deliver(x, y, parcel, 0,
                  [&](int cell, Quanta amount) { sums[static_cast<std::size_t>(cell)] += amount; });
    }
  return sums;
}

TEST(ForEachCellAdding, SumsTheSameWithAnyNumberOfThreadsWhateverWasThere) {
  for (const Grid& grid : grids) {
    const std::vector<Quanta> expected = spread_one_by_one(grid);
    for (int threads : {1, 2, 5, 16}) {
      CpuExec exec(threads);
      std::vector<Quanta> sums(expected.size(), -12345);
      for_each_cell_scatter(exec, grid, sums.data(), Spread{grid});
      EXPECT_EQ(sums, expected) << grid.width << " x " << grid.height << ", " << threads << " threads";
    }
  }
}

struct Count {
  Grid grid;
  int* visits;
  void operator()(int x, int y) const { ++visits[grid.index(x, y)]; }
};

TEST(ForEachCell, GivesEachCellToOneLawOfABorderedGrid) {
  for (const Grid& grid : grids)
    for (int margin : {0, 1, 3, 90, 30000})
      for (int threads : {1, 3}) {
        CpuExec exec(threads);
        const auto cells = static_cast<std::size_t>(grid.cells());
        std::vector<int> inside(cells, 0), border(cells, 0);
        for_each_cell(exec, grid,
                      Bordered<Count, Count>{grid, margin, {grid, inside.data()}, {grid, border.data()}});
        for (int y = 0; y < grid.height; ++y)
          for (int x = 0; x < grid.width; ++x) {
            const int nearest = std::min({x, y, grid.width - 1 - x, grid.height - 1 - y});
            const auto i = static_cast<std::size_t>(grid.index(x, y));
            ASSERT_EQ(inside[i], nearest >= margin ? 1 : 0) << x << ", " << y << ", margin " << margin;
            ASSERT_EQ(border[i], nearest >= margin ? 0 : 1) << x << ", " << y << ", margin " << margin;
          }
      }
}

TEST(Unrolled, CallsItsBodyInOrder) {
  std::vector<int> seen;
  unrolled<5>([&](auto n) { seen.push_back(n); });
  EXPECT_EQ(seen, (std::vector<int>{0, 1, 2, 3, 4}));
}

/// 15 × 9 values are an odd number: the second field is aligned to less than the first.
void expect_fields_transformed_alike(FftMethod method) {
  for (const auto& [width, height] : {std::pair{15, 9}, std::pair{24, 20}}) {
    const int values = width * height, fields = 3;
    std::vector<Complex> start(static_cast<std::size_t>(values * fields));
    for (std::size_t n = 0; n < start.size(); ++n)
      start[n] = {std::sin(0.7f * static_cast<float>(n)), std::cos(0.3f * static_cast<float>(n * n % 101))};
    std::vector<std::vector<Complex>> results;
    for (int threads : {1, 2, 4}) {
      CpuExec exec(threads);
      std::vector<Complex> all = start;
      const auto transform = exec.make_fft(width, height, fields, method);
      transform->forward(all.data());
      results.push_back(all);
      EXPECT_EQ(std::memcmp(all.data(), results[0].data(), all.size() * sizeof(Complex)), 0) << threads;
      transform->inverse(all.data());
      for (std::size_t n = 0; n < all.size(); ++n) {
        ASSERT_NEAR(all[n].re / values, start[n].re, 1e-5);
        ASSERT_NEAR(all[n].im / values, start[n].im, 1e-5);
      }
    }
    // The zeroth coefficient of each field is the sum of its values.
    for (int field = 0; field < fields; ++field) {
      double sum = 0;
      for (int n = 0; n < values; ++n) sum += start[static_cast<std::size_t>(field * values + n)].re;
      EXPECT_NEAR(results[0][static_cast<std::size_t>(field * values)].re, sum, 1e-3);
    }
  }
}

TEST(CpuTransforms, OfSeveralFieldsAreThoseOfEachWithAnyNumberOfThreads) {
  for (const FftMethod method : {FftMethod::library, FftMethod::columns_first, FftMethod::rows_first})
    expect_fields_transformed_alike(method);
}

}  // namespace
}  // namespace desert_sim
