// Sweeps inside a tile: exact in mass and never below nothing whatever the terrain; a pair by hand; what
// stays.

#include <cmath>
#include <numeric>

#include "support/tile_field.hpp"
#include "support/world.hpp"

namespace desert_sim {
namespace {

using test::TileField;

long long total(const std::vector<Quanta>& sand) { return std::accumulate(sand.begin(), sand.end(), 0LL); }

class AvalanchingTile : public test::OnBackend {
 protected:
  /// A row of cells of 1 m with angles of 0.5, in metres.
  static TileField row(const std::vector<double>& ground, const std::vector<double>& sand) {
    TileField f;
    f.grid = {static_cast<int>(ground.size()), 1, 1, false, false};
    for (double v : ground) f.ground.push_back(static_cast<Quanta>(std::llround(v * 1048576)));
    for (double v : sand) f.sand.push_back(static_cast<Quanta>(std::llround(v * 1048576)));
    f.repose.assign(ground.size(), 0.5f);
    return f;
  }
  static constexpr Quanta unit = 32;  ///< quanta; 2⁻¹⁵ of a cell
};

TEST_P(AvalanchingTile, KeepsMassToTheBitAndSandNeverNegative) {
  for (const TileField& field : test::tile_fields())
    for (float transfer : {1.0f, 0.3f})
      for (int sweeps : {1, 8}) {
        TileField f = field;
        for (int pass = 0; pass < 6; ++pass) {
          f.sand = f.relaxed(exec(), 4 * pass, sweeps, false, transfer);
          ASSERT_EQ(total(f.sand), total(field.sand)) << f.name << ", pass " << pass;
          for (Quanta v : f.sand) ASSERT_GE(v, 0) << f.name << ", pass " << pass;
        }
      }
}

TEST_P(AvalanchingTile, MovesSomethingWhereItShould) {
  for (const TileField& f : test::tile_fields()) {
    const bool still = f.name == "no sand" || f.name == "at rest" || f.name == "one cell" ||
                       f.name == "steeper than can matter" || f.name == "nothing but walls";
    EXPECT_EQ(f.relaxed(exec(), 0, 1, false) == f.sand, still) << f.name;
  }
}

TEST_P(AvalanchingTile, IsClosed) {
  for (const TileField& f : test::tile_fields()) {
    if (f.grid.width < 64 || f.grid.width % 32 || f.grid.height % 32) continue;
    const auto after = f.relaxed(exec(), 0, 8, false);
    for (int row = 0; row < f.grid.height / 32; ++row)
      for (int column = 0; column < f.grid.width / 32; ++column) {
        long long change = 0;
        for (int y = 32 * row; y < 32 * row + 32; ++y)
          for (int x = 32 * column; x < 32 * column + 32; ++x) {
            const std::size_t i = static_cast<std::size_t>(f.grid.index(x, y));
            change += after[i] - f.sand[i];
          }
        EXPECT_EQ(change, 0) << f.name << ", tile " << column << ", " << row;
      }
  }
}

// One neighbour: B_max = B_sum, so that half of the excess of 1.5 m moves, less at most 0.3 %; then half of
// what is left.
TEST_P(AvalanchingTile, OfOnePairMovesHalfTheExcessTimesTransfer) {
  const TileField f = row({0, 0}, {3, 1});
  for (float transfer : {1.0f, 0.5f}) {
    double excess = 1.5, moved = 0;
    for (int sweeps = 1; sweeps <= 3; ++sweeps) {
      moved += 0.5 * transfer * excess;
      excess = 1.5 - 2 * moved;
      const auto after = f.relaxed(exec(), 0, sweeps, false, transfer);
      EXPECT_NEAR(after[1] / 1048576.0, 1 + moved, 0.003 * 0.75) << sweeps;
    }
  }
}

/// A tile goes on while one of its cells gives plenty, and only that tile.
TEST_P(AvalanchingTile, GoesOnWhileACellGivesPlenty) {
  TileField f = row(std::vector<double>(64, 0.0), std::vector<double>(64, 0.0));
  f.sand[10] = 4 * 1048576;  // in the first tile
  f.sand[40] = 600000;       // in the second: gives less than 0.1
  const auto one = f.relaxed(exec(), 0, 1, false, 1, 1), most = f.relaxed(exec(), 0, 8, false, 1, 1);
  const auto until = f.relaxed(exec(), 0, 1, false, 1, 1, 0.1f);
  const auto tile = [](const std::vector<Quanta>& sand, int n) {
    return std::vector<Quanta>(sand.begin() + 32 * n, sand.begin() + 32 * n + 32);
  };
  EXPECT_NE(tile(until, 0), tile(one, 0));
  EXPECT_NE(tile(until, 0), tile(most, 0)) << "slides get small before the last sweep";
  EXPECT_EQ(tile(until, 1), tile(one, 1));
  EXPECT_EQ(f.relaxed(exec(), 0, 1, false, 1, 1, 0), most) << "nothing is too little";
}

/// What a coarser grid hands down comes first, as if by itself.
TEST_P(AvalanchingTile, GetsTheCoarserGridsChangeFirst) {
  for (const TileField& f : test::tile_fields_of_families())
    for (int offset : {0, 12}) {
      TileField g = f;
      const avalanching::Prolong prolong{g.coarse(), g.coarse_after.data(), g.coarse_before.data(), g.grid,
                                         g.sand.data()};
      for (int y = 0; y < g.coarse().height; ++y)
        for (int x = 0; x < g.coarse().width; ++x) prolong(x, y);
      EXPECT_NE(g.sand, f.sand);
      g.coarse_before.clear();
      g.coarse_after.clear();
      EXPECT_EQ(f.relaxed(exec(), offset, 4, false), g.relaxed(exec(), offset, 4, false)) << f.name;
    }
}

/// Sand starts to slide where it is steeper than its angle; a slide aims at `rest` of that.
TEST_P(AvalanchingTile, SlidesFromItsAngleToWhereItRests) {
  const auto drop_after = [&](double drop, float rest) {
    const TileField f = row({0, 0}, {1 + drop, 1});
    std::vector<Quanta> sand = f.sand;
    for (int pass = 0; pass < 4; ++pass) {
      TileField g = f;
      g.sand = sand;
      sand = g.relaxed(exec(), 0, 8, false, 1, rest);
    }
    return (sand[0] - sand[1]) / 1048576.0;
  };
  EXPECT_EQ(drop_after(0.49, 0.9f), drop_after(0.49, 1.0f))
      << "less than the angle of repose, 0.5: nothing slides";
  EXPECT_NEAR(drop_after(0.49, 0.9f), 0.49, 1e-5);
  EXPECT_NEAR(drop_after(0.52, 1.0f), 0.5, 4e-4);
  EXPECT_NEAR(drop_after(0.52, 0.9f), 0.45, 0.003 * 0.07)
      << "half of what is over 0.45 goes from one to the other";
}

/// Sand that is handed on: more than half of the excess, up to all of it; at worst the two end level.
TEST_P(AvalanchingTile, HandsOnMoreBySharesOfTheDropAtRest) {
  const auto moved = [&](double excess, float onward) {
    const TileField f = row({0, 0}, {1.5 + excess, 1});  // a drop of 0.5 at rest
    return f.relaxed(exec(), 0, 1, false, 1, 1, 100, onward)[1] / 1048576.0 - 1;
  };
  EXPECT_NEAR(moved(0.4, 0), 0.2, 0.001);
  EXPECT_NEAR(moved(0.4, 0.25f), 0.2 + 0.125, 0.001);
  EXPECT_NEAR(moved(0.4, 0.5f), 0.4, 0.0015) << "all of the excess, no more";
  EXPECT_NEAR(moved(0.4, 1), 0.4, 0.0015);
  EXPECT_NEAR(moved(1.5, 0.5f), 1, 0.0035) << "they are level";
}

TEST_P(AvalanchingTile, LeavesClosedTilesAsTheyAre) {
  TileField f = row(std::vector<double>(96, 0.0), std::vector<double>(96, 0.0));
  for (std::size_t x : {10, 40, 80}) f.sand[x] = 4 << 20;
  const auto all = f.relaxed(exec(), 0, 4, false);
  f.open = {1, 0, 7};
  const auto some = f.relaxed(exec(), 0, 4, false);
  for (std::size_t x = 0; x < 96; ++x) EXPECT_EQ(some[x], x / 32 == 1 ? f.sand[x] : all[x]) << x;
}

/// What eight neighbours get is as equations 9–11 have it.
TEST_P(AvalanchingTile, OfOneTowerIsNillesEquationsNineToEleven) {
  TileField f = row(std::vector<double>(9, 0.0), {0, 0, 0, 0, 2, 0, 0, 0, 0});
  f.grid = {3, 3, 1, false, false};
  const double straight = 1.5, diagonal = 2 - 0.5 * std::sqrt(2.0), sum = 4 * straight + 4 * diagonal;
  const double released = straight / (1 + straight / sum);
  const auto after = f.relaxed(exec(), 0, 1, false);
  for (int k = 0; k < 8; ++k) {
    const double expected = released * (k < 4 ? straight : diagonal) / sum;
    const std::size_t i =
        static_cast<std::size_t>(f.grid.index(1 + Neighbours::dx(k), 1 + Neighbours::dy(k)));
    EXPECT_NEAR(after[i] / 1048576.0, expected, 0.003 * expected) << k;
    EXPECT_EQ(after[i] % unit, 0) << "whole units move";
  }
}

/// A cell gives 2 cell sizes a sweep at most.
TEST_P(AvalanchingTile, OfACliffGivesTwoCellSizesASweep) {
  const auto after = row({0, 0}, {60, 0}).relaxed(exec(), 0, 1, false);
  EXPECT_NEAR(after[1] / 1048576.0, 2, 0.006);
}

TEST_P(AvalanchingTile, LeavesAFilmOfFourUnitsAtMostAndTakesTheRest) {
  for (Quanta depth : {Quanta{0}, Quanta{1}, unit, 4 * unit, 5 * unit, 1000 * unit, 100000 * unit}) {
    TileField f = row({100, 0}, {0, 0});
    f.quanta_per_cell *= 2;  // a unit of 64 quanta, which relief of 100 m does not widen
    f.sand[0] = depth;
    for (int pass = 0; pass < 3; ++pass) f.sand = f.relaxed(exec(), 0, 8, false);
    EXPECT_GE(f.sand[0], 0);
    EXPECT_LE(f.sand[0], 4 * 64 + 63) << depth;
    EXPECT_EQ(f.sand[0] + f.sand[1], depth);
  }
}

/// Tiles with more relief than 64 cell sizes count in coarser units, and still level out.
TEST_P(AvalanchingTile, OfAColumnOfFourHundredMetresSlides) {
  TileField f = row(std::vector<double>(32, 0.0), std::vector<double>(32, 0.0));
  f.sand[16] = 400 << 20;
  for (int pass = 0; pass < 400; ++pass) f.sand = f.relaxed(exec(), 0, 8, false);
  for (std::size_t x = 0; x + 1 < f.sand.size(); ++x)
    EXPECT_LT(std::abs(f.sand[x + 1] - f.sand[x]) / 1048576.0, 0.502) << x;
  EXPECT_EQ(total(f.sand), 400LL << 20);
}

DESERT_ON_EACH_BACKEND(AvalanchingTile);

TEST(Tiles, KnowInWhichOfThemACellLies) {
  for (const Grid& g :
       {Grid{77, 45, 1, true, false}, Grid{64, 96, 1, false, true}, Grid{5, 33, 1, true, true}})
    for (int offset : avalanching::seam_offsets) {
      avalanching::LevelView level{};
      level.grid = g;
      const avalanching::RelaxTile law{{g, offset}, level, {}, 1, 1, 1, 1};
      const Tiles& tiles = law.tiles;
      std::vector<int> columns(static_cast<std::size_t>(g.width), -1),
          rows(static_cast<std::size_t>(g.height), -1);
      for (int tile = 0; tile < tiles.columns(); ++tile)
        for (int n = 0; n < Tiles::side; ++n)
          if (law.grid_x(tile, n) >= 0) columns[static_cast<std::size_t>(law.grid_x(tile, n))] = tile;
      for (int tile = 0; tile < tiles.rows(); ++tile)
        for (int n = 0; n < Tiles::side; ++n)
          if (law.grid_y(tile, n) >= 0) rows[static_cast<std::size_t>(law.grid_y(tile, n))] = tile;
      for (int x = 0; x < g.width; ++x) EXPECT_EQ(tiles.column_of(x), columns[static_cast<std::size_t>(x)]);
      for (int y = 0; y < g.height; ++y) EXPECT_EQ(tiles.row_of(y), rows[static_cast<std::size_t>(y)]);
      EXPECT_EQ(tiles.column_of(-3), g.periodic_x ? tiles.column_of(wrap(-3, g.width)) : tiles.column_of(0));
    }
}

TEST(AvalanchingUnits, ReciprocalIsBelowByLittle) {
  for (float x : {1e-30f, 1e-10f, 0.37f, 1.0f, 1.9f, 72.0f})
    for (int n = 0; n < 10000; ++n) {
      const float v = x * (1.0f + 1e-4f * static_cast<float>(n));
      const double product = static_cast<double>(avalanching::reciprocal_below(v)) * v;
      ASSERT_LE(product, 1.0000002) << v;
      ASSERT_GE(product, 0.997) << v;
    }
}

TEST(AvalanchingUnits, CountHeightsWithoutLoss) {
  using avalanching::Units;
  for (int relief_bits : {0, 10, 20, 25, 29})
    for (float quanta_per_cell : {1000.0f, 1048576.0f, 4194304.0f}) {
      const Quanta lowest = -(Quanta{1} << 28), highest = lowest + (Quanta{1} << relief_bits);
      const Units units(lowest, highest, quanta_per_cell);
      EXPECT_GE(units.height(lowest), Units::floor);
      EXPECT_LE(units.height(highest), Units::floor + 0.5f);
      const Quanta gain = units.gain(units.height(lowest), units.height(highest));
      EXPECT_EQ(gain, (highest - lowest) >> units.shift << units.shift);
      EXPECT_EQ(units.depth_over_film(0), -4 * Units::unit);
    }
}

}  // namespace
}  // namespace desert_sim
