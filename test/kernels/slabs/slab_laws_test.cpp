// The laws of the slab models by themselves: how slabs roll, the shadow, polls, flights, and the influx.

#include "kernels/slabs/slab_laws.hpp"

#include <cmath>

#include "kernels/slabs/stacks.hpp"
#include "test/support/cases.hpp"
#include "test/support/world.hpp"

namespace desert_sim::slabs {
namespace {

constexpr Quanta slab = 100;

/// Stacks of whole slabs on a periodic square, lying at rest in a wind to the east: line x, place y.
struct Stacks {
  static constexpr int side = 32;
  std::vector<Quanta> height, base, shade;
  std::vector<std::uint8_t> state;
  std::vector<std::uint32_t> pending;
  Lattice lattice;

  explicit Stacks(int slabs, wind::Vector wind = {1, 0})
      : height(Lattice::words(side, side)),
        base(height.size()),
        shade(height.size(), FindShade::none),
        state(height.size()),
        pending(height.size()),
        lattice{Downwind(Grid{side, side, 1.0f, true, true}, wind),
                0,
                slab,
                2 * slab,
                height.data(),
                base.data(),
                shade.data(),
                state.data(),
                pending.data(),
                Lattice::quarter_of(side),
                4 * Lattice::quarter_of(side),
                nullptr,
                1.0f,
                2 * slab} {
    lattice.shift = to_fixed_point(lattice.order.shift(wind.x, wind.y));
    for (int x = 0; x < side; ++x)
      for (int y = 0; y < side; ++y) set(x, y, slabs);
  }
  int slot(int x, int y) const { return lattice.slot_within(x, y); }
  void set(int x, int y, int slabs) {
    height[static_cast<std::size_t>(slot(x, y))] = slabs * slab;
    lattice.set_state(slot(x, y), slabs * slab, FindShade::none);
  }
  void set_rock(int x, int y, int slabs) {
    base[static_cast<std::size_t>(slot(x, y))] = slabs * slab;
    set(x, y, slabs);
  }
  void find_shade(Quanta fall) const { FindShade{lattice, fall, side}(0, 0); }
  static Colours colours() { return {{side, true}, {side, true}}; }

  /// Calls work(rolling, n) with the run that has the cell as its nth.
  template <class Work>
  void with_cell(int x, int y, const Work& work) const {
    for (int colour = 0; colour < colours().count(); ++colour)
      for (int row = 0; row < colours().rows(colour); ++row)
        for (int column = 0; column < colours().columns(colour); ++column) {
          const Run run = colours().run(colour, column, row);
          const int n = (y - run.place) / 4;
          if (run.line == x && y >= run.place && (y - run.place) % 4 == 0 && n < run.count)
            with_rolling(lattice, run, [&](const auto& rolling) { work(rolling, n); });
        }
  }
};

TEST(SlabLaws, SlabsRollOverTheSteepestSlope) {
  Stacks s(5);
  const auto downhill = [&] {
    int found = -2;
    s.with_cell(12, 9, [&](const auto& rolling, int n) { found = rolling.template steepest<false>(n); });
    return found;
  };
  s.set(12, 9, 7);
  EXPECT_EQ(downhill(), -1) << "two slabs are at rest";
  s.set(12, 9, 10);
  EXPECT_EQ(downhill(), s.slot(13, 9)) << "of equal slopes the one downwind";
  s.set(12, 10, 3);
  s.set(11, 9, 4);
  EXPECT_EQ(downhill(), s.slot(12, 10));
}

TEST(SlabLaws, HolesRollToTheSteepestSlopeThatHasASlab) {
  Stacks s(5);
  s.set(12, 9, 0);
  s.set(12, 8, 8);
  s.set(13, 9, 6);
  const auto uphill = [&] {
    int found = -2;
    s.with_cell(12, 9, [&](const auto& rolling, int n) { found = rolling.template steepest<true>(n); });
    return found;
  };
  EXPECT_EQ(uphill(), s.slot(12, 8));
  s.set_rock(12, 8, 8);
  EXPECT_EQ(uphill(), s.slot(13, 9)) << "rock gives none";
}

TEST(SlabLaws, HolesKeepTheSlabsThatTheyWillTake) {
  Stacks s(2);
  const int n = s.slot(3, 4);
  std::uint32_t& pending = s.pending[static_cast<std::size_t>(n)];
  EXPECT_TRUE(s.lattice.can_give(n));
  pending = Lattice::one_hole;
  EXPECT_TRUE(s.lattice.can_give(n));
  pending = 2 * Lattice::one_hole;
  EXPECT_FALSE(s.lattice.can_give(n));
}

/// When a step ends, slabs that still roll lie where they are, and holes that do take a slab from there.
TEST(SlabLaws, SlabsThatStillRollAreSand) {
  Stacks s(5);
  const auto pending = [&](int x, int y) -> std::uint32_t& {
    return s.pending[static_cast<std::size_t>(s.slot(x, y))];
  };
  pending(3, 4) = 2 * Lattice::one_slab;
  pending(9, 7) = Lattice::one_hole;
  pending(20, 30) = Lattice::one_slab + 3 * Lattice::one_hole;
  std::vector<Quanta> sand(static_cast<std::size_t>(Stacks::side * Stacks::side), 5 * slab);
  const PutSand put{s.lattice, nullptr, sand.data(), nullptr};
  for (int y = 0; y < Stacks::side; ++y)
    for (int x = 0; x < Stacks::side; ++x) put(x, y);
  const auto at = [&](int x, int y) { return sand[static_cast<std::size_t>(y * Stacks::side + x)]; };
  EXPECT_EQ(at(3, 4), 7 * slab);
  EXPECT_EQ(at(9, 7), 4 * slab);
  EXPECT_EQ(at(20, 30), 3 * slab);
  EXPECT_EQ(at(4, 3), 5 * slab);
}

/// Of a tower of 20 slabs on a bed of 5, one and a half slabs a cell: nine cells, also over the seam.
TEST(SlabLaws, ShadowFallsByItsAngleAndStacksRiseOutOfIt) {
  for (const int x : {6, 28}) {
    SCOPED_TRACE(x);
    Stacks s(5);
    s.set(x, 9, 20);
    s.find_shade(slab * 3 / 2);
    for (int d = 1; d < 20; ++d) {
      const int n = s.slot(x + d, 9);
      EXPECT_EQ(s.shade[static_cast<std::size_t>(n)],
                std::max(20 * slab - d * slab * 3 / 2, 5 * slab - slab * 3 / 2));
      EXPECT_EQ(s.lattice.is_shaded(n), d <= 9) << d;
      EXPECT_FALSE(s.lattice.is_shaded(s.slot(x + d, 10)));
    }
    const int last = s.slot(x + 9, 9);  // under 6.5 slabs
    s.lattice.add(last);
    EXPECT_TRUE(s.lattice.is_shaded(last));
    s.lattice.add(last);
    EXPECT_FALSE(s.lattice.is_shaded(last));
    s.lattice.remove(last);
    EXPECT_TRUE(s.lattice.is_shaded(last));
  }
}

TEST(SlabLaws, MomijiTakesNoSlabFromTheShadow) {
  for (const bool shadow_protects : {false, true}) {
    Stacks s(5);
    s.set(6, 9, 20);
    s.find_shade(slab * 3 / 2);
    s.lattice.repose = 100 * slab;
    const int capacity = Taken::capacity_of(Stacks::side);
    std::vector<std::uint32_t> cells(static_cast<std::size_t>(capacity * Stacks::side));
    std::vector<int> counts(Stacks::side);
    Polls all{SlabPolling::non_repeated, {}, 0, 0xffffffffu, {1, nullptr}, 0};
    for (int colour = 0; colour < Stacks::colours().count(); ++colour)
      for (int row = 0; row < Stacks::colours().rows(colour); ++row)
        for (int column = 0; column < Stacks::colours().columns(colour); ++column)
          TakeTurn{s.lattice,
                   Stacks::colours(),
                   colour,
                   all,
                   shadow_protects,
                   {2, nullptr},
                   {cells.data(), counts.data(), capacity}}(column, row);
    for (int x = 0; x < Stacks::side; ++x) {
      const bool shaded = x > 6 && x <= 15, tower = x == 6;
      EXPECT_EQ(s.height[static_cast<std::size_t>(s.slot(x, 9))],
                ((tower ? 20 : 5) - (shaded && shadow_protects ? 0 : 1)) * slab)
          << x;
    }
  }
}

/// Each turn of a step polls for itself. Where half of the runs of 16 cells have a poll, two turns poll the
/// same cell in one run of 64; if turns were alike, in one of two, and the share of polls would be right.
TEST(SlabLaws, EachTurnPollsCellsOfItsOwn) {
  Polls polls{SlabPolling::repeated, {}, 0, 0, {5, nullptr}, 0};
  polls.more_than[0] = 1u << 31;
  constexpr int runs = 20000;
  const auto polled = [&](std::uint32_t turn, int n) {
    polls.turn = turn;
    int cell = -1;
    polls.of({0, 0, Colours::longest_run}, Colours::longest_run * n, [&](int of) { cell = of; });
    return cell;
  };
  int once = 0, twice = 0;
  for (int n = 0; n < runs; ++n) {
    const int now = polled(3, n), next = polled(4, n);
    once += now >= 0;
    twice += now >= 0 && now == next;
  }
  EXPECT_NEAR(once / static_cast<double>(runs), 1.0 / 2, 0.016);  // 4.5 standard errors
  EXPECT_NEAR(twice / static_cast<double>(runs), 1.0 / 64, 0.004);
}

// ---- flights

struct Flights {
  Quanta cliffs = 0;
  Fly fly;

  Flights(const Stacks& s, float hop, double on_sand, double on_rock)
      : fly{s.lattice,
            {},
            1,
            hop,
            0,
            0,
            5.0f * slab,
            static_cast<std::uint32_t>(on_sand * 4294967295.0),
            static_cast<std::uint32_t>(on_rock * 4294967295.0),
            &cliffs,
            {3, nullptr},
            {}} {}

  static constexpr int tries = 20000;
  /// Where the nth of many hops from a cell ends.
  int hop_from(int line, int place, int n) const {
    Fly::Flight flight{line, place, 5 * slab, scrambled(static_cast<std::uint32_t>(n))};
    return fly.do_hop(flight, false);
  }
  double share_that_stays(int line, int place) const {
    int stayed = 0;
    for (int n = 0; n < tries; ++n) stayed += hop_from(line, place, n) != Fly::on;
    return stayed / static_cast<double>(tries);
  }
  /// Mean length of hops from a height [slabs].
  double mean_length(int slabs) const {
    double sum = 0;
    for (int n = 0; n < tries; ++n)
      sum += fly.lines_of_hop(slabs * slab, scrambled(static_cast<std::uint32_t>(n)));
    return sum / tries;
  }
};

/// A share of so many tries has a standard error of 0.0035.
TEST(SlabLaws, SlabsStayWithTheProbabilityOfTheGround) {
  Stacks s(5);
  s.set_rock(10, 9, 5);
  s.set(20, 9, 20);
  s.find_shade(slab * 3 / 2);
  const Flights flights(s, 5, 0.6, 0.4);
  EXPECT_NEAR(flights.share_that_stays(3, 9), 0.6, 0.014) << "on sand";
  EXPECT_NEAR(flights.share_that_stays(5, 9), 0.4, 0.014) << "on rock";
  EXPECT_EQ(flights.share_that_stays(19, 9), 1) << "in the shadow";
}

TEST(SlabLaws, HopsAreLongerOverHighGround) {
  const Stacks s(5);
  Flights flights(s, 2.5f, 1, 1);
  EXPECT_NEAR(flights.mean_length(20), 2.5, 0.015);
  flights.fly.hop = 5;
  flights.fly.linear = 0.4f / slab;
  flights.fly.square = 0.002f / (slab * slab);
  EXPECT_NEAR(flights.mean_length(15), 5 + 4 + 0.2, 0.015);
  EXPECT_NEAR(flights.mean_length(0), 5 - 2, 0.015) << "the square counts above the mean height only";
  EXPECT_EQ(flights.mean_length(-20), 1) << "the shortest hop";
}

TEST(SlabLaws, SlabsFlyWhereTheWindBlows) {
  const Stacks s(5, {2, 1});
  const Flights flights(s, 8, 1, 1);
  EXPECT_EQ(flights.hop_from(4, 9, 1), s.slot(12, 13));
  EXPECT_EQ(flights.hop_from(28, 30, 2), s.slot(4, 2)) << "over the seam";
}

TEST(SlabLaws, SlabsFallDownBeforeACliff) {
  Stacks s(5);
  s.set_rock(12, 9, 20);
  s.set(12, 10, 20);
  Flights flights(s, 6, 1, 1);
  flights.cliffs = 1;
  EXPECT_EQ(flights.hop_from(8, 9, 1), s.slot(11, 9));
  EXPECT_EQ(flights.hop_from(3, 9, 1), s.slot(9, 9)) << "too short to reach it";
  EXPECT_EQ(flights.hop_from(8, 10, 1), s.slot(14, 10)) << "sand is no cliff";
}

class SlabInflux : public test::OnBackend {};

/// 0.01 m² a second over an edge of 48 m are 4.8 slabs; they come by Poisson's law.
TEST_P(SlabInflux, ComesInOverTheOpenWindwardEdge) {
  for (const int degrees : {0, 90}) {
    auto s = simulation(
        test::grid_yaml(48, 48, "open") + "wind: {speed: 5, direction_deg: " + std::to_string(degrees) +
        "}\nsaltation: {influx: 0.01}\nsand: {model: werner}\nslab_model: {slab_height: 0.1}\n");
    test::run(*s, 100);
    const MaterialBalance sand = s->state().balance()[static_cast<std::size_t>(Material::sand)];
    EXPECT_NEAR(sand.cubic_metres(sand.in) / 0.1, 480, 4 * std::sqrt(480));
    test::expect_sound(*s, "after a hundred steps");
  }
}

class SlabTurns : public test::OnBackend {};

/// In steps that are shorter than a turn, too, each cell is polled once in a poll time, on average: of a bed
/// on which each slab that is taken leaves the grid.
TEST_P(SlabTurns, ShortStepsPollAsOftenAsLongOnes) {
  for (const char* polling : {"repeated", "non_repeated"}) {
    auto s = simulation(
        test::grid_yaml(48, 48, "open") +
        "terrain:\n  - uniform: {layer: sand, value: 2}\nwind: {speed: 40}\n"
        "run: {time_step: 0.025}\nsand: {model: werner}\nslab_model: {slab_height: 0.1, hop_time: 10, "
        "polling: " +
        polling + "}\n");
    test::run(*s, 40);
    const MaterialBalance sand = s->state().balance()[static_cast<std::size_t>(Material::sand)];
    EXPECT_NEAR(sand.cubic_metres(sand.out) / 0.1, 48 * 48, 4 * 48) << polling;
  }
}

DESERT_ON_EACH_BACKEND(SlabInflux);
DESERT_ON_EACH_BACKEND(SlabTurns);

}  // namespace
}  // namespace desert_sim::slabs
