// Rounding and counting: quanta, bilinear shares, fixed point, exponentials, height scales, indices, random
// numbers.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "kernels/base/grid.hpp"
#include "kernels/base/math.hpp"
#include "kernels/base/quanta.hpp"
#include "kernels/field/random.hpp"
#include "kernels/sand/carried.hpp"
#include "src/core/error.hpp"
#include "src/terrain/terrain.hpp"

namespace desert_sim {
namespace {

constexpr float per_metre = 1048576.0f;

TEST(ExpNegative, IsAccurateToThreeTenMillionths) {
  double worst = 0;
  for (double x = 0; x < 87; x += 0.00137) {
    const float f = static_cast<float>(x);
    const double exact = std::exp(-static_cast<double>(f));
    worst = std::max(worst, std::abs(exp_negative(f) - exact) / exact);
  }
  EXPECT_LT(worst, 3e-7);
}

TEST(ExpNegative, IsExactAtItsEnds) {
  EXPECT_EQ(exp_negative(0.0f), 1.0f);
  EXPECT_EQ(exp_negative(87.0f), 0.0f);
  EXPECT_EQ(exp_negative(1e30f), 0.0f);
  EXPECT_EQ(exp_negative(std::numeric_limits<float>::infinity()), 0.0f);
}

TEST(ExpNegative, NeverGrows) {
  for (float x = 0; x < 20; x += 0.001f) EXPECT_LE(exp_negative(x + 0.001f), exp_negative(x) * (1 + 2e-7f));
}

TEST(WrapOnce, IsWrapWhereItIsAllowed) {
  for (int n : {1, 2, 7, 512})
    for (int i = -n; i < 2 * n; ++i) EXPECT_EQ(wrap_once(i, n), wrap(i, n)) << i << " of " << n;
}

TEST(Take, RoundsToNearestAndStopsAtWhatIsThere) {
  EXPECT_EQ(to_quanta_at_most(1.0f, per_metre, 2000000), 1048576);
  EXPECT_EQ(to_quanta_at_most(1.4f / per_metre, per_metre, 100), 1);
  EXPECT_EQ(to_quanta_at_most(1.6f / per_metre, per_metre, 100), 2);
  EXPECT_EQ(to_quanta_at_most(2.0f, per_metre, 7), 7);
  EXPECT_EQ(to_quanta_at_most(1e30f, per_metre, 7), 7);
}

TEST(Take, TakesNothingOfNothingOrNaN) {
  EXPECT_EQ(to_quanta_at_most(0.0f, per_metre, 100), 0);
  EXPECT_EQ(to_quanta_at_most(-1.0f, per_metre, 100), 0);
  EXPECT_EQ(to_quanta_at_most(1.0f, per_metre, 0), 0);
  EXPECT_EQ(to_quanta_at_most(std::nanf(""), per_metre, 100), 0);
}

TEST(Take, NeverTakesMoreThanThereIsWhereFloatsAreCoarse) {
  for (Quanta available : {(1 << 24) + 1, (1 << 25) + 3, wall_height - 1, std::numeric_limits<Quanta>::max()})
    for (float share : {0.5f, 0.9999999f, 1.0f, 1.0000001f, 2.0f}) {
      const Quanta taken = to_quanta_at_most(available * (share / per_metre), per_metre, available);
      EXPECT_LE(taken, available);
      EXPECT_GE(taken, 0);
    }
}

TEST(Subcells, RoundSymmetrically) {
  for (float cells : {0.0f, 0.1f, 0.5f, 1.0f, 7.30001f, 1.0f / 65536, 0.5f / 65536, 1.5f / 65536})
    EXPECT_EQ(to_fixed_point(-cells), -to_fixed_point(cells)) << cells;
  EXPECT_EQ(to_fixed_point(1.0f), fixed_point_one);
  EXPECT_EQ(to_fixed_point(0.25f), 16384);
}

TEST(BilinearShare, FourSharesNeverExceedTheAmountAndLeaveAtMostThree) {
  for (Quanta amount : {0, 1, 2, 3, 7, 1000003, wall_height, std::numeric_limits<Quanta>::max()})
    for (int fx : {0, 1, 13, 32768, 65535})
      for (int fy : {0, 1, 40000, 65535}) {
        const int gx = fixed_point_one - fx, gy = fixed_point_one - fy;
        const long long sum = 0LL + bilinear_share(amount, gx, gy) + bilinear_share(amount, fx, gy) +
                              bilinear_share(amount, gx, fy) + bilinear_share(amount, fx, fy);
        EXPECT_LE(sum, amount);
        EXPECT_GE(sum, amount - 3LL);
      }
}

TEST(BilinearShare, IsTheAmountTimesItsWeights) {
  EXPECT_EQ(bilinear_share(1 << 20, fixed_point_one, fixed_point_one), 1 << 20);
  EXPECT_EQ(bilinear_share(1 << 20, fixed_point_one / 2, fixed_point_one / 4), 1 << 17);
  EXPECT_EQ(bilinear_share(3, fixed_point_one / 2, fixed_point_one), 1);
}

/// What is carried arrives, or stays where it was; what rounding leaves at the nearest of the four, so that a
/// mirrored hop arrives mirrored.
TEST(BilinearParcels, ArrivesWholeAndMirrored) {
  for (Quanta amount : {1, 2, 3, 7, 1000003})
    for (int dx : {0, 1, 13, 16384, 32768, 40000, 65535})
      for (int dy : {0, 20000, 32768, 65535}) {
        BilinearParcels<2> parcels;
        parcels.set(0, 10, 20, dx, dy, amount);
        parcels.set(1, 10, 20, -dx, dy, amount);
        for (int n = 0; n < 2; ++n) {
          const Quanta parts[] = {parcels.south_west[n], parcels.south_east[n], parcels.north_west[n],
                                  parcels.north_east[n]};
          for (Quanta part : parts) EXPECT_GE(part, 0);
          EXPECT_GE(parcels.unshared(n), 0);
          if (dx != 32768 && dy != 32768) {
            EXPECT_EQ(parcels.unshared(n), 0) << dx << ", " << dy;
          }
        }
        const auto at = [&](int n, int x) {  // in a column, south and north
          return parcels.x[n] == x
                     ? std::pair{parcels.south_west[n], parcels.north_west[n]}
                     : (parcels.x[n] + 1 == x ? std::pair{parcels.south_east[n], parcels.north_east[n]}
                                              : std::pair{0, 0});
        };
        for (int away : {0, 1})
          EXPECT_EQ(at(0, 10 + away), at(1, 10 - away)) << amount << ": " << dx << ", " << dy;
        EXPECT_EQ(parcels.unshared(0), parcels.unshared(1));
      }
  BilinearParcels<1> one;
  one.set(0, 0, 0, 20000, 60000, 3);
  EXPECT_EQ(one.north_west[0], 3) << "of three quanta each share is less than one";
}

TEST(HeightScale, CoversWhatItIsAskedFor) {
  for (const auto& [low, high] : {std::pair{0.0, 1.0},
                                  {-500.0, 500.0},
                                  {-513.0, 513.0},
                                  {1700.0, 2900.0},
                                  {-1e6, 1e6},
                                  {8848.0, 8848.0}}) {
    const HeightScale scale = HeightScale::covering(low, high);
    EXPECT_GE(scale.exponent, -20);
    EXPECT_LT((high - scale.datum) / scale.quantum(), load_limit) << low << " to " << high;
    EXPECT_GT((low - scale.datum) / scale.quantum(), -static_cast<double>(load_limit))
        << low << " to " << high;
    if (scale.exponent > -20) {
      const double finer = 0.5 * scale.quantum();
      EXPECT_GE(std::max(high - scale.datum, scale.datum - low), finer * load_limit)
          << "a finer quantum would do";
    }
  }
  EXPECT_EQ(HeightScale::covering(0, 100).exponent, -20);
  EXPECT_EQ(HeightScale::covering(-510, 510).exponent, -20);
  EXPECT_EQ(HeightScale::covering(-600, 600).exponent, -19);
}

TEST(HeightScale, HasADatumOfWholeMetres) {
  const HeightScale scale = HeightScale::covering(1700.3, 1800.9);
  EXPECT_EQ(scale.datum, std::round(scale.datum));
}

TEST(Terrain, GivesBackWhatItWasGivenToHalfAQuantum) {
  CpuExec exec(1);
  Terrain terrain(exec, Grid{2, 2, 1, true, true}, HeightScale::covering(1700, 1800));
  const std::vector<double> values{1700.1234567, 1750.0000004, 1799.9999, 1700};
  terrain.set_values(Layer::bedrock, values);
  for (std::size_t i = 0; i < 4; ++i) {
    const double stored = terrain.scale().datum + static_cast<Quanta>(terrain.raw_words(Layer::bedrock)[i]) *
                                                      terrain.scale().quantum();
    EXPECT_NEAR(stored, values[i], 0.5001 * terrain.scale().quantum());
  }
  EXPECT_EQ(terrain.values(Layer::soil), std::vector<float>(4, 0.0f)) << "a layer that is not in use is 0";
}

TEST(Layers, HaveNamesThatAreFoundAndNoOthers) {
  for (const LayerInfo& row : layer_table) {
    EXPECT_EQ(layer_by_name(row.name), row.layer);
    EXPECT_EQ(&info(row.layer), &row);
  }
  try {
    layer_by_name("sandd");
    FAIL();
  } catch (const ConfigError& e) {
    EXPECT_NE(std::string(e.what()).find("'sandd'"), std::string::npos);
    EXPECT_NE(std::string(e.what()).find("airborne_sand"), std::string::npos);
  }
}

TEST(GridIndices, WrapOrEnd) {
  for (int i = -200; i < 200; ++i)
    for (int n : {1, 2, 7, 64}) EXPECT_EQ(wrap(i, n), ((i % n) + n) % n);
  const Grid torus{5, 3, 1, true, true}, sheet{5, 3, 1, false, false}, band{5, 3, 1, true, false};
  EXPECT_EQ(neighbour_index(torus, -1, 3), torus.index(4, 0));
  EXPECT_EQ(neighbour_index(sheet, -1, 1), -1);
  EXPECT_EQ(neighbour_index(sheet, 4, 2), sheet.index(4, 2));
  EXPECT_EQ(neighbour_index(band, 5, 1), band.index(0, 1));
  EXPECT_EQ(neighbour_index(band, 5, 3), -1);
  EXPECT_EQ(sample_index(sheet, -9, 7), sheet.index(0, 2));
  EXPECT_EQ(sample_index(torus, -9, 7), torus.index(1, 1));
}

TEST(GridIndices, NeighboursAreEightAndOpposite) {
  std::set<std::pair<int, int>> seen;
  for (int k = 0; k < 8; ++k) {
    seen.insert({Neighbours::dx(k), Neighbours::dy(k)});
    EXPECT_EQ(Neighbours::dx(k), -Neighbours::dx(k ^ 1));
    EXPECT_EQ(Neighbours::dy(k), -Neighbours::dy(k ^ 1));
    EXPECT_FLOAT_EQ(Neighbours::distance(k),
                    std::hypot(static_cast<float>(Neighbours::dx(k)), static_cast<float>(Neighbours::dy(k))));
  }
  EXPECT_EQ(seen.size(), 8u);
  EXPECT_FALSE(seen.count({0, 0}));
}

TEST(RandomUnit, IsUniformAndDependsOnEveryCounter) {
  double sum = 0, square = 0;
  constexpr int count = 100000;
  for (std::uint32_t n = 0; n < count; ++n) {
    const double r = random_unit(7, Purpose::reptation, n);
    ASSERT_GE(r, 0);
    ASSERT_LT(r, 1);
    sum += r;
    square += r * r;
  }
  EXPECT_NEAR(sum / count, 0.5, 0.004);
  EXPECT_NEAR(square / count, 1.0 / 3, 0.004);
  const float r = random_unit(7, Purpose::reptation, 1, 2, 3);
  EXPECT_NE(r, random_unit(8, Purpose::reptation, 1, 2, 3));
  EXPECT_NE(r, random_unit(7 + (1ULL << 32), Purpose::reptation, 1, 2, 3));
  EXPECT_NE(r, random_unit(7, Purpose::wind_rose, 1, 2, 3));
  EXPECT_NE(r, random_unit(7, Purpose::reptation, 2, 2, 3));
  EXPECT_NE(r, random_unit(7, Purpose::reptation, 1, 3, 3));
  EXPECT_NE(r, random_unit(7, Purpose::reptation, 1, 2, 4));
}

TEST(ValueNoise, IsFiniteWhereIntegersEnd) {
  for (const float far : {2147483520.0f, 2147483648.0f, 1e12f, 1e30f})
    for (const float z : {far, -far}) {
      const float v = value_noise(1, Purpose::turbulence, 0.3f, z, z);
      EXPECT_LE(std::abs(v), 1.0f) << z;
    }
}

TEST(ValueNoise, IsSmoothBoundedAndPeriodic) {
  for (float x = -3; x < 9; x += 0.37f)
    for (float y = -2; y < 5; y += 0.41f) {
      const float v = value_noise(1, Purpose::turbulence, x, y, 0.3f, 6, 5);
      EXPECT_LE(std::abs(v), 1.0f);
      EXPECT_NEAR(v, value_noise(1, Purpose::turbulence, x + 6, y - 5, 0.3f, 6, 5), 1e-5);
      EXPECT_NEAR(v, value_noise(1, Purpose::turbulence, x + 1e-3f, y, 0.3f, 6, 5), 0.01);
    }
}

}  // namespace
}  // namespace desert_sim
