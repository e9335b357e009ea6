// Heaps of sand at plants that live: which plant a square's is, and that they are the same in windows, over
// the edges of a periodic terrain, and on both backends.

#include "kernels/micro_relief/plant_feet.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <string>

#include "kernels/backend/buffer.hpp"
#include "kernels/micro_relief/window.hpp"
#include "test/support/world.hpp"

namespace desert_sim::micro_relief {
namespace {

struct Plant {
  float x, y, radius;
};

/// Many small plants and some wide ones on 21 m × 16 m.
std::vector<Plant> random_plants(int count) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> x(0, 21), y(0, 16), share(0, 1);
  std::vector<Plant> plants;
  for (int n = 0; n < count; ++n) {
    const float s = share(random);
    plants.push_back({x(random), y(random), 0.05f + 0.8f * s * s});
  }
  return plants;
}

class FeetOfPlants : public test::OnBackend {
 protected:
  static MicroReliefParameters parameters() {
    MicroReliefParameters p;
    p.ripples = false;
    return p;
  }
  /// Of 1 m, as long as the terrain is wide; 21 × 16 squares.
  static Lattice squares(bool periodic) { return Bumps::squares(parameters(), 21, 16, periodic, periodic); }

  std::vector<FootNumber> feet(const std::vector<Plant>& plants, const Lattice& lattice, int first_row = 0,
                               int rows = 16) {
    const auto column = [&](float Plant::*of) {
      std::vector<float> values;
      for (const Plant& plant : plants) values.push_back(plant.*of);
      Buffer<float> buffer(exec(), values.size());
      buffer.upload(values);
      return buffer;
    };
    const Buffer<float> x = column(&Plant::x), y = column(&Plant::y), radius = column(&Plant::radius);
    Buffer<FootNumber> widest(exec(), static_cast<std::size_t>(lattice.x.count * rows));
    with_backend(exec(), [&](auto& e) {
      find_feet(e, lattice, {x.data(), y.data(), radius.data(), static_cast<int>(plants.size())}, first_row,
                rows, widest.data());
    });
    return widest.download();
  }
};

TEST_P(FeetOfPlants, ASquareHasThatOfItsWidestPlant) {
  const std::vector<Plant> plants = random_plants(400);
  const std::vector<FootNumber> found = feet(plants, squares(true));
  std::map<std::pair<int, int>, Plant> widest;
  for (const Plant& p : plants) {
    Plant& w = widest.try_emplace({static_cast<int>(p.y), static_cast<int>(p.x)}, p).first->second;
    if (p.radius > w.radius) w = p;
  }
  ASSERT_LT(widest.size(), 300u) << "some squares are bare, and some have several plants";
  ASSERT_GT(widest.size(), 200u);
  for (int j = 0; j < 16; ++j)
    for (int i = 0; i < 21; ++i) {
      const FootNumber number = found[static_cast<std::size_t>(j * 21 + i)];
      const auto at = widest.find({j, i});
      ASSERT_EQ(number != 0, at != widest.end()) << i << " " << j;
      if (number == 0) continue;
      const Foot foot(number);
      EXPECT_EQ(foot.radius, at->second.radius);
      EXPECT_NEAR(static_cast<float>(i) + foot.east, at->second.x, 1e-5);
      EXPECT_NEAR(static_cast<float>(j) + foot.north, at->second.y, 1e-5);
    }
}

TEST_P(FeetOfPlants, TheOrderOfPlantsDoesNotMatter) {
  std::vector<Plant> plants = random_plants(2000);
  for (Plant& p : plants) p.radius = std::round(p.radius * 5) / 5 + 0.1f;  // so that many are equally wide
  const std::vector<FootNumber> found = feet(plants, squares(true));
  std::mt19937 random(2);
  for (int n = 0; n < 5; ++n) {
    std::shuffle(plants.begin(), plants.end(), random);
    ASSERT_EQ(feet(plants, squares(true)), found);
  }
}

TEST_P(FeetOfPlants, RowsAreThoseOfTheWholeAlsoOverTheEdge) {
  const std::vector<Plant> plants = random_plants(400);
  const std::vector<FootNumber> whole = feet(plants, squares(true)),
                                band = feet(plants, squares(true), 13, 6);
  for (std::size_t j = 0; j < 6; ++j)
    for (std::size_t i = 0; i < 21; ++i)
      ASSERT_EQ(band[j * 21 + i], whole[(13 + j) % 16 * 21 + i]) << i << " " << j;
  EXPECT_TRUE(std::any_of(band.begin() + 3 * 21, band.end(), [](FootNumber n) { return n != 0; }));
}

TEST_P(FeetOfPlants, WhatIsNoPlantOfTheTerrainDoesNotCount) {
  const float nan = std::nanf(""), inf = INFINITY;
  const std::vector<Plant> strange{{nan, 3, 1}, {3, nan, 1},   {3, 3, nan},  {3, 3, 0},    {3, 3, -1},
                                   {-9, 3, 1},  {3, 1e30f, 1}, {-inf, 3, 1}, {40, 3, 0.1f}};
  for (const bool periodic : {false, true}) {
    const std::vector<FootNumber> found = feet(strange, squares(periodic));
    EXPECT_EQ(std::count(found.begin(), found.end(), 0u), 21 * 16) << periodic;
  }
}

TEST_P(FeetOfPlants, OnAnEdgeTheyAreInTheOutermostSquare) {
  const std::vector<FootNumber> open = feet({{21, 16, 1}}, squares(false)),
                                around = feet({{21, 16, 1}}, squares(true));
  EXPECT_NE(open.back(), 0u);
  EXPECT_GT(Foot(open.back()).east, 0.9999f);
  EXPECT_NE(around.front(), 0u) << "where the next period begins";
  EXPECT_EQ(std::count(open.begin(), open.end(), 0u), 21 * 16 - 1);
  EXPECT_EQ(std::count(around.begin(), around.end(), 0u), 21 * 16 - 1);
}

/// Deep flat sand of 21 × 16 cells on which the layer vegetation is 1 everywhere, and a wind from the west.
struct Sand {
  std::vector<float> ones = std::vector<float>(21 * 16, 1.0f), zeros = std::vector<float>(21 * 16, 0.0f),
                     stones = zeros;
  std::vector<FootNumber> feet;

  Relief relief(bool periodic, bool live = true) const {
    MicroReliefParameters p;
    p.ripples = false;
    const Lattice squares = Bumps::squares(p, 21, 16, periodic, periodic),
                  patches(21, 16, 0.5, periodic, periodic);
    Cells cells{{21, 1, periodic}, {16, 1, periodic}};
    cells.rows = 16;
    cells.sand = cells.mobile = cells.level = cells.growth = cells.turn_x = ones.data();
    cells.turn_y = zeros.data();
    cells.stones = stones.data();
    Relief relief{cells, Ripples(p, {8, 0, 8, 0}, 1, patches), Bumps(p, 1, squares)};
    if (live) relief.bumps.feet = {feet.data(), true, 21, 0, 16};
    return relief;
  }
};

TEST_P(FeetOfPlants, HeapsAreAtThemAndNowhereElse) {
  Sand sand;
  const std::vector<Plant> plants{
      {4.1f, 4.9f, 0.4f}, {9.95f, 9.05f, 3}, {15.5f, 4.5f, 0.2f}, {15.7f, 4.7f, 0.1f}};
  sand.feet = feet(plants, squares(false));
  const Relief relief = sand.relief(false);
  const float height = relief.bumps.height;
  const auto highest = [&](float x, float y) {
    float most = 0;
    for (float dx = -0.4f; dx <= 0.4f; dx += 0.01f)
      most = std::max(most, relief.offset(double{x + dx}, double{y}));
    return most;
  };
  EXPECT_NEAR(highest(4.1f, 4.9f), height, 0.01 * height) << "full at a plant as wide as a heap";
  EXPECT_NEAR(highest(9.95f, 9.05f), height, 0.01 * height) << "and at a much wider one";
  EXPECT_NEAR(highest(15.5f, 4.5f), 0.5 * height, 0.01 * height) << "half at one half as wide";
  EXPECT_NEAR(relief.offset(4.1 - 0.24, 4.9), height, 0.01 * height) << "windward of the plant";
  for (double x = 0.01; x < 21; x += 0.07)
    for (double y = 0.01; y < 16; y += 0.07) {
      double nearest = 99;
      for (const Plant& p : plants) nearest = std::min(nearest, std::hypot(x - double{p.x}, y - double{p.y}));
      if (nearest > 1.6 * 0.4 + 1e-4) {
        ASSERT_EQ(relief.offset(x, y), 0) << x << " " << y;
      }
    }
}

TEST_P(FeetOfPlants, CrowdedPlantsHaveHeapsNoHigherThanOne) {
  Sand sand;
  sand.feet =
      feet({{9.99f, 9.99f, 2}, {10.01f, 9.99f, 2}, {9.99f, 10.01f, 2}, {10.01f, 10.01f, 2}}, squares(false));
  const Relief relief = sand.relief(false);
  float most = 0;
  for (double x = 9; x < 11; x += 0.01) most = std::max(most, relief.offset(x, 10));
  EXPECT_GT(most, 0.95f * relief.bumps.height);
  EXPECT_LT(most, 1.01f * relief.bumps.height);
}

TEST_P(FeetOfPlants, AtObstaclesAllStaysAsItIsWithoutThem) {
  Sand sand;
  std::fill(sand.stones.begin(), sand.stones.begin() + 21 * 8, 0.9f);
  sand.feet = feet({{15.5f, 13.5f, 2}}, squares(false));
  const Relief live = sand.relief(false);
  Relief still = sand.relief(false, false);
  still.cells.growth = sand.zeros.data();
  float most = 0;
  for (double x = 0.01; x < 21; x += 0.07)
    for (double y = 0.01; y < 12; y += 0.07) {
      ASSERT_EQ(live.offset(x, y), still.offset(x, y)) << x << " " << y;
      most = std::max(most, live.offset(x, y));
    }
  EXPECT_GT(most, 0.05f);
  EXPECT_GT(live.offset(15.3, 13.5), 0.05f);
}

TEST_P(FeetOfPlants, WindowsHaveTheBitsOfPointsAlsoOverTheEdges) {
  for (const bool periodic : {false, true}) {
    Sand sand;
    sand.feet = feet(random_plants(400), squares(periodic));
    const Relief here = sand.relief(periodic);
    Relief there = here;
    Buffer<float> ones(exec(), sand.ones.size()), zeros(exec(), sand.ones.size());
    Buffer<FootNumber> numbers(exec(), sand.feet.size());
    ones.upload(sand.ones);
    zeros.upload(sand.zeros);
    numbers.upload(sand.feet);
    Cells& c = there.cells;
    c.sand = c.mobile = c.level = c.growth = c.turn_x = ones.data();
    c.turn_y = c.stones = zeros.data();
    there.bumps.feet.widest = numbers.data();
    for (const Points& points : {Points{3.3, 2.2, 0.04, 130, 90}, Points{-4.9, -3.7, 0.11, 260, 210},
                                 Points{20.2, 15.1, 0.05, 60, 60}, Points{62.2, -31.9, 0.3, 30, 30}}) {
      Buffer<RipplePatch> patches(exec(), SquareTable(there.ripples.lattice, points).size());
      Buffer<Bump> bumps(exec(), SquareTable(there.bumps.lattice, points).size());
      Buffer<float> to(exec(), static_cast<std::size_t>(points.columns * points.rows));
      with_backend(exec(),
                   [&](auto& e) { offsets(e, there, points, patches.data(), bumps.data(), to.data()); });
      const std::vector<float> window = to.download();
      float most = 0;
      for (int j = 0; j < points.rows; ++j)
        for (int i = 0; i < points.columns; ++i) {
          const float expected = here.offset(points.x(i), points.y(j));
          ASSERT_EQ(bits_of(window[static_cast<std::size_t>(j * points.columns + i)]), bits_of(expected))
              << periodic << " " << i << " " << j;
          if (periodic) {
            ASSERT_EQ(bits_of(here.offset(points.x(i) + 21, points.y(j) - 16)), bits_of(expected));
          }
          most = std::max(most, expected);
        }
      if (periodic || points.west < 20) {
        EXPECT_GT(most, 0.09f) << points.west;
      }
    }
  }
}

DESERT_ON_EACH_BACKEND(FeetOfPlants);

}  // namespace
}  // namespace desert_sim::micro_relief
