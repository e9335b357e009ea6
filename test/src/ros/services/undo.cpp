/// ~undo and ~redo on a paused node with the scenario corner.yaml (64 × 48 cells of 2 m, corner at (10, −20),
/// half a metre of sand, open edges).
#include <desert_sim/EditTerrain.h>
#include <desert_sim/ElevationGrid.h>
#include <desert_sim/ElevationUpdate.h>
#include <desert_sim/GetSubmap.h>
#include <desert_sim/SimulationStatus.h>
#include <desert_sim/TerrainDiff.h>
#include <desert_sim/Undo.h>

#include <atomic>
#include <thread>

#include "test/support/ros/service_tests.hpp"

namespace {

using namespace desert_sim;
using namespace node_test;
using UndoServices = Services;

EditTerrain::Request brush(double x, double y, const std::string& stroke, const std::string& layer = "sand") {
  EditTerrain::Request request;
  request.layer = layer;
  request.shape = "circle";
  request.merge = "add";
  request.center.x = x;
  request.center.y = y;
  request.radius = 8;
  request.inner = 1;
  request.value = layer == "obstacle" ? 1 : 0.5;
  request.stroke = stroke;
  return request;
}

EditTerrain::Response edit(const EditTerrain::Request& request) {
  const auto response = call<EditTerrain>("edit_terrain", request);
  EXPECT_TRUE(response.success) << response.message;
  return response;
}

Undo::Response turn(const std::string& service, const std::string& stroke = "") {
  Undo::Request request;
  request.stroke = stroke;
  const auto response = call<Undo>(service, request);
  EXPECT_TRUE(response.success) << response.message;
  return response;
}

TEST_F(UndoServices, AStrokeComesBackWithItsVolumeAndItsCells) {
  const std::string before = hash();
  Listener<SimulationStatus> statuses("status");
  const auto status_has = [&](std::uint32_t undoable, std::uint32_t redoable) {
    return wait_until([&] {
      const SimulationStatus status = statuses.last();
      return status.undoable == undoable && status.redoable == redoable;
    });
  };
  const auto first = edit(brush(50, 30, "a"));
  edit(brush(90, 30, "b"));
  const auto second = edit(brush(58, 30, "a"));
  const std::string painted = hash();
  const auto undone = turn("undo", "a");
  EXPECT_EQ(undone.stroke, "a");
  ASSERT_EQ(undone.materials.size(), 1u);
  EXPECT_EQ(undone.materials[0].material, "sand");
  EXPECT_EQ(undone.materials[0].added, 0);
  EXPECT_NEAR(undone.materials[0].removed, first.volume + second.volume, 1e-6);
  EXPECT_EQ(undone.materials[0].missing, 0);
  EXPECT_GE(undone.x, first.x);
  EXPECT_LE(undone.x + undone.width, second.x + second.width);
  EXPECT_EQ(undone.undoable, 1u);
  EXPECT_EQ(undone.redoable, 1u);
  EXPECT_TRUE(status_has(1, 1));
  EXPECT_EQ(turn("redo").stroke, "a");
  EXPECT_TRUE(status_has(2, 0));
  EXPECT_EQ(hash(), painted);
  turn("undo");
  EXPECT_EQ(turn("undo").undoable, 0u);
  EXPECT_EQ(hash(), before);
}

TEST_F(UndoServices, ObstaclesArePaintedAndTakenAway) {
  const std::string before = hash();
  const auto painted = edit(brush(50, 30, "", "obstacle"));
  EXPECT_EQ(painted.volume, 0);
  GetSubmap::Request region;
  region.center.x = 50;
  region.center.y = 30;
  region.length_x = region.length_y = 4;
  region.layers = {"obstacle"};
  const auto there = call<GetSubmap>("get_submap", region);
  ASSERT_TRUE(there.success) << there.message;
  for (float value : there.map.layers.at(0).data) EXPECT_EQ(value, 1);
  const std::string with = hash();
  EXPECT_NE(with, before);
  turn("undo");
  EXPECT_EQ(hash(), before);
  turn("redo");
  EXPECT_EQ(hash(), with);
  auto wrong = brush(50, 30, "", "obstacle");
  wrong.value = 2;
  expect_refused<EditTerrain>("edit_terrain", wrong, "value: 2", "[0, 1]");
  wrong.value = 1;
  wrong.conserve = true;
  wrong.ring_width = 4;
  expect_refused<EditTerrain>("edit_terrain", wrong, "conserve", "no material");
}

TEST_F(UndoServices, WhatIsNotThereIsRefused) {
  expect_refused<Undo>("undo", {}, "no stroke", "undone");
  expect_refused<Undo>("redo", {}, "no stroke", "redone");
  edit(brush(50, 30, "a"));
  Undo::Request other;
  other.stroke = "b";
  expect_refused<Undo>("undo", other, "'b'", "'a'");
  auto wrong = brush(50, 30, std::string(300, 'x'));
  expect_refused<EditTerrain>("edit_terrain", wrong, "300 bytes", "255");
  ASSERT_TRUE(call<std_srvs::Trigger>("reset").success);
  expect_refused<Undo>("undo", {}, "no stroke", "undone");
}

TEST_F(UndoServices, IsToldToWhoeverListens) {
  Listener<TerrainDiff> diffs("terrain_diff");
  Listener<ElevationGrid> keyframes("elevation");
  Listener<ElevationUpdate> updates("elevation_updates");
  keyframes.last();
  ASSERT_TRUE(wait_until([&] {
    edit(brush(50, 30, "a"));
    step(0);
    return diffs.count() > 0 && updates.count() > 0;
  })) << "the node knows them";
  edit(brush(50, 30, "b", "bedrock"));  // all messages before this one have come in when it has
  ASSERT_TRUE(diffs.wait_for([](const TerrainDiff& diff) { return diff.layer == "bedrock"; }));
  const std::size_t before = diffs.count();
  const auto undone = turn("undo", "a");
  ASSERT_TRUE(diffs.wait_for_count(before + 1));
  const TerrainDiff diff = diffs.all().at(before);
  EXPECT_EQ(diff.layer, "sand");
  EXPECT_EQ(diff.x, undone.x);
  EXPECT_EQ(diff.width, undone.width);
  ASSERT_EQ(diff.change.size(), std::size_t{diff.width} * diff.height);
  double sum = 0;
  for (float change : diff.change) sum += change * 4.0;
  EXPECT_NEAR(sum, -undone.materials.at(0).removed, 1e-3);
  step(0);
  turn("redo");
  ASSERT_TRUE(diffs.wait_for_count(before + 2));
  const ros::Time redone = diffs.all().at(before + 1).header.stamp;
  step(0);
  EXPECT_TRUE(updates.wait_for([&](const ElevationUpdate& u) {
    return u.header.stamp == redone && !u.tiles.empty();
  })) << "what came back is an update of the elevation";
}

/// Somebody with connections of his own to the services.
class Operator {
 public:
  explicit Operator(int number)
      : number_(std::to_string(number)),
        edit_(ros::NodeHandle().serviceClient<EditTerrain>("/desert_sim/edit_terrain", true)),
        undo_(ros::NodeHandle().serviceClient<Undo>("/desert_sim/undo", true)),
        redo_(ros::NodeHandle().serviceClient<Undo>("/desert_sim/redo", true)) {}

  /// A stroke of two calls.
  bool paint(int n) {
    EditTerrain exchange;
    exchange.request =
        brush(30 + n % 40, 10 + n % 30, number_ + "/" + std::to_string(n), n % 3 ? "sand" : "bedrock");
    exchange.request.value = 0.01 * (1 + n % 5);
    for (int part = 0; part < 2; ++part)
      if (!edit_.call(exchange) || !exchange.response.success) return false;
    return true;
  }
  /// Of whoever painted last, who may be in the middle of his stroke.
  bool undo() { return turn(undo_); }
  bool redo() { return turn(redo_); }
  bool missed_something() const { return missed_; }

 private:
  bool turn(ros::ServiceClient& client) {
    Undo exchange;
    EXPECT_TRUE(client.call(exchange)) << client.getService();
    for (const auto& material : exchange.response.materials) missed_ = missed_ || material.missing > 0;
    return exchange.response.success != 0;
  }

  std::string number_;
  ros::ServiceClient edit_, undo_, redo_;
  bool missed_ = false;
};

/// Two operators paint and undo at the same time: in the end all is as it was.
TEST_F(UndoServices, AThousandStrokesOfTwoOperatorsAreUndone) {
  constexpr int strokes = 500;
  const std::string before = hash();
  Operator first(0), second(1);
  const auto both = [&](const std::function<void(Operator&)>& work) {
    std::thread other([&] { work(second); });
    work(first);
    other.join();
  };
  std::atomic<int> failed{0}, undone{0};
  both([&](Operator& who) {
    for (int n = 0; n < strokes; ++n) {
      failed += !who.paint(n);
      if (n % 10 == 9) failed += !who.undo() + !who.redo();
    }
  });
  EXPECT_NE(hash(), before);
  both([&](Operator& who) {
    while (who.undo()) ++undone;
  });
  EXPECT_GE(undone, 2 * strokes);
  EXPECT_EQ(failed, 0);
  EXPECT_FALSE(first.missed_something() || second.missed_something());
  expect_refused<Undo>("undo", {}, "no stroke", "undone");
  EXPECT_EQ(hash(), before);
}

}  // namespace

int main(int argc, char** argv) { return node_test::run_tests(argc, argv, "undo"); }
