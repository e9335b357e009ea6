// The tool desert_sim/WindTool in rviz.

#include <desert_sim/WindFeatureList.h>

#include <cmath>
#include <limits>

#include "src/rviz/wind_features.hpp"
#include "test/src/rviz/made_up_node.hpp"
#include "test/src/rviz/tool_fixture.hpp"

namespace rviz_test {
namespace {

using desert_sim::EditWind;
using desert_sim::WindFeatureItem;
using desert_sim::WindFeatureList;
using desert_sim::WindFeatures;

constexpr double to_a_pixel = 0.3;  // [m]; five pixels are a metre

class WindTool : public RvizTools {
 protected:
  void SetUp() override {
    RvizTools::SetUp();
    if (!window_) return;
    tool_ = use("desert_sim/WindTool");
    ASSERT_TRUE(finds_terrain()) << "the tool finds the terrain";
  }
  bool finds_terrain() {
    return window_->run_until([&] {
      mouse(QEvent::MouseMove, {70, 30}, Qt::NoButton);
      return tool_->property("over_terrain").toBool();
    });
  }
  /// The features of the node, of which there are so many, when the tool knows of them.
  WindFeatures features(std::size_t count) {
    wait_for(tool_);
    EXPECT_TRUE(window_->run_until([&] {
      return list_.count() > 0 && list_.last().features.size() == count;
    })) << report();
    EXPECT_TRUE(window_->run_until([&] { return tool_->property("features").toInt() == int(count); }));
    return list_.last().features;
  }
  std::string report() { return text(tool_, "report"); }
  bool says(const std::string& words) { return report().find(words) != std::string::npos; }

  node_test::Listener<WindFeatureList> list_{"wind_features"};
  rviz::Tool* tool_ = nullptr;
};

void expect_at(const WindFeatureItem& feature, const At& at) {
  EXPECT_NEAR(feature.center.x, at.x, to_a_pixel);
  EXPECT_NEAR(feature.center.y, at.y, to_a_pixel);
}

TEST_F(WindTool, ADragPlacesAVortexOfItsRadiusAndAClickOneOfTheLast) {
  set_tool(tool_, "Speed", -4);
  drag({60, 20}, {75, 28}, 10);
  WindFeatures there = features(1);
  ASSERT_EQ(there.size(), 1u);
  EXPECT_EQ(there[0].kind, EditWind::Request::VORTEX);
  EXPECT_GT(there[0].id, 0);
  expect_at(there[0], {60, 20});
  EXPECT_NEAR(there[0].radius, 17, to_a_pixel);
  EXPECT_EQ(there[0].speed, -4);
  EXPECT_TRUE(says("vortex " + std::to_string(there[0].id) + " placed")) << report();
  EXPECT_NEAR(get_tool(tool_, "Radius"), 17, to_a_pixel);
  click({110, 50});
  there = features(2);
  ASSERT_EQ(there.size(), 2u);
  expect_at(there[1], {110, 50});
  EXPECT_NEAR(there[1].radius, there[0].radius, 1e-4);
  EXPECT_NE(there[1].id, there[0].id);
}

TEST_F(WindTool, ADragGivesAJetItsDirectionAndLength) {
  set_tool(tool_, "Kind", "Jet");
  set_tool(tool_, "Radius", 6);
  drag({60, 20}, {60, 50}, 10);
  const WindFeatures there = features(1);
  ASSERT_EQ(there.size(), 1u);
  EXPECT_EQ(there[0].kind, EditWind::Request::JET);
  expect_at(there[0], {60, 20});
  EXPECT_NEAR(there[0].length, 30, to_a_pixel);
  EXPECT_NEAR(there[0].direction_deg, 90, 1);
  EXPECT_EQ(there[0].radius, 6);
}

TEST_F(WindTool, ADragPlacesASink) {
  set_tool(tool_, "Kind", "Sink");
  drag({60, 20}, {70, 20}, 5);
  const WindFeatures there = features(1);
  ASSERT_EQ(there.size(), 1u);
  EXPECT_EQ(there[0].kind, EditWind::Request::SINK);
  EXPECT_NEAR(there[0].radius, 10, to_a_pixel);
  save("wind_sink");
}

/// What moves by itself is where it is now, and goes on from where it is put.
TEST_F(WindTool, AMovingFeatureIsTakenWhereItIs) {
  EditWind::Request moving;
  moving.operation = EditWind::Request::ADD;
  moving.kind = EditWind::Request::VORTEX;
  moving.id = 3;
  moving.center.x = 40, moving.center.y = 20, moving.radius = 8, moving.speed = 4;
  moving.velocity.x = 1;
  EXPECT_TRUE(call<EditWind>("edit_wind", moving).success);
  features(1);
  node_test::step(20);  // of a second
  ASSERT_TRUE(window_->run_until([&] { return list_.last().sim_time == 20; }));
  EXPECT_TRUE(window_->run_until([&] {  // the tool has heard of it, too
    drag({60, 20}, {60, 40}, 5, Qt::ControlModifier);
    wait_for(tool_);
    return says("moved");
  })) << report();
  ASSERT_TRUE(window_->run_until([&] { return list_.last().features.at(0).center.y > 30; }));
  expect_at(list_.last().features.at(0), {40, 40});
  EXPECT_EQ(list_.last().features.at(0).velocity.x, 1);
}

TEST_F(WindTool, EachPatchOfTurbulenceHasItsOwnSeed) {
  set_tool(tool_, "Kind", "Turbulence");
  set_tool(tool_, "Eddy Size", 3);
  set_tool(tool_, "Life Time", 7);
  set_tool(tool_, "Seed", 20);
  drag({60, 20}, {70, 20}, 5);
  drag({100, 50}, {110, 50}, 5);
  const WindFeatures there = features(2);
  ASSERT_EQ(there.size(), 2u);
  for (const WindFeatureItem& patch : there) {
    EXPECT_EQ(patch.kind, EditWind::Request::TURBULENCE);
    EXPECT_NEAR(patch.radius, 10, to_a_pixel);
    EXPECT_EQ(patch.scale, 3);
    EXPECT_EQ(patch.life_time, 7);
  }
  EXPECT_EQ(there[0].seed, 20);
  EXPECT_EQ(there[1].seed, 21);
}

TEST_F(WindTool, ControlMovesAndShiftRemoves) {
  drag({60, 20}, {70, 20}, 5);
  click({100, 50});
  const WindFeatures before = features(2);
  drag({60, 20}, {90, 10}, 10, Qt::ControlModifier);
  wait_for(tool_);
  EXPECT_TRUE(says("moved")) << report();
  EXPECT_TRUE(window_->run_until([&] { return list_.last().features.at(0).center.x > 80; }));
  const WindFeatures moved = features(2);
  expect_at(moved.at(0), {90, 10});
  EXPECT_EQ(moved[0].id, before.at(0).id);
  EXPECT_EQ(moved[0].radius, before[0].radius) << "nothing else has changed";
  EXPECT_EQ(moved[1].center.x, before.at(1).center.x);

  const auto shift_click = [&](const At& at) {
    mouse(QEvent::MouseButtonPress, at, Qt::LeftButton, Qt::ShiftModifier);
    mouse(QEvent::MouseButtonRelease, at, Qt::NoButton, Qt::ShiftModifier);
  };
  shift_click({60, 20});
  EXPECT_TRUE(says("no feature's centre")) << "it has been moved away from there: " << report();
  drag({60, 20}, {80, 20}, 5, Qt::ControlModifier);
  EXPECT_TRUE(says("no feature's centre")) << report();
  EXPECT_EQ(features(2).size(), 2u);
  shift_click({90, 10});
  const WindFeatures left = features(1);
  ASSERT_EQ(left.size(), 1u);
  EXPECT_EQ(left[0].id, before[1].id);
  EXPECT_TRUE(says("removed")) << report();
}

TEST_F(WindTool, TheWheelChangesRadiusAndSpeed) {
  wheel({70, 30}, 2);
  EXPECT_NEAR(get_tool(tool_, "Radius"), 15 * 1.21, 1e-4);
  wheel({70, 30}, -1, Qt::ControlModifier);
  EXPECT_NEAR(get_tool(tool_, "Speed"), 5 / 1.1, 1e-4);
}

TEST_F(WindTool, WhatTheNodeRefusesIsShown) {
  drag({60, 20}, {70, 20}, 5);
  const int used = features(1).at(0).id;
  EditWind::Request other;  // another program takes the next id, and the tool has not heard of it
  other.operation = EditWind::Request::ADD;
  other.kind = EditWind::Request::VORTEX;
  other.id = used + 1;
  other.radius = other.speed = 3;
  window_->run_frames(1);
  EXPECT_TRUE(call<EditWind>("edit_wind", other).success);
  EXPECT_EQ(features(2).size(), 2u);
  click({100, 50});
  EXPECT_EQ(features(3).at(2).id, used + 2) << "it is another one";
  set_tool(tool_, "Node", "/nobody");
  drag({60, 20}, {70, 20}, 5);
  EXPECT_NE(text(tool_, "report").find("/nobody"), std::string::npos) << report();
  EXPECT_EQ(tool_->property("features").toInt(), 0);
}

/// Those of other programs, too, while the tool is in use.
TEST_F(WindTool, TheFeaturesOfTheNodeAreDrawn) {
  const At vortex{60, 20}, jet{90, 10}, turbulence{40, 55};
  const auto draws_cross = [&](const At& at) {
    mouse(QEvent::MouseMove, {-200, 25}, Qt::NoButton);
    window_->run_frames(2);
    std::uint32_t blue = 0;  // of sand a little, of a cross much
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        blue = std::max(blue, window_->pixel(pixel(at).x() + dx, pixel(at).y() + dy) & 0xffu);
    return blue > 0xa0;
  };
  for (const At& at : {vortex, jet, turbulence}) EXPECT_FALSE(draws_cross(at)) << at.x;
  drag(vortex, {72, 20}, 5);
  set_tool(tool_, "Kind", "Jet");
  drag(jet, {110, 40}, 5);
  set_tool(tool_, "Kind", "Turbulence");
  drag(turbulence, {48, 55}, 5);
  features(3);
  for (const At& at : {vortex, jet, turbulence}) EXPECT_TRUE(draws_cross(at)) << at.x;
  mouse(QEvent::MouseMove, {60, 20}, Qt::NoButton);
  window_->run_frames(2);
  save("wind_features");
  set_tool(tool_, "Kind", "Vortex");
  mouse(QEvent::MouseMove, {110, -5}, Qt::NoButton);
  mouse(QEvent::MouseButtonPress, {110, -5}, Qt::LeftButton);
  mouse(QEvent::MouseMove, {118, 1}, Qt::LeftButton);
  window_->run_frames(2);
  save("wind_placing");
  tools().setCurrentTool(tools().addTool("rviz/Interact"));
  for (const At& at : {vortex, jet, turbulence}) EXPECT_FALSE(draws_cross(at)) << "another tool: " << at.x;
}

/// A scenario can give its features no id.
TEST_F(WindTool, WhatHasNoIdIsSeenButKept) {
  MadeUpNode node("/whirls", "terrain");
  node.keyframe(140, 80, [](int, int) { return static_cast<float>(surface); });
  ros::NodeHandle handle;
  const ros::Publisher publisher = handle.advertise<WindFeatureList>("/whirls/wind_features", 1, true);
  WindFeatureList list;
  list.features.resize(1);
  list.features[0].kind = EditWind::Request::VORTEX;
  list.features[0].center.x = 50, list.features[0].center.y = 30, list.features[0].radius = 12;
  publisher.publish(list);
  set_tool(tool_, "Node", "/whirls");
  ASSERT_TRUE(finds_terrain());
  ASSERT_TRUE(window_->run_until([&] { return tool_->property("features").toInt() == 1; }));
  for (const auto modifier : {Qt::ShiftModifier, Qt::ControlModifier}) {
    drag({50, 30}, {60, 30}, 3, modifier);
    EXPECT_TRUE(says("no id")) << report();
  }
  EXPECT_EQ(tool_->property("features").toInt(), 1);
}

/// A point of an arrow's head lies behind its tip.
TEST(WindOutline, ArrowsTurnAndPointAsTheWindDoes) {
  WindFeatureItem vortex;
  vortex.kind = EditWind::Request::VORTEX;
  vortex.center.x = 100;
  vortex.radius = 10;
  for (const double speed : {3.0, -3.0}) {
    vortex.speed = speed;
    int heads = 0;
    for (const auto& line : desert_sim::outline(vortex, 0)) {
      if (line.size() != 3) continue;
      ++heads;
      const double x = line[1].x - 100, y = line[1].y, dx = line[1].x - line[0].x, dy = line[1].y - line[0].y;
      EXPECT_NEAR(std::hypot(x, y), 10, 1e-9);
      EXPECT_GT((x * dy - y * dx) * speed, 0) << "counter-clockwise if it is above 0";
    }
    EXPECT_EQ(heads, 4);
  }
  WindFeatureItem jet;
  jet.kind = EditWind::Request::JET;
  jet.direction_deg = 90;
  jet.radius = 2;
  jet.length = 20;
  for (const double speed : {3.0, -3.0}) {
    jet.speed = speed;
    for (const auto& line : desert_sim::outline(jet, 0)) {
      if (line.size() != 3) continue;
      EXPECT_NEAR(line[1].y, std::copysign(20, speed), 1e-9);
      EXPECT_GT((line[1].y - line[0].y) * speed, 0);
    }
  }
}

TEST(WindOutline, ArrowsOfASinkPointInwards) {
  WindFeatureItem sink;
  sink.kind = EditWind::Request::SINK;
  sink.radius = 10;
  for (const double speed : {3.0, -3.0}) {
    sink.speed = speed;
    int heads = 0;
    for (const auto& line : desert_sim::outline(sink, 0)) {
      if (line.size() != 3) continue;
      ++heads;
      const double dx = line[1].x - line[0].x, dy = line[1].y - line[0].y;
      EXPECT_LT((line[1].x * dx + line[1].y * dy) * speed, 0);
    }
    EXPECT_EQ(heads, 4);
  }
}

TEST(WindOutline, FeaturesComeGoAndMove) {
  WindFeatureItem moving;
  moving.begin = 10;
  moving.end = 20;
  moving.center.x = 5;
  moving.velocity.x = 2;
  moving.velocity.y = -1;
  EXPECT_FALSE(desert_sim::is_there(moving, 9.5));
  EXPECT_TRUE(desert_sim::is_there(moving, 10));
  EXPECT_FALSE(desert_sim::is_there(moving, 20));
  EXPECT_EQ(desert_sim::centre_at(moving, 14).x, 13);
  EXPECT_EQ(desert_sim::centre_at(moving, 14).y, -4);
  desert_sim::put_at(moving, {0, 0}, 14);
  EXPECT_EQ(desert_sim::centre_at(moving, 14).x, 0);
  EXPECT_EQ(desert_sim::centre_at(moving, 15).y, -1);
  moving.end = 0;
  EXPECT_TRUE(desert_sim::is_there(moving, 1e9));
}

TEST(WindOutline, FeaturesFollowTheirPath) {
  WindFeatureItem f;
  f.kind = EditWind::Request::VORTEX;
  f.radius = 10;
  f.path = *desert_sim::path_of("10 0 0; 20 8 0;20.5 8 4");
  ASSERT_EQ(f.path.size(), 3u);
  EXPECT_EQ(desert_sim::path_text(f), "10 0 0; 20 8 0; 20.5 8 4");
  const auto expect = [&](double time, double x, double y) {
    SCOPED_TRACE(time);
    EXPECT_NEAR(desert_sim::centre_at(f, time).x, x, 1e-12);
    EXPECT_NEAR(desert_sim::centre_at(f, time).y, y, 1e-12);
  };
  expect(0, 0, 0), expect(15, 4, 0), expect(20.25, 8, 2), expect(99, 8, 4);
  desert_sim::put_at(f, {14, 1}, 15);
  expect(0, 10, 1), expect(15, 14, 1), expect(99, 18, 5);
  const auto request = desert_sim::wind_request("change", f);
  EXPECT_EQ(request.path, f.path);
  EXPECT_EQ(request.center.x, 0);
  WindFeatures list(1);
  desert_sim::apply_to(list, request);
  EXPECT_EQ(list[0].path, f.path);
  EXPECT_TRUE(desert_sim::path_of(" ")->empty());
  for (const char* wrong : {"1 2", "1 2 3 4", "1 2 x", "1 2 3; 4", "1 2 3;;4 5 6"})
    EXPECT_FALSE(desert_sim::path_of(wrong)) << wrong;
}

TEST(WindOutline, FreeIdsAreNotGivenTwice) {
  WindFeatures there(2);
  there[0].id = 4;
  there[1].id = std::numeric_limits<int>::max();
  EXPECT_EQ(desert_sim::free_id(there, 0), 1);
  EXPECT_EQ(desert_sim::free_id(there, 3), 5);
  EXPECT_EQ(desert_sim::free_id(there, std::numeric_limits<int>::max() - 1), 1) << "it begins anew";
}

}  // namespace
}  // namespace rviz_test
