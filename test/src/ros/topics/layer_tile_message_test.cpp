/// What the node sends as updates, as a client puts it together.
#include "src/ros/topics/layer_tile_message.hpp"

#include <gtest/gtest.h>
#include <ros/serialization.h>

#include <cmath>
#include <random>

#include "include/desert_sim/client/layer_map.hpp"
#include "src/ros/topics/topic.hpp"
#include "test/support/held_terrain.hpp"
#include "test/support/messages.hpp"

namespace {

using namespace desert_sim;
using client_test::keyframe;

constexpr int width = 70, height = 45;

std::vector<float> flat(float elevation) {
  return std::vector<float>(std::size_t{width} * height, elevation);
}

/// A node and a client of it, which begin with a keyframe of `terrain`.
class Stream {
 public:
  Stream(const std::vector<float>& elevation, float threshold, int tile)
      : terrain_(exec_, width, height), threshold_(threshold), tile_(tile) {
    terrain_.set(elevation);
    terrain_.hold();
    ElevationGrid grid = keyframe(1, 1, width, height);
    grid.elevation = terrain_.values();
    ElevationMap::Rectangle changed;
    map_ = std::make_shared<const ElevationMap>(boost::make_shared<ElevationGrid>(grid), nullptr, changed);
  }
  /// The tiles of the update to `elevation`, which the client takes.
  std::vector<LayerTile> update(const std::vector<float>& elevation) {
    terrain_.set(elevation);
    ElevationUpdate update;
    update.header.frame_id = "terrain";
    update.keyframe = 1;
    update.sequence = map_->info().sequence + 1;
    for (const TileChange& change : terrain_.take({threshold_}, tile_))
      update.tiles.push_back(tile_message(change));
    EXPECT_EQ(validation_error(update), "");
    EXPECT_EQ(validation_error(update, map_->info()), "");
    map_ = map_->with_update(update);
    EXPECT_EQ(map_->elevations(), terrain_.held()) << "both know what is held";
    return update.tiles;
  }
  /// How far the client is off.
  double largest_error() const {
    const std::vector<float> client = map_->elevations(), now = terrain_.values();
    double largest = 0;
    for (std::size_t i = 0; i < now.size(); ++i)
      largest = std::max(largest, std::abs(static_cast<double>(client[i]) - now[i]));
    return largest;
  }

 private:
  CpuExec exec_{2};
  test::HeldTerrain terrain_;
  float threshold_;
  int tile_;
  std::shared_ptr<const ElevationMap> map_;
};

TEST(HeldElevation, ErrorsStayWithinTheThresholdAndDoNotAddUp) {
  constexpr float threshold = 0.01f;
  std::mt19937 random(1);
  std::normal_distribution<float> ripple(0, 0.02f), slide(0, 0.6f);
  std::uniform_int_distribution<int> cell(0, width * height - 1), chance(0, 9);
  std::vector<float> elevation = flat(120);
  Stream stream(elevation, threshold, 16);
  for (int round = 0; round < 200; ++round) {
    for (float& z : elevation) z += chance(random) == 0 ? ripple(random) : 0.001f;
    for (int n = 0; n < 40; ++n) elevation[static_cast<std::size_t>(cell(random))] += slide(random);
    if (round % 20 == 0) elevation[static_cast<std::size_t>(cell(random))] += 30;  // beyond eight bits
    stream.update(elevation);
    ASSERT_LE(stream.largest_error(), threshold + 1e-5) << "round " << round;
  }
}

TEST(HeldElevation, OnlyCellsThatChangedAreSent) {
  std::vector<float> elevation = flat(1);
  Stream stream(elevation, 0.01f, 32);
  EXPECT_TRUE(stream.update(elevation).empty());
  elevation[12 * width + 33] += 0.5f;
  elevation[14 * width + 36] -= 0.1f;
  elevation[20 * width + 2] += 0.009f;
  const std::vector<LayerTile> tiles = stream.update(elevation);
  ASSERT_EQ(tiles.size(), 1u);
  EXPECT_EQ(std::make_pair(tiles[0].x, tiles[0].y), std::make_pair(33u, 12u));
  EXPECT_EQ(std::make_pair(tiles[0].width, tiles[0].height), std::make_pair(4u, 3u));
  EXPECT_EQ(tiles[0].changed, (std::vector<std::uint8_t>{0x80, 0x10}));  // numbers 0 and 11 of twelve
  EXPECT_EQ(tiles[0].changes, (std::vector<std::int8_t>{127, -25}));
  EXPECT_TRUE(tiles[0].data.empty());
  EXPECT_TRUE(stream.update(elevation).empty()) << "it is held now";
}

TEST(HeldElevation, WhatEightBitsCannotTellIsSentAsElevations) {
  std::vector<float> elevation = flat(1);
  Stream stream(elevation, 0.01f, 32);
  elevation[0] = 4.5f;
  const std::vector<LayerTile> tiles = stream.update(elevation);
  ASSERT_EQ(tiles.size(), 1u);
  EXPECT_TRUE(tiles[0].changes.empty());
  EXPECT_EQ(tiles[0].data[0], 4.5f);
  EXPECT_EQ(stream.largest_error(), 0);
}

TEST(HeldElevation, AThresholdOfZeroIsExact) {
  std::mt19937 random(2);
  std::normal_distribution<float> ripple(0, 0.02f);
  std::vector<float> elevation = flat(3);
  Stream stream(elevation, 0, 16);
  for (int round = 0; round < 5; ++round) {
    for (float& z : elevation) z += ripple(random);
    stream.update(elevation);
    ASSERT_EQ(stream.largest_error(), 0);
  }
}

TEST(HeldElevation, ADuneStepTakesAFractionOfAKeyframe) {
  std::vector<float> elevation = flat(0);
  Stream stream(elevation, 0.01f, 32);
  for (int y = 10; y < 30; ++y)  // a fifth of the cells
    for (int x = 10; x < 40; ++x)
      elevation[static_cast<std::size_t>(y * width + x)] += 0.02f + 0.01f * (x % 7);
  std::size_t bytes = 0;
  for (const LayerTile& tile : stream.update(elevation)) {
    EXPECT_EQ(tile.bits, 4) << "nothing moved by more than seven steps of two thresholds";
    bytes += ros::serialization::serializationLength(tile);
  }
  EXPECT_LT(bytes, 0.07 * 4 * width * height);
  EXPECT_LE(stream.largest_error(), 0.01 + 1e-6);
}

TEST(SubscriberNames, AreAmongOthers) {
  SubscriberNames keyframes, updates;
  EXPECT_TRUE(keyframes.is_subset_of(updates));
  keyframes.add("/planner");
  EXPECT_FALSE(keyframes.is_subset_of(updates));
  updates.add("/planner");
  updates.add("/logger");
  EXPECT_TRUE(keyframes.is_subset_of(updates));
  EXPECT_FALSE(updates.is_subset_of(keyframes));
  updates.add("/planner");  // it connects anew, and the old connection goes after that
  updates.remove("/planner");
  EXPECT_TRUE(keyframes.is_subset_of(updates));
  updates.remove("/planner");
  updates.remove("/nobody");
  EXPECT_FALSE(keyframes.is_subset_of(updates));
}

}  // namespace
