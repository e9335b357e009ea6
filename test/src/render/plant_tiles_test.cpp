// Plants in tiles, which tiles are drawn as shapes, and plants as a picture of the ground.

#include "src/render/plant_tiles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "src/render/plant_choice.hpp"
#include "src/render/plant_cover.hpp"
#include "src/render/plant_shapes.hpp"
#include "test/src/render/fields.hpp"

namespace {

using namespace render_test;

/// Plants that a test makes up: the columns of a message.
struct Columns {
  std::vector<float> x, y, foot, radius;
  std::vector<std::uint8_t> kind, health;

  void add(float east, float north, float width, std::uint8_t of_kind = 0, float z = 0) {
    x.push_back(east);
    y.push_back(north);
    foot.push_back(z);
    radius.push_back(width);
    kind.push_back(of_kind);
    health.push_back(255);
  }
  PlantTiles tiles() const {
    return {{x.size(), x.data(), y.data(), foot.data(), radius.data(), kind.data(), health.data()},
            {{2, {0, 1, 0}}, {1, {1, 0, 0}}}};
  }
};

/// A field of bushes of 0.3 … 0.5 m, `count` on a side, a metre apart; with a tree of 4 m at each tenth one.
Columns field(int count) {
  Columns columns;
  for (int row = 0; row < count; ++row)
    for (int column = 0; column < count; ++column) {
      const auto x = static_cast<float>(column), y = static_cast<float>(row);
      const bool tree = row % 10 == 5 && column % 10 == 5;
      columns.add(x, y, tree ? 4 : 0.3F + 0.02F * static_cast<float>((row * 7 + column) % 10), tree ? 1 : 0);
    }
  return columns;
}

std::vector<ChosenTile> chosen_of(const PlantTiles& plants, const View& view, const PlantLimits& limits) {
  return choose_plant_tiles(plants, view, 1, limits, [](std::size_t) { return false; });
}

std::size_t count_of(const std::vector<ChosenTile>& chosen) {
  std::size_t count = 0;
  for (const ChosenTile& one : chosen) count += one.plants;
  return count;
}

TEST(PlantTiles, HaveEachPlantOnceWithOthersOfItsSizeTheWidestFirst) {
  const Columns columns = field(200);
  const PlantTiles plants = columns.tiles();
  ASSERT_EQ(plants.plants().size(), 40000u);
  std::map<std::pair<float, float>, int> seen;
  std::uint32_t next = 0;
  for (const PlantTile& tile : plants.tiles()) {
    EXPECT_EQ(tile.first, next);
    ASSERT_GT(tile.count, 0u);
    EXPECT_LE(tile.count, PlantTiles::largest_tile);
    next = tile.first + tile.count;
    const Box box = plants.box(tile, 1);
    for (std::uint32_t n = tile.first; n < next; ++n) {
      const TilePlant& plant = plants.plants()[n];
      ++seen[{plant.x, plant.y}];
      EXPECT_LE(plant.radius, tile.widest);
      EXPECT_GT(plant.radius, tile.widest / 2) << "all of a size";
      if (n > tile.first) {
        EXPECT_LE(plant.radius, plants.plants()[n - 1].radius);
      }
    }
    const Box drawn = bounding_box(plants.mesh(tile, true, 1));
    EXPECT_TRUE(box.contains(drawn)) << "of all plants";
    if (tile.widest < 1) {
      EXPECT_LT(box.sizes().x(), 40) << "plants of a tile are close to each other";
    }
  }
  EXPECT_EQ(next, 40000u);
  EXPECT_EQ(seen.size(), 40000u);
}

TEST(PlantTiles, LeaveOutWhatNoDesertHas) {
  constexpr float infinite = std::numeric_limits<float>::infinity(), huge = 3e38F;
  Columns columns;
  for (const float bad : {unknown, infinite, -infinite, huge, -huge}) {
    columns.add(bad, 1, 1);
    columns.add(1, bad, 1);
    columns.add(1, 1, bad);
    columns.add(1, 1, 1, 0, bad);
  }
  columns.add(1, 1, 0);
  columns.add(1, 1, -2);
  columns.add(1, 1, 1, 2);  // of a kind that there is not
  EXPECT_TRUE(columns.tiles().plants().empty());
  EXPECT_TRUE(columns.tiles().tiles().empty());
  EXPECT_TRUE(plant_cover(columns.tiles()).empty());
  columns.add(3, 4, 1);
  const PlantTiles one = columns.tiles();
  ASSERT_EQ(one.plants().size(), 1u);
  EXPECT_EQ(one.plants()[0].x, 3);
}

TEST(PlantTiles, AreDividedWhereAllPlantsStandInOnePlace) {
  Columns columns;
  for (int n = 0; n < 10000; ++n) columns.add(7, 7, 1);
  EXPECT_EQ(columns.tiles().tiles().size(), 40u);
}

TEST(PlantTiles, HaveMeshesOfTheWidestPlantsFirst) {
  Columns columns;
  columns.add(0, 0, 1.2F, 0, 5);
  columns.add(10, 0, 1.8F, 0, 5);
  const PlantTiles plants = columns.tiles();
  ASSERT_EQ(plants.tiles().size(), 1u);
  const Mesh mesh = plants.mesh(plants.tiles()[0], false, 3);
  ASSERT_EQ(mesh.indices.size(), 2 * indices_of_plant(false));
  for (std::size_t n = 0; n < indices_of_plant(false); ++n)
    EXPECT_GT(mesh.vertices[mesh.indices[n]].x, 5) << "the wider one";
  const Box box = bounding_box(mesh);
  EXPECT_FLOAT_EQ(static_cast<float>(box.min().z()), 15) << "feet are exaggerated";
  EXPECT_FLOAT_EQ(static_cast<float>(box.max().z()), 15 + 2 * 1.8F) << "plants keep their shape";
  EXPECT_EQ(plants.mesh(plants.tiles()[0], true, 1).indices.size(), 2 * indices_of_plant(true));
}

TEST(PlantChoice, TakesThoseThatAreLargeEnoughForTheCamera) {
  const PlantTiles plants = field(200).tiles();
  PlantLimits limits;
  limits.plants = 1000000;
  limits.tiles = 1000000;
  limits.pixels = 2;
  const auto at_height = [&](double z) {
    return chosen_of(plants, View(perspective(), camera_at(100, 100, z, -90), 800), limits);
  };
  // A metre takes 400 / z pixels: trees are seen from up to 800 m, bushes from up to 96 m.
  EXPECT_EQ(count_of(at_height(900)), 0u);
  EXPECT_EQ(count_of(at_height(700)), 400u);
  const std::vector<ChosenTile> from_far = at_height(500);
  EXPECT_EQ(count_of(from_far), 400u);
  for (const ChosenTile& one : from_far) EXPECT_EQ(plants.tiles()[one.tile].widest, 4) << "trees alone";
  EXPECT_GT(count_of(at_height(60)), 5000u);
  const View ortho(orthographic(400), camera_at(100, 100, 0, -90), 800);  // 2 pixels a metre
  EXPECT_EQ(count_of(chosen_of(plants, ortho, limits)), 400u);
}

TEST(PlantChoice, TakesTheLargestInThePictureAndAsManyAsAllowed) {
  const PlantTiles plants = field(200).tiles();
  PlantLimits limits;
  limits.plants = 2000;
  const View view(perspective(), camera_at(100, 10, 3, 0), 800);  // to the north
  const std::vector<ChosenTile> chosen = chosen_of(plants, view, limits);
  EXPECT_EQ(count_of(chosen), 2000u);
  double last = HUGE_VAL;
  std::size_t detailed = 0;
  for (const ChosenTile& one : chosen) {
    const PlantTile& tile = plants.tiles()[one.tile];
    const Box box = plants.box(tile, 1);
    const double pixels = static_cast<double>(tile.widest) * view.pixels_per_metre(box);
    EXPECT_LE(pixels, last);
    last = pixels;
    EXPECT_GE(pixels, limits.pixels);
    EXPECT_TRUE(view.sees(box));
    if (one.detailed) {
      detailed += one.plants;
      EXPECT_GE(pixels, limits.detailed_pixels);
    }
  }
  EXPECT_GT(detailed, 0u);
  EXPECT_LE(detailed, 200u) << "a tenth";
  limits.tiles = 3;
  EXPECT_EQ(chosen_of(plants, view, limits).size(), 3u);
  limits.plants = 1;
  EXPECT_EQ(count_of(chosen_of(plants, view, limits)), 1u);
}

TEST(PlantChoice, KeepsDetailUntilItIsClearlyTooMuch) {
  Columns columns;
  columns.add(0, 0, 1);
  const PlantTiles plants = columns.tiles();
  const auto is_detailed = [&](double pixels_per_metre, bool before) {
    const View view(orthographic(800 / pixels_per_metre), camera_at(0, 0, 0, -90), 800);
    return choose_plant_tiles(plants, view, 1, {}, [&](std::size_t) { return before; }).at(0).detailed;
  };
  EXPECT_TRUE(is_detailed(13, false));
  EXPECT_FALSE(is_detailed(11, false));
  EXPECT_TRUE(is_detailed(11, true));
  EXPECT_FALSE(is_detailed(9, true));
}

double cover_of(const CoverPicture& picture, std::size_t level) {
  double sum = 0;
  for (const PackedColour pixel : picture.levels[level]) sum += (pixel >> 24) / 255.0;
  return sum * picture.pixel * picture.pixel * std::pow(4, level);
}

TEST(PlantCover, CoversTheAreaOfTheCrownsAtEachLevel) {
  Columns columns;
  double area = 0;
  for (int n = 0; n < 100; ++n) {  // apart from each other, some smaller than a pixel
    const float radius = 0.05F + 0.03F * static_cast<float>(n);
    columns.add(10 + 8.37F * static_cast<float>(n % 10), 10 + 8.19F * static_cast<float>(n / 10), radius);
    area += pi * static_cast<double>(radius * radius);
  }
  const CoverPicture picture = plant_cover(columns.tiles());
  ASSERT_FALSE(picture.empty());
  for (std::size_t level = 0; level < picture.levels.size(); ++level) {
    EXPECT_EQ(picture.levels[level].size(), static_cast<std::size_t>(picture.width >> level) *
                                                static_cast<std::size_t>(picture.height >> level));
    EXPECT_NEAR(cover_of(picture, level), area, (level == 0 ? 0.02 : 0.05) * area) << level;
  }
}

TEST(PlantCover, HasTheColourOfThePlantsWhereTheyAre) {
  Columns columns;
  columns.add(2, 2, 1.5F, 0);
  columns.add(40, 30, 1.5F, 1);
  const CoverPicture picture = plant_cover(columns.tiles());
  const auto at = [&](double x, double y) {
    const auto column = static_cast<int>((x - picture.west) / picture.pixel),
               row = static_cast<int>((y - picture.south) / picture.pixel);
    return picture.levels[0][static_cast<std::size_t>(row * picture.width + column)];
  };
  // Of a pyramid, two sides are in the sun: it is darker than level ground.
  EXPECT_EQ(at(2, 2) >> 24, 255u);
  EXPECT_NEAR(at(2, 2) >> 8 & 255, 150, 60);
  EXPECT_EQ(at(2, 2) & 0xff00ff, 0u) << "green";
  EXPECT_NEAR(at(40, 30) & 255, 150, 60);
  EXPECT_EQ(at(40, 30) & 0xffff00, 0u) << "red";
  EXPECT_EQ(at(20, 15) >> 24, 0u) << "bare";
  EXPECT_NEAR(at(20, 15) & 255, (at(40, 30) & 255) / 2, 2) << "with the colours of all plants, for filters";
  EXPECT_NEAR(at(20, 15) >> 8 & 255, (at(2, 2) >> 8 & 255) / 2, 2);
}

TEST(PlantCover, OfCrownsAboveEachOtherIsLessThanTheirSum) {
  Columns columns;
  columns.add(0, 0, 0.3F);
  columns.add(200, 200, 0.3F);
  const CoverPicture one = plant_cover(columns.tiles());
  ASSERT_EQ(one.pixel, 1);
  for (int n = 0; n < 3; ++n) columns.add(200, 200, 0.3F);
  const CoverPicture four = plant_cover(columns.tiles());
  ASSERT_TRUE(four.same_grid(one));
  const auto cover = [](const CoverPicture& picture) {
    return *std::max_element(picture.levels[0].begin(), picture.levels[0].end()) >> 24;
  };
  EXPECT_NEAR(cover(one), 255 * 0.2827, 1);
  EXPECT_NEAR(cover(four), 255 * (1 - std::pow(1 - 0.2827, 4)), 1) << "what lies at random";
}

TEST(PlantCover, EndsAtItsBounds) {
  Columns columns;
  for (int n = 0; n < 400; ++n)
    columns.add(static_cast<float>(n % 20), static_cast<float>(n / 20), n % 2 ? 0.02F : 1);
  const CoverPicture picture = plant_cover(columns.tiles(), {3, 4, 15.5, 16.5});
  int covered = 0;
  for (int row = 0; row < picture.height; ++row)
    for (int column = 0; column < picture.width; ++column) {
      const double x = picture.west + (column + 0.5) * picture.pixel,
                   y = picture.south + (row + 0.5) * picture.pixel;
      const bool within = x > 3 && x < 15.5 && y > 4 && y < 16.5;
      const PackedColour pixel = picture.levels[0][static_cast<std::size_t>(row * picture.width + column)];
      covered += pixel >> 24 > 0;
      if (!within) {
        EXPECT_EQ(pixel >> 24, 0u) << x << " " << y;
      }
    }
  EXPECT_NEAR(covered * picture.pixel * picture.pixel, 12.5 * 12.5, 10);
}

TEST(PlantCover, HasBoundedSizeAndWork) {
  Columns columns;
  for (int n = 0; n < 20000; ++n) columns.add(n % 2 ? -1e7F : 1e7F, n % 3 ? 0 : 1e7F, 1e7F);
  const CoverPicture picture = plant_cover(columns.tiles());  // ends
  EXPECT_LE(picture.width, CoverPicture::most_pixels);
  EXPECT_LE(picture.height, CoverPicture::most_pixels);
}

TEST(PlantCover, ChangesStripsWherePlantsChange) {
  Columns columns = field(300);
  const CoverPicture before = plant_cover(columns.tiles());
  ASSERT_GT(before.strips.size(), 3u);
  std::vector<int> rows(before.levels.size(), 0);
  for (const CoverStrip& strip : before.strips) {
    EXPECT_EQ(strip.first, rows[strip.level]) << "strips follow each other";
    rows[strip.level] += strip.rows;
  }
  for (std::size_t level = 0; level < rows.size(); ++level) EXPECT_EQ(rows[level], before.height >> level);
  columns.radius[0] += 0.1F;  // the south-west
  const CoverPicture after = plant_cover(columns.tiles());
  ASSERT_TRUE(after.same_grid(before));
  EXPECT_NE(after.strips[0].hash, before.strips[0].hash);
  EXPECT_EQ(after.strips[1].hash, before.strips[1].hash);
}

}  // namespace
