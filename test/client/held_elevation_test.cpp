/// What the node sends as updates, as a client puts it together.
#include "desert_sim/ros/held_elevation.hpp"

#include <gtest/gtest.h>
#include <ros/serialization.h>

#include <cmath>
#include <limits>
#include <random>

#include "client/messages.hpp"
#include "desert_sim/client/elevation_map.hpp"
#include "desert_sim/ros/topic.hpp"

namespace {

using namespace desert_sim;
using client_test::keyframe;

constexpr int width = 70, height = 45;
constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

Snapshot snapshot(float elevation) {
  Snapshot s;
  s.width = width;
  s.height = height;
  s.layers[Layer::elevation].assign(std::size_t{width} * height, elevation);
  return s;
}

/// A node and a client of it, which begin with a keyframe of `terrain`.
class Stream {
 public:
  Stream(const Snapshot& terrain, double threshold, int tile) : held_(threshold, tile) {
    held_.hold(terrain);
    ElevationGrid grid = keyframe(1, 1, width, height);
    grid.elevation = terrain.layers.at(Layer::elevation);
    ElevationMap::Rectangle changed;
    map_ = std::make_shared<const ElevationMap>(grid, nullptr, changed);
  }
  /// The tiles of the update to `terrain`, which the client takes.
  std::vector<ElevationTile> update(const Snapshot& terrain) {
    ElevationUpdate update;
    update.header.frame_id = "terrain";
    update.keyframe = 1;
    update.sequence = map_->info().sequence + 1;
    update.tiles = held_.take_changes(terrain);
    EXPECT_EQ(fault_of(update), "");
    EXPECT_EQ(fault_of(update, map_->info()), "");
    map_ = map_->after(update);
    return update.tiles;
  }
  std::vector<float> client() const { return map_->elevations(); }

 private:
  HeldElevation held_;
  std::shared_ptr<const ElevationMap> map_;
};

/// How far the client is off; infinite where only one of both knows a cell.
double largest_error(const Stream& stream, const Snapshot& terrain) {
  const std::vector<float> client = stream.client(), &now = terrain.layers.at(Layer::elevation);
  double largest = 0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (std::isnan(client[i]) && std::isnan(now[i])) continue;
    const double error = std::abs(static_cast<double>(client[i]) - now[i]);
    largest = std::max(largest, std::isnan(error) ? HUGE_VAL : error);
  }
  return largest;
}

TEST(HeldElevation, ErrorsStayWithinTheThresholdAndDoNotAddUp) {
  constexpr double threshold = 0.01;
  std::mt19937 random(1);
  std::normal_distribution<float> ripple(0, 0.02f), slide(0, 0.6f);
  std::uniform_int_distribution<int> cell(0, width * height - 1), chance(0, 9);
  Snapshot terrain = snapshot(120);
  Stream stream(terrain, threshold, 16);
  for (int round = 0; round < 200; ++round) {
    std::vector<float>& elevation = terrain.layers[Layer::elevation];
    for (float& z : elevation) z += chance(random) == 0 ? ripple(random) : 0.001f;
    for (int n = 0; n < 40; ++n) elevation[static_cast<std::size_t>(cell(random))] += slide(random);
    if (round % 20 == 0) elevation[static_cast<std::size_t>(cell(random))] += 30;  // beyond eight bits
    if (round % 30 == 0) elevation[static_cast<std::size_t>(cell(random))] = unknown;
    if (round % 30 == 15)
      for (float& z : elevation)
        if (std::isnan(z)) z = 119;
    stream.update(terrain);
    ASSERT_LE(largest_error(stream, terrain), threshold + 1e-5) << "round " << round;
  }
}

TEST(HeldElevation, OnlyCellsThatChangedAreSent) {
  Snapshot terrain = snapshot(1);
  Stream stream(terrain, 0.01, 32);
  EXPECT_TRUE(stream.update(terrain).empty());
  std::vector<float>& elevation = terrain.layers[Layer::elevation];
  elevation[12 * width + 33] += 0.5f;
  elevation[14 * width + 36] -= 0.1f;
  elevation[20 * width + 2] += 0.009f;
  const std::vector<ElevationTile> tiles = stream.update(terrain);
  ASSERT_EQ(tiles.size(), 1u);
  EXPECT_EQ(std::make_pair(tiles[0].x, tiles[0].y), std::make_pair(33u, 12u));
  EXPECT_EQ(std::make_pair(tiles[0].width, tiles[0].height), std::make_pair(4u, 3u));
  EXPECT_EQ(tiles[0].changed, (std::vector<std::uint8_t>{0x80, 0x10}));  // numbers 0 and 11 of twelve
  EXPECT_EQ(tiles[0].changes, (std::vector<std::int8_t>{127, -25}));
  EXPECT_TRUE(tiles[0].data.empty());
  EXPECT_TRUE(stream.update(terrain).empty()) << "it is held now";
}

TEST(HeldElevation, WhatEightBitsCannotTellIsSentAsElevations) {
  Snapshot terrain = snapshot(1);
  Stream stream(terrain, 0.01, 32);
  terrain.layers[Layer::elevation][0] = 4.5f;
  terrain.layers[Layer::elevation][1] = unknown;
  const std::vector<ElevationTile> tiles = stream.update(terrain);
  ASSERT_EQ(tiles.size(), 1u);
  EXPECT_TRUE(tiles[0].changes.empty());
  EXPECT_EQ(tiles[0].data[0], 4.5f);
  EXPECT_EQ(largest_error(stream, terrain), 0);
}

TEST(HeldElevation, AThresholdOfZeroIsExact) {
  std::mt19937 random(2);
  std::normal_distribution<float> ripple(0, 0.02f);
  Snapshot terrain = snapshot(3);
  Stream stream(terrain, 0, 16);
  for (int round = 0; round < 5; ++round) {
    for (float& z : terrain.layers[Layer::elevation]) z += ripple(random);
    stream.update(terrain);
    ASSERT_EQ(largest_error(stream, terrain), 0);
  }
}

TEST(HeldElevation, ADuneStepTakesAFractionOfAKeyframe) {
  Snapshot terrain = snapshot(0);
  Stream stream(terrain, 0.01, 32);
  for (int y = 10; y < 30; ++y)  // a fifth of the cells
    for (int x = 10; x < 40; ++x)
      terrain.layers[Layer::elevation][static_cast<std::size_t>(y * width + x)] += 0.02f + 0.01f * (x % 7);
  std::size_t bytes = 0;
  for (const ElevationTile& tile : stream.update(terrain)) {
    EXPECT_EQ(tile.bits, 4) << "nothing moved by more than seven steps of two thresholds";
    bytes += ros::serialization::serializationLength(tile);
  }
  EXPECT_LT(bytes, 0.07 * 4 * width * height);
  EXPECT_LE(largest_error(stream, terrain), 0.01 + 1e-6);
}

TEST(SubscriberNames, AreAmongOthers) {
  SubscriberNames keyframes, updates;
  EXPECT_TRUE(keyframes.are_among(updates));
  keyframes.joined("/planner");
  EXPECT_FALSE(keyframes.are_among(updates));
  updates.joined("/planner");
  updates.joined("/logger");
  EXPECT_TRUE(keyframes.are_among(updates));
  EXPECT_FALSE(updates.are_among(keyframes));
  updates.joined("/planner");  // it connects anew, and the old connection goes after that
  updates.left("/planner");
  EXPECT_TRUE(keyframes.are_among(updates));
  updates.left("/planner");
  updates.left("/nobody");
  EXPECT_FALSE(keyframes.are_among(updates));
}

}  // namespace
