/// What a client answers about the surface it holds.
#include "include/desert_sim/client/layer_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "test/support/messages.hpp"

namespace {

using namespace client_test;
using desert_sim::ElevationMap;
using Rectangle = desert_sim::ElevationMap::Rectangle;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

std::shared_ptr<const ElevationMap> map_of(const ElevationGrid& grid) {
  Rectangle changed;
  return std::make_shared<const ElevationMap>(boost::make_shared<ElevationGrid>(grid), nullptr, changed);
}

void expect_rectangle(const Rectangle& r, std::uint32_t x, std::uint32_t y, std::uint32_t width,
                      std::uint32_t height) {
  EXPECT_EQ(r.x, x);
  EXPECT_EQ(r.y, y);
  EXPECT_EQ(r.width, width);
  EXPECT_EQ(r.height, height);
}

// ---- cells ----

TEST(ElevationMap, KeepsEveryCellInItsPlace) {
  const ElevationGrid grid = keyframe_of([](double x, double y) { return 1000 * y + x; });
  const auto map = map_of(grid);
  EXPECT_EQ(map->elevations(), grid.elevation);
  EXPECT_EQ(map->at(0, 0), 0);
  EXPECT_EQ(map->at(129, 0), 129);
  EXPECT_EQ(map->at(0, 69), 69000);
  EXPECT_EQ(map->at(64, 65), 65064);
  EXPECT_EQ(map->elevations({63, 62, 3, 2}), (std::vector<float>{62063, 62064, 62065, 63063, 63064, 63065}));
}

TEST(ElevationMap, RefusesCellsOffTheGrid) {
  const auto map = map_of(keyframe(1, 1));
  EXPECT_THROW(map->at(130, 0), std::out_of_range);
  EXPECT_THROW(map->at(0, 70), std::out_of_range);
  EXPECT_THROW(map->elevations({1, 0, 130, 1}), std::out_of_range);
  EXPECT_THROW(map->elevations({4294967295u, 0, 2, 1}), std::out_of_range);
}

TEST(ElevationMap, FindsTheCellOfAPointAndItsCentre) {
  const auto map = map_of(keyframe(1, 1));  // 130 x 70 cells of 2 m, corner at (10, -20)
  const auto expect_cell = [&map](double x, double y, std::uint32_t cell_x, std::uint32_t cell_y) {
    const std::optional<ElevationMap::Cell> cell = map->cell_of(x, y);
    ASSERT_TRUE(cell) << x << ", " << y;
    EXPECT_EQ(cell->x, cell_x);
    EXPECT_EQ(cell->y, cell_y);
  };
  expect_cell(10, -20, 0, 0);
  expect_cell(11.9, -18.1, 0, 0);
  expect_cell(12, -18, 1, 1);
  expect_cell(270, 120, 129, 69);  // the outer edges belong to the grid
  EXPECT_FALSE(map->cell_of(9.99, 0));
  EXPECT_FALSE(map->cell_of(20, 120.1));
  EXPECT_FALSE(map->cell_of(unknown, 0));
  EXPECT_EQ(map->center_of({3, 69}).x, 17);
  EXPECT_EQ(map->center_of({3, 69}).y, 119);
  EXPECT_EQ(map->center_of({3, 69}).z, 0);
}

TEST(ElevationMap, AnUpdateMakesANewMapAndLeavesTheOldOne) {
  ElevationGrid grid = keyframe_of([](double x, double y) { return 1000 * y + x; });
  const auto before = map_of(grid);
  const auto u = update(1, 1, 2);
  u->tiles = {tile(60, 61, 70, 9, -1),
              tile(60, 61, 2, 1, -2)};  // over the edges of blocks, and over each other
  const auto after = before->with_update(*u);
  EXPECT_EQ(before->elevations(), grid.elevation);
  for (std::uint32_t y = 61; y < 70; ++y)
    for (std::uint32_t x = 60; x < 130; ++x) grid.elevation[y * 130 + x] = y == 61 && x < 62 ? -2 : -1;
  EXPECT_EQ(after->elevations(), grid.elevation);
  EXPECT_EQ(after->info().sequence, 1u);
  EXPECT_EQ(after->info().step, 2u);
  EXPECT_EQ(after->info().stamp, ros::Time(2, 0));
}

TEST(ElevationMap, AMaskSaysWhichCellsOfATileChangeAndStepsByHowMuch) {
  ElevationGrid grid = keyframe_of([](double x, double y) { return 1000 * y + x; });
  const auto u = update(1, 1, 2);
  LayerTile steps, elevations;
  steps.x = 63, steps.y = 60, steps.width = 3, steps.height = 5;  // over the corner of four blocks
  steps.changed = {0b10000001, 0b00000010};                       // numbers 0, 7 and 14
  steps.changes = {-128, 3, 127};
  steps.resolution = 0.25f;
  steps.bits = 8;
  elevations.x = 0, elevations.y = 0, elevations.width = 4, elevations.height = 1;
  elevations.changed = {0b01010000};
  elevations.data = {-7, -8};
  u->tiles = {steps, elevations};
  ASSERT_EQ(validation_error(*u), "");
  grid.elevation[60 * 130 + 63] -= 32;
  grid.elevation[62 * 130 + 64] += 0.75f;
  grid.elevation[64 * 130 + 65] += 31.75f;
  const auto before = map_of(keyframe_of([](double x, double y) { return 1000 * y + x; }));
  grid.elevation[1] = -7;
  grid.elevation[3] = -8;
  EXPECT_EQ(before->with_update(*u)->elevations(), grid.elevation);
}

TEST(ElevationMap, ChangesOfFourBitsLieTwoInAByte) {
  ElevationGrid grid = keyframe_of([](double x, double y) { return 1000 * y + x; });
  const auto before = map_of(grid);
  const auto message = update(1, 1, 2);
  LayerTile tile;
  tile.x = 10, tile.y = 20, tile.width = 5, tile.height = 1;
  tile.changed = {0b11101000};                            // four of them, then one without
  tile.changes = {0x7f, static_cast<std::int8_t>(0x83)};  // 7, -1; -8, 3
  tile.resolution = 0.5f;
  tile.bits = 4;
  message->tiles = {tile};
  ASSERT_EQ(validation_error(*message), "");
  const float change[] = {3.5f, -0.5f, -4, 0, 1.5f};
  for (std::size_t n = 0; n < 5; ++n) grid.elevation[20 * 130 + 10 + n] += change[n];
  EXPECT_EQ(before->with_update(*message)->elevations(), grid.elevation);
  message->tiles[0].changed = {0b11100000};  // an odd number: half of the last byte is left
  EXPECT_EQ(validation_error(*message), "");
  message->tiles[0].changed = {0b11000000};
  EXPECT_NE(validation_error(*message).find("4 values for 2 cells that changed"), std::string::npos)
      << validation_error(*message);
  message->tiles[0].bits = 5;
  EXPECT_NE(validation_error(*message).find("changes of 5 bits: must be 8 or 4"), std::string::npos)
      << validation_error(*message);
}

TEST(ElevationMap, AKeyframeTellsWhichCellsDiffer) {
  const ElevationGrid grid = keyframe_of([](double x, double y) { return x == 3 ? unknown : y; });
  const auto before = map_of(grid);
  Rectangle changed;
  const ElevationMap same(boost::make_shared<ElevationGrid>(grid), before.get(), changed);
  EXPECT_TRUE(changed.empty()) << "unknown cells do not differ from unknown ones";
  ElevationGrid other = grid;
  other.elevation[5 * 130 + 10] = 99;
  other.elevation[68 * 130 + 127] = static_cast<float>(unknown);
  const ElevationMap differs(boost::make_shared<ElevationGrid>(other), before.get(), changed);
  expect_rectangle(changed, 10, 5, 118, 64);
  other = grid;
  other.origin.position.x += 1;
  const ElevationMap moved(boost::make_shared<ElevationGrid>(other), before.get(), changed);
  expect_rectangle(changed, 0, 0, 130, 70);
}

// ---- the surface between them ----

TEST(ElevationMap, APlaneIsAPlane) {
  const auto map =
      map_of(keyframe_of([](double x, double y) { return 5 + 0.5 * (2 * x + 1) - 0.25 * (2 * y + 1); }));
  for (double x = 11.5; x < 268; x += 7.3)
    for (double y = -18.5; y < 118; y += 6.1) {
      EXPECT_NEAR(map->elevation(x, y).value(), 5 + 0.5 * (x - 10) - 0.25 * (y + 20), 1e-4) << x << ", " << y;
      EXPECT_NEAR(map->slope(x, y).value(), std::atan(std::sqrt(0.5 * 0.5 + 0.25 * 0.25)), 1e-4);
      const auto normal = map->normal(x, y).value();
      EXPECT_NEAR(normal.x / normal.z, -0.5, 1e-4);
      EXPECT_NEAR(normal.y / normal.z, 0.25, 1e-4);
      EXPECT_NEAR(normal.x * normal.x + normal.y * normal.y + normal.z * normal.z, 1, 1e-12);
    }
}

TEST(ElevationMap, EndsAtTheEdgesOfItsOuterCells) {
  const auto map = map_of(keyframe_of([](double x, double y) { return 1000 * y + x; }));
  EXPECT_EQ(map->elevation(10, -20), 0);
  EXPECT_EQ(map->elevation(270, 120), 69129);
  EXPECT_EQ(map->elevation(9.999, 0), std::nullopt);
  EXPECT_EQ(map->elevation(20, 120.001), std::nullopt);
  EXPECT_EQ(map->elevation(unknown, 0), std::nullopt);
  EXPECT_EQ(map->slope(20, std::numeric_limits<double>::infinity()), std::nullopt);
  EXPECT_FALSE(map->normal(-1e300, 0));
}

TEST(ElevationMap, AnUnknownCellIsUnknownOnlyWhereItCounts) {
  const auto map = map_of(keyframe_of([](double x, double y) { return x == 5 && y == 5 ? unknown : 3; }));
  const double centre_x = 10 + 2 * 5.5, centre_y = -20 + 2 * 5.5;
  EXPECT_EQ(map->elevation(centre_x, centre_y), std::nullopt);
  EXPECT_EQ(map->elevation(centre_x + 1.9, centre_y), std::nullopt);
  EXPECT_EQ(map->elevation(centre_x + 2, centre_y), 3) << "the centre of its neighbour";
  EXPECT_EQ(map->slope(centre_x + 1, centre_y + 1), std::nullopt);
  EXPECT_EQ(map->slope(centre_x + 3, centre_y + 3), 0);
}

TEST(ElevationMap, ASingleCellIsLevel) {
  const auto map = map_of(keyframe(1, 1, 1, 1, 4));
  EXPECT_EQ(map->elevation(11.7, -18.2), 4);
  EXPECT_EQ(map->slope(11.7, -18.2), 0);
  EXPECT_EQ(map->elevation(12.1, -19), std::nullopt);
}

}  // namespace
