// Sweeps inside a tile: exact in mass and never below nothing whatever the terrain; a pair by hand; what
// stays.

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <set>

#include "test/support/tile_field.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

using avalanching::Patch;
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
    for (const auto& [share, by_gradient] :
         {std::pair{0.5f, false}, {1.0f, false}, {0.5f, true}, {0.75f, true}})
      for (int sweeps : {1, 8}) {
        TileField f = field;
        f.by_gradient = by_gradient;
        for (int pass = 0; pass < 6; ++pass) {
          f.sand = f.relaxed(exec(), 4 * pass, sweeps, false, share);
          ASSERT_EQ(total(f.sand), total(field.sand)) << f.name << ", pass " << pass;
          for (Quanta v : f.sand) ASSERT_GE(v, 0) << f.name << ", pass " << pass;
        }
      }
}

TEST_P(AvalanchingTile, MovesSomethingWhereItShould) {
  for (TileField f : test::tile_fields()) {
    const bool still = f.name == "no sand" || f.name == "at rest" || f.name == "one cell" ||
                       f.name == "steeper than can matter" || f.name == "nothing but walls";
    for (const bool by_gradient : {false, true}) {
      f.by_gradient = by_gradient;
      EXPECT_EQ(f.relaxed(exec(), 0, 1, false) == f.sand, still) << f.name << (by_gradient ? ", quads" : "");
    }
  }
}

/// A quad by hand: of a drop of 1 along one diagonal and none along the other g is √½, no more than what lies
/// at repose stays, and no sand leaves the range of the four.
TEST_P(AvalanchingTile, OfOneQuadSlidesByItsGradient) {
  for (const double top : {0.5, 1.0, 3.0}) {
    TileField f;
    f.grid = {2, 2, 1, false, false};
    f.by_gradient = true;
    f.ground.assign(4, 0);
    const double heights[] = {top, top / 2, top / 2, 0};  // a plane
    for (double h : heights) f.sand.push_back(static_cast<Quanta>(std::llround(h * 1048576)));
    f.repose.assign(4, 0.5f);
    const double slope = top / std::sqrt(2.0), moved = 0.5 * top * std::max(0.0, 1 - 0.5 / slope);
    const std::vector<Quanta> after = f.relaxed(exec(), 0, 1, false, 0.5f);
    EXPECT_NEAR(after[0] / 1048576.0, top - moved, 4e-4) << top;  // 1/g is right within 7e-4
    EXPECT_NEAR(after[3] / 1048576.0, moved, 4e-4) << top;
    EXPECT_EQ(after[1], f.sand[1]);
    EXPECT_EQ(after[2], f.sand[2]);
  }
}

/// A plane a little over repose on which every other cell is higher, as on a chessboard: the diagonals of
/// quads do not see that. Sweeps level nine tenths of it; in proportion to what slides of the plane it
/// would be less than half.
TEST_P(AvalanchingTile, OfQuadsLevelsWhatAlternatesFromCellToCell) {
  constexpr int side = Tiles::side;
  TileField f;
  f.grid = {side, side, 1, false, false};
  f.by_gradient = true;
  f.ground.assign(side * side, 0);
  f.repose.assign(side * side, 0.6f);
  const auto of_board = [&](auto&& height_at) {
    double sum = 0;
    for (int y = 8; y < side - 8; ++y)
      for (int x = 8; x < side - 8; ++x)
        sum += ((x + y) % 2 ? 1 : -1) * static_cast<double>(height_at(f.grid.index(x, y)));
    return sum;
  };
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      f.sand.push_back(static_cast<Quanta>((50 - 0.63 * y + ((x + y) % 2 ? 0.03 : -0.03)) * 1048576));
  const auto after = f.relaxed(exec(), 0, 4, false);
  const double left = of_board([&](int i) { return after[static_cast<std::size_t>(i)]; }) /
                      of_board([&](int i) { return f.sand[static_cast<std::size_t>(i)]; });
  EXPECT_NEAR(left, 0, 0.1);
}

/// Two cells at 0.2 and two at 0.8 let a plane slide from 0.5 on.
TEST_P(AvalanchingTile, OfAQuadSlidesByTheMeanOfItsAngles) {
  for (const double tangent : {0.49, 0.51}) {
    TileField f;
    f.grid = {2, 2, 1, false, false};
    f.by_gradient = true;
    f.ground.assign(4, 0);
    for (double h : {2.0, 2 - tangent, 2.0, 2 - tangent})
      f.sand.push_back(static_cast<Quanta>(std::llround(h * 1048576)));
    f.repose = {0.2f, 0.8f, 0.8f, 0.2f};
    EXPECT_EQ(f.relaxed(exec(), 0, 1, false) == f.sand, tangent < 0.5) << tangent;
  }
}

/// One high cell of four: p = t = 0.6 and q = 0, so that g is 0.6, and not its half by √2.
TEST_P(AvalanchingTile, OfASpikeSlidesAllThatExceedsRepose) {
  TileField f;
  f.grid = {2, 2, 1, false, false};
  f.by_gradient = true;
  f.ground.assign(4, 0);
  for (double h : {1.6, 1.0, 1.0, 1.0}) f.sand.push_back(static_cast<Quanta>(std::llround(h * 1048576)));
  f.repose.assign(4, 0.5f);
  const double share = 0.5 * (1 - 0.5 / 0.6);
  const std::vector<Quanta> after = f.relaxed(exec(), 0, 1, false, 0.5f);
  EXPECT_NEAR(after[0] / 1048576.0, 1.6 - 0.6 * share * 4 / 3, 4e-4);
  EXPECT_NEAR(after[3] / 1048576.0, 1.0 + 0.6 * share * 2 / 3, 4e-4);
  EXPECT_NEAR(after[1] / 1048576.0, 1.0 + 0.6 * share / 3, 4e-4);
}

/// A step of bare rock between two cells that lie flat: what cannot slide does not make them slide.
TEST_P(AvalanchingTile, BesideAStepOfRockKeepsItsSlope) {
  TileField f;
  f.grid = {2, 2, 1, false, false};
  f.by_gradient = true;
  for (double h : {9.0, 0.0, 0.0, 0.0}) f.ground.push_back(static_cast<Quanta>(std::llround(h * 1048576)));
  for (double h : {0.0, 1.3, 1.0, 1.0}) f.sand.push_back(static_cast<Quanta>(std::llround(h * 1048576)));
  f.repose.assign(4, 0.5f);
  EXPECT_EQ(f.relaxed(exec(), 0, 8, false), f.sand);
}

/// Thin sand on random rock: no cell rises above the highest of its quad, or falls below the lowest one.
TEST_P(AvalanchingTile, OfAQuadBesideRockStaysInItsRange) {
  std::mt19937 dice(7);
  std::uniform_real_distribution<double> rock(0, 4), film(0, 1);
  int moved = 0;
  for (int n = 0; n < 2000; ++n) {
    TileField f;
    f.grid = {2, 2, 1, false, false};
    f.by_gradient = true;
    std::vector<Quanta> before;
    for (int k = 0; k < 4; ++k) {
      f.ground.push_back(static_cast<Quanta>(rock(dice) * 1048576));
      f.sand.push_back(static_cast<Quanta>(film(dice) * film(dice) * 1048576));
      before.push_back(f.ground.back() + f.sand.back());
    }
    f.repose.assign(4, 0.3f);
    const std::vector<Quanta> after = f.relaxed(exec(), 0, 1, false, 0.75f);
    moved += after != f.sand ? 1 : 0;
    for (int k = 0; k < 4; ++k) {
      EXPECT_LE(f.ground[k] + after[k], *std::max_element(before.begin(), before.end()) + unit) << n;
      EXPECT_GE(f.ground[k] + after[k], *std::min_element(before.begin(), before.end()) - unit) << n;
    }
  }
  EXPECT_GT(moved, 1000);
}

/// A row of cells between walls: a pair by the drop from one to the other, as without quads.
TEST_P(AvalanchingTile, AlongAWallSlidesByStraightPairs) {
  for (const bool along_x : {true, false}) {
    TileField f;
    f.grid = along_x ? Grid{4, 1, 1, false, false} : Grid{1, 4, 1, false, false};
    f.by_gradient = true;
    f.ground.assign(4, 0);
    for (double h : {3.0, 1.0, 1.0, 1.0}) f.sand.push_back(static_cast<Quanta>(std::llround(h * 1048576)));
    f.repose.assign(4, 0.5f);
    const std::vector<Quanta> after = f.relaxed(exec(), 0, 8, false, 0.5f);
    EXPECT_LT(after[0] / 1048576.0, 2.6) << along_x;
    EXPECT_GT(after[1] / 1048576.0, 1.2) << along_x;
  }
}

/// Sand that nothing holds runs down as fast along x as along y: in one order of quads, twice as fast.
TEST_P(AvalanchingTile, OfLooseSandRunsAsFastAlongEitherAxis) {
  double moved[2];
  for (const int axis : {0, 1}) {
    TileField f;
    f.grid = {32, 32, 1, false, false};
    f.by_gradient = true;
    f.ground.assign(1024, 0);
    f.repose.assign(1024, 0.0f);
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 32; ++x)
        f.sand.push_back(static_cast<Quanta>((1 + 0.2 * (axis == 0 ? x : y)) * 1048576));
    const std::vector<Quanta> after = f.relaxed(exec(), 0, 8, false, 0.7f);
    moved[axis] = 0;
    for (int i = 0; i < 1024; ++i)
      moved[axis] += (axis == 0 ? i % 32 : i / 32) * static_cast<double>(f.sand[i] - after[i]) / 1048576;
  }
  EXPECT_GT(moved[0], 100);
  EXPECT_NEAR(moved[1] / moved[0], 1, 0.1);
}

/// A plane just under repose keeps to the bit and one just over it slides, whichever way it faces: to the
/// neighbours alone, a slope of 22.5 degrees of aspect is 8 % less steep than it is.
TEST_P(AvalanchingTile, OfAPlaneSlidesFromTheSameAngleForEveryAspect) {
  for (const double aspect : {0.0, 10.0, 22.5, 45.0, 80.0})
    for (const double over : {-0.01, 0.01}) {
      TileField f;
      f.grid = {32, 32, 1, false, false};
      f.by_gradient = true;
      f.ground.assign(1024, 0);
      f.repose.assign(1024, 0.6f);
      const double angle = aspect * 3.14159265358979 / 180, tangent = 0.6 + over;
      for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x)
          f.sand.push_back(static_cast<Quanta>(
              std::llround((1 + tangent * (x * std::cos(angle) + y * std::sin(angle))) * 1048576)));
      EXPECT_EQ(f.relaxed(exec(), 0, 1, false) == f.sand, over < 0) << aspect << ", " << over;
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

// As equations 9–11 have it for one receiver: half of the excess of 1.5 m, and the two are at repose; less,
// or more, by the share. The pair lies inside the patches of sweeps 0 and 2.
TEST_P(AvalanchingTile, OfOnePairMovesItsShareOfTheExcess) {
  const TileField f = row({0, 0}, {3, 1});
  for (float share : {0.5f, 0.25f, 0.65f}) {
    double excess = 1.5, moved = 0;
    for (int sweeps : {1, 3}) {
      moved += excess > 0 ? share * excess : 0;
      excess = 1.5 - 2 * moved;
      const auto after = f.relaxed(exec(), 0, sweeps, false, share);
      EXPECT_NEAR(after[1] / 1048576.0, 1 + moved, 1e-4) << sweeps << " sweeps, share " << share;
    }
  }
}

/// Next to the tile's edges another share, of a pair and of its mirror image, along both axes; not further
/// in.
TEST_P(AvalanchingTile, OfPairsNextToItsEdgesMovesTheShareThere) {
  constexpr int last = Tiles::side - 1;
  for (bool upright : {false, true})
    for (int from : {0, 1, 15, last - 2, last - 1}) {
      TileField f = row(std::vector<double>(Tiles::side, 100.0), std::vector<double>(Tiles::side, 0.0));
      if (upright) f.grid = {1, Tiles::side, 1, false, false};
      const auto donor = static_cast<std::size_t>(from);
      f.ground[donor] = f.ground[donor + 1] = 0;
      f.sand[donor] = 2 << 20;                                             // an excess of 1.5 m
      const auto after = f.relaxed(exec(), 0, 2, false, 0.5f, 100, 0.4f);  // two sweeps have every pair
      const bool at_edge = from == 0 || from == last - 1;
      const double once = (at_edge ? 0.2 : 0.5) * 1.5, twice = once + 0.2 * (1.5 - 2 * once);
      const double moved = after[donor + 1] / 1048576.0;
      EXPECT_TRUE(std::abs(moved - once) < 1e-4 || (at_edge && std::abs(moved - twice) < 1e-4))
          << "from cell " << from << (upright ? ", upright: " : ": ") << moved;
    }
}

/// Likewise between cells above each other, and, over their distance, on both diagonals.
TEST_P(AvalanchingTile, OfAPairSlidesInAllEightDirections) {
  const double straight = 0.5 * 1.5, diagonal = 0.5 * (2 - 0.5 * std::sqrt(2.0));
  for (int k = 0; k < Neighbours::count; ++k) {
    TileField f = row(std::vector<double>(9, 100.0), std::vector<double>(9, 0.0));
    f.grid = {3, 3, 1, false, false};
    const int there = f.grid.index(1 + Neighbours::dx(k), 1 + Neighbours::dy(k));
    for (int i : {4, there}) f.ground[static_cast<std::size_t>(i)] = 0;
    f.sand[4] = 2 << 20;
    const auto after = f.relaxed(exec(), 0, 1, false);
    EXPECT_NEAR(after[static_cast<std::size_t>(there)] / 1048576.0, k < 4 ? straight : diagonal, 1e-4) << k;
    EXPECT_EQ(after[static_cast<std::size_t>(there)] % unit, 0) << "whole units move";
  }
}

/// Of two receivers, one straight and one diagonal, which do not touch, the diagonal one is served first, and
/// what the other gets comes from what is left: why is in avalanching_patch.hpp.
TEST_P(AvalanchingTile, ServesDiagonalReceiversFirst) {
  const double root = std::sqrt(2.0), diagonal = 0.5 * (2 - 0.5 * root),
               straight = 0.5 * (2 - diagonal - 0.5);
  for (int dy : {-1, 1})
    for (int dx : {-1, 1})
      for (bool sideways : {true, false}) {
        TileField f = row(std::vector<double>(9, 100.0), std::vector<double>(9, 0.0));
        f.grid = {3, 3, 1, false, false};
        const auto at = [&](int x, int y) { return static_cast<std::size_t>(f.grid.index(1 + x, 1 + y)); };
        const std::size_t near = sideways ? at(-dx, 0) : at(0, -dy), far = at(dx, dy);
        for (std::size_t i : {at(0, 0), near, far}) f.ground[i] = 0;
        f.sand[at(0, 0)] = 2 << 20;
        const auto after = f.relaxed(exec(), 0, 1, false);
        EXPECT_NEAR(after[far] / 1048576.0, diagonal, 1e-4) << dx << ", " << dy;
        EXPECT_NEAR(after[near] / 1048576.0, straight, 1e-4) << dx << ", " << dy;
      }
}

/// Sweeps pass over every pair of a tile but those that lie across patches: rock with two holes a tile, at
/// another place in each, one with sand. A tile in which two sweeps move nothing takes no more of them, so
/// that these pairs wait for the next pass, which begins with the other two.
TEST_P(AvalanchingTile, PassesOverEveryPairInTwoPasses) {
  constexpr int side = Tiles::side, cells = side * side + side;
  const auto inside = [](int begin, int step, int shift) {
    const int end = begin + step, first = (begin < end ? begin : end) - shift + side;
    return step == 0 || first % Patch::side != Patch::side - 1;
  };
  for (int k : {0, 2, 4, 6}) {
    std::vector<int> passes(side * side, 0);
    for (int offset : {0, 16}) {
      TileField f = row(std::vector<double>(cells * cells, 100.0), std::vector<double>(cells * cells, 0.0));
      f.grid = {cells, cells, 1, false, false};
      const auto in_its_tile = [&](int x, int y, int n, int m) {
        return static_cast<std::size_t>(f.grid.index(offset + side * x + n, offset + side * y + m));
      };
      const auto for_each_pair = [&](auto&& body) {
        for (int y = 0; y < side; ++y)
          for (int x = 0; x < side; ++x) {
            const int to_x = x + Neighbours::dx(k), to_y = y + Neighbours::dy(k);
            if (to_x >= 0 && to_x < side && to_y < side)
              body(x, y, in_its_tile(x, y, x, y), in_its_tile(x, y, to_x, to_y));
          }
      };
      for_each_pair([&](int, int, std::size_t from, std::size_t to) {
        f.ground[from] = f.ground[to] = 0;
        f.sand[from] = 2 << 20;
      });
      f.first_shift = avalanching::first_shift(0, offset / 16, false);
      const auto after = f.relaxed(exec(), offset, 4, false);
      for_each_pair([&](int x, int y, std::size_t, std::size_t to) {
        bool expected = false;
        for (int n : {0, 1}) {
          const avalanching::PatchShift shift(f.first_shift + n, false);
          expected =
              expected || (inside(x, Neighbours::dx(k), shift.x) && inside(y, Neighbours::dy(k), shift.y));
        }
        EXPECT_EQ(after[to] > 1 << 19, expected)
            << "direction " << k << ", offset " << offset << ", cell " << x << ", " << y;
        passes[static_cast<std::size_t>(y * side + x)] += expected ? 1 : 0;
      });
    }
    for (int y = 0; y + 1 < side; ++y)
      for (int x = 1; x + 1 < side; ++x)
        EXPECT_GT(passes[static_cast<std::size_t>(y * side + x)], 0) << k << ": " << x << ", " << y;
  }
}

/// The same of quads: holes of two by two cells. The passes of a step begin two sweeps apart, too, though
/// each step's begin elsewhere.
TEST_P(AvalanchingTile, PassesOverEveryQuadInTwoPasses) {
  constexpr int side = Tiles::side, cells = 2 * side, some = 2 * Patch::side;  // patches repeat
  const auto inside = [](int first, int shift) {
    return (first - shift + side) % Patch::side != Patch::side - 1;
  };
  for (std::uint64_t step = 0; step < avalanching::seam_period; ++step) {
    std::vector<int> passes(some * some, 0);
    for (int pass : {0, 1}) {
      const int offset = avalanching::seam_offset(step, pass);
      TileField f = row(std::vector<double>(cells * cells, 100.0), std::vector<double>(cells * cells, 0.0));
      f.grid = {cells, cells, 1, false, false};
      f.by_gradient = true;
      f.first_shift = avalanching::first_shift(step, pass, true);
      const int tile = (side - offset) % side;  // of the first whole tile, its south-west corner
      const auto hole_at = [&](int x, int y, int cell) {
        return static_cast<std::size_t>(f.grid.index(tile + x + cell % 2, tile + y + cell / 2));
      };
      for (int y = 0; y < some; ++y)
        for (int x = 0; x < some; ++x) {
          TileField g = f;
          for (int cell = 0; cell < 4; ++cell) g.ground[hole_at(x, y, cell)] = 0;
          g.sand[hole_at(x, y, 0)] = 2 << 20;
          const bool slid = g.relaxed(exec(), offset, 4, false)[hole_at(x, y, 3)] > 0;
          bool expected = false;
          for (int n : {0, 1}) {
            const avalanching::PatchShift shift(f.first_shift + n, false);
            expected = expected || (inside(x, shift.x) && inside(y, shift.y));
          }
          ASSERT_EQ(slid, expected) << "offset " << offset << ", quad " << x << ", " << y;
          passes[static_cast<std::size_t>(y * some + x)] += expected ? 1 : 0;
        }
    }
    for (int n = 0; n < some * some; ++n)
      ASSERT_GT(passes[static_cast<std::size_t>(n)], 0)
          << "step " << step << ", quad " << n % some << ", " << n / some;
  }
}

/// A tile goes on while one of its pairs moves more than the threshold, and only that tile.
TEST_P(AvalanchingTile, GoesOnWhileAPairMovesPlenty) {
  TileField f = row(std::vector<double>(64, 0.0), std::vector<double>(64, 0.0));
  f.sand[10] = 4 * 1048576;  // in the first tile
  f.sand[40] = 600000;       // in the second: gives less than 0.1
  const auto one = f.relaxed(exec(), 0, 1, false), most = f.relaxed(exec(), 0, 8, false);
  const auto until = f.relaxed(exec(), 0, 1, false, 0.5f, 0.1f);
  const auto tile = [](const std::vector<Quanta>& sand, int n) {
    return std::vector<Quanta>(sand.begin() + 32 * n, sand.begin() + 32 * n + 32);
  };
  EXPECT_NE(tile(until, 0), tile(one, 0));
  EXPECT_NE(tile(until, 0), tile(most, 0)) << "slides get small before the last sweep";
  EXPECT_EQ(tile(until, 1), tile(one, 1));
  EXPECT_EQ(f.relaxed(exec(), 0, 1, false, 0.5f, 0), most) << "nothing is too little";
}

/// What a coarser grid hands down comes first, as if by itself.
TEST_P(AvalanchingTile, GetsTheCoarserGridsChangeFirst) {
  for (const TileField& f : test::tile_fields_with_coarse_changes())
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

/// What is not steeper than its angle stays; what is, comes to rest at it.
TEST_P(AvalanchingTile, SlidesDownToItsAngle) {
  const auto drop_after = [&](double drop) {
    const auto sand = row({0, 0}, {1 + drop, 1}).relaxed(exec(), 0, 8, false);
    return (sand[0] - sand[1]) / 1048576.0;
  };
  EXPECT_NEAR(drop_after(0.49), 0.49, 1e-5);
  EXPECT_NEAR(drop_after(0.52), 0.5, 1e-4);
  EXPECT_NEAR(drop_after(3), 0.5, 1e-4);
}

TEST_P(AvalanchingTile, LeavesClosedTilesAsTheyAre) {
  TileField f = row(std::vector<double>(96, 0.0), std::vector<double>(96, 0.0));
  for (std::size_t x : {10, 40, 80}) f.sand[x] = 4 << 20;
  const auto all = f.relaxed(exec(), 0, 4, false);
  f.active_flags = {1, 0, 7};
  const auto some = f.relaxed(exec(), 0, 4, false);
  for (std::size_t x = 0; x < 96; ++x) EXPECT_EQ(some[x], x / 32 == 1 ? f.sand[x] : all[x]) << x;
}

/// A heap is as wide to all sides, and stands where its tower stood: but for two cells, as pairs follow each
/// other, and the first has most of a tower 200 cells high.
TEST_P(AvalanchingTile, OfOneTowerIsAHeapAroundIt) {
  TileField f = row(std::vector<double>(31 * 31, 0.0), std::vector<double>(31 * 31, 0.0));
  f.grid = {31, 31, 1, false, false};
  f.sand[15 * 31 + 15] = 200 << 20;
  for (int pass = 0; pass < 100; ++pass) f.sand = f.relaxed(exec(), 0, 8, false, 0.65f);
  double x = 0, y = 0, xx = 0, yy = 0;
  for (int i = 0; i < f.grid.cells(); ++i) {
    const double share = f.sand[static_cast<std::size_t>(i)] / (200.0 * 1048576);
    x += share * (i % 31 - 15), y += share * (i / 31 - 15);
    xx += share * (i % 31 - 15) * (i % 31 - 15), yy += share * (i / 31 - 15) * (i / 31 - 15);
  }
  EXPECT_NEAR(x, 0, 2);
  EXPECT_NEAR(y, 0, 2);
  EXPECT_NEAR(std::sqrt((xx - x * x) / (yy - y * y)), 1, 0.1);
}

/// All of the sand goes, but for what is below a unit.
TEST_P(AvalanchingTile, TakesAllThatIsThere) {
  for (Quanta depth : {Quanta{0}, Quanta{1}, unit, 4 * unit, 5 * unit, 1000 * unit, 100000 * unit}) {
    TileField f = row({100, 0}, {0, 0});
    f.quanta_per_cell *= 2;  // a unit of 64 quanta, which relief of 100 m does not widen
    f.sand[0] = depth;
    for (int pass = 0; pass < 3; ++pass) f.sand = f.relaxed(exec(), 0, 8, false);
    EXPECT_EQ(f.sand[0], depth % 64);
    EXPECT_EQ(f.sand[0] + f.sand[1], depth);
  }
}

/// Tiles with more relief than 128 cell sizes count in coarser units, and still level out.
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
      const avalanching::RelaxTile law{{g, offset}, level, {}, {1, 1}, 1, 1};
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
      EXPECT_EQ(std::set<int>(columns.begin(), columns.end()).size(),
                static_cast<std::size_t>(tiles.columns()))
          << "a tile without cells, offset " << offset;
      EXPECT_EQ(std::set<int>(rows.begin(), rows.end()).size(), static_cast<std::size_t>(tiles.rows()));
      EXPECT_EQ(tiles.column_of(-3), g.periodic_x ? tiles.column_of(wrap(-3, g.width)) : tiles.column_of(0));
    }
}

/// What one of a pair loses and the other gets, each rounded once, is the same; with shares as they are given
/// it is not, where a product lies halfway.
TEST(AvalanchingPatch, RoundsWhatSlidesAlikeOnBothSides) {
  using avalanching::with_odd_mantissa;
  EXPECT_EQ(with_odd_mantissa(0.0f), 0.0f);
  EXPECT_LT(with_odd_mantissa(1.0f), 1.0f);
  std::mt19937 random(1);
  int halfway = 0;
  for (float given : {0.25f, 0.315f, 0.5f, 0.6f, 0.625f, 0.7f, 0.75f, 1.0f}) {
    const float share = with_odd_mantissa(given);
    EXPECT_NEAR(share, given, 1e-7);
    for (int n = 0; n < 100000; ++n) {
      // Whole units in [1, 2), and an excess that need not be one but is no more than their difference.
      const auto unit = [&] { return float_from_bits(bits_of(1.0f) + (random() & 0x7fffff)); };
      const float one = unit(), other = unit(), a = fast_max(one, other), b = fast_min(one, other);
      const float repose = (n % 2 ? 1.0f : 0.37f) * (a - b) * static_cast<float>(random() % 1000) / 1000.0f;
      const float excess = (a - b) - (n % 3 ? repose : 0.0f);
      ASSERT_EQ(a - fused(-share, excess, a), fused(share, excess, b) - b)
          << a << ", " << b << ", excess " << excess << ", share " << given;
      halfway += a - fused(-given, excess, a) != fused(given, excess, b) - b;
    }
  }
  EXPECT_GT(halfway, 1000);
}

TEST(AvalanchingUnits, CountHeightsWithoutLoss) {
  using avalanching::Units;
  for (int relief_bits : {0, 10, 20, 25, 29})
    for (float quanta_per_cell : {1000.0f, 1048576.0f, 4194304.0f}) {
      const Quanta lowest = -(Quanta{1} << 28), highest = lowest + (Quanta{1} << relief_bits);
      const Units units(lowest, highest, quanta_per_cell);
      EXPECT_GE(units.height(lowest), Units::floor);
      EXPECT_LT(units.height(highest), 2 * Units::floor);
      const Quanta rise = units.of_height(units.height(highest)) - units.of_height(units.height(lowest));
      EXPECT_EQ(rise, (highest - lowest) >> units.shift << units.shift);
      EXPECT_EQ(units.ground(highest, 0), units.height(highest));
      EXPECT_EQ(units.ground(highest, highest - lowest), Units::floor);
      EXPECT_EQ(units.ground(lowest, Quanta{3} << units.shift), Units::floor - 3 * Units::unit);
      EXPECT_EQ(units.ground(lowest, Quanta{1} << 29), Units::floor / 2) << "deeper than any cell can fall";
    }
}

}  // namespace
}  // namespace desert_sim
