/// ~undo and ~redo on a paused node with the scenario corner.yaml (64 × 48 cells of 2 m, corner at (10, −20),
/// half a metre of sand, open edges).
#include <desert_sim/ApplySettings.h>
#include <desert_sim/EditTerrain.h>
#include <desert_sim/EditWind.h>
#include <desert_sim/ElevationGrid.h>
#include <desert_sim/ElevationUpdate.h>
#include <desert_sim/GetScenario.h>
#include <desert_sim/GetSubmap.h>
#include <desert_sim/SetWeather.h>
#include <desert_sim/SetWind.h>
#include <desert_sim/SetWindSchedule.h>
#include <desert_sim/SimulationStatus.h>
#include <desert_sim/TerrainDiff.h>
#include <desert_sim/Undo.h>

#include <atomic>
#include <thread>

#include "test/support/ros/service_tests.hpp"

namespace {

using namespace desert_sim;
using namespace node_test;

class UndoServices : public Services {
 protected:
  void SetUp() override;
  /// Beyond what there was before the test.
  bool status_has(std::uint32_t undoable, std::uint32_t redoable) {
    return wait_until([&] {
      const SimulationStatus status = statuses_.last();
      return status.undoable == before_ + undoable && status.redoable == redoable_before_ + redoable;
    });
  }

  Listener<SimulationStatus> statuses_{"status"};
  std::uint32_t before_ = 0, redoable_before_ = 0;
};

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

/// Resets can be undone, too, here those of the tests before this one. How many there are is told by an
/// answer: a status may be one of before.
void UndoServices::SetUp() {
  Services::SetUp();
  edit(brush(50, 30, ""));
  const Undo::Response undone = turn("undo");
  before_ = undone.undoable;
  redoable_before_ = undone.redoable - 1;
  Services::SetUp();  // forgets that stroke, and is no reset to undo, because all is as it was
}

TEST_F(UndoServices, AStrokeComesBackWithItsVolumeAndItsCells) {
  const std::string before = hash();
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
  EXPECT_EQ(undone.undoable, before_ + 1);
  EXPECT_EQ(undone.redoable, redoable_before_ + 1);
  EXPECT_TRUE(status_has(1, 1));
  EXPECT_EQ(turn("redo").stroke, "a");
  EXPECT_TRUE(status_has(2, 0));
  EXPECT_EQ(hash(), painted);
  turn("undo");
  EXPECT_EQ(turn("undo").undoable, before_);
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
  Undo::Request other;
  other.stroke = "b";
  expect_refused<Undo>("undo", other, "no stroke", "undone");
  expect_refused<Undo>("redo", other, "no stroke", "redone");
  edit(brush(50, 30, "a"));
  expect_refused<Undo>("undo", other, "'b'", "'a'");
  auto wrong = brush(50, 30, std::string(300, 'x'));
  expect_refused<EditTerrain>("edit_terrain", wrong, "300 bytes", "255");
}

/// Settings, wind and features are strokes, too; a reset is what undo takes back where no stroke is left.
TEST_F(UndoServices, SettingsWindAndResetsComeBack) {
  const auto yaml = [] { return call<GetScenario>("get_scenario", GetScenario::Request()).yaml; };
  const std::string before = yaml(), state = hash();
  std::vector<std::string> texts{before};
  const auto keep = [&] { texts.push_back(yaml()); };
  SetWind::Request wind;
  wind.speed = 9;
  wind.direction_deg = 90;
  wind.stroke = "wind";
  ASSERT_TRUE(call<SetWind>("set_wind", wind).success);
  wind.speed = 8;
  ASSERT_TRUE(call<SetWind>("set_wind", wind).success);
  keep();
  EditWind::Request vortex;
  vortex.operation = "add";
  vortex.kind = "vortex";
  vortex.id = 3;
  vortex.center.x = 50;
  vortex.radius = 10;
  vortex.speed = 3;
  ASSERT_TRUE(call<EditWind>("edit_wind", vortex).success);
  keep();
  ApplySettings::Request settings;
  settings.settings = {"saltation.lift=0.25", "run.timeline=[{time: 1000, set: {saltation.lift: 1}}]"};
  ASSERT_TRUE(call<ApplySettings>("apply_settings", settings).success);
  keep();
  SetWeather::Request rain;
  rain.change = {"rain_rate"};
  rain.rain_rate = 1e-5;
  ASSERT_TRUE(call<SetWeather>("set_weather", rain).success);
  keep();
  SetWindSchedule::Request rose;
  rose.kind = "rose";
  rose.hold_time = 10;
  rose.segments.resize(2);
  for (auto& segment : rose.segments) segment.speed = segment.probability = 1;
  ASSERT_TRUE(call<SetWindSchedule>("set_wind_schedule", rose).success);
  keep();
  edit(brush(50, 30, ""));
  EXPECT_TRUE(status_has(6, 0)) << statuses_.last().undoable;
  turn("undo");
  for (std::size_t n = texts.size() - 1; n-- > 0;) {
    const Undo::Response r = turn("undo", n == 0 ? "wind" : "");
    EXPECT_FALSE(r.settings.empty());
    EXPECT_EQ(yaml(), texts[n]) << n;
  }
  EXPECT_EQ(hash(), state);
  for (std::size_t n = 1; n < texts.size(); ++n) {
    turn("redo");
    EXPECT_EQ(yaml(), texts[n]) << n;
  }
  ASSERT_TRUE(call<std_srvs::Trigger>("reset").success);
  EXPECT_TRUE(status_has(1, 0)) << "the reset alone";
  EXPECT_EQ(yaml(), before);
  EXPECT_TRUE(turn("undo").terrain_replaced);
  EXPECT_EQ(yaml(), texts.back());
  EXPECT_TRUE(turn("redo").terrain_replaced);
  EXPECT_EQ(yaml(), before);
  wind.stroke = std::string(300, 'x');
  expect_refused<SetWind>("set_wind", wind, "300 bytes", "255");
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
  // What is left beneath these strokes is the reset of SetUp().
  std::atomic<int> left{static_cast<int>(turn("undo").undoable - before_)};
  const int all = left;
  both([&](Operator& who) {
    while (left-- > 0) undone += who.undo();
  });
  EXPECT_GE(undone + 1, 2 * strokes);
  EXPECT_EQ(failed, 0);
  EXPECT_FALSE(first.missed_something() || second.missed_something());
  EXPECT_EQ(undone, all);
  EXPECT_TRUE(status_has(0, static_cast<std::uint32_t>(all + 1))) << statuses_.last().undoable;
  EXPECT_EQ(hash(), before);
}

}  // namespace

int main(int argc, char** argv) { return node_test::run_tests(argc, argv, "undo"); }
