// The tool desert_sim/Ruler in rviz.

#include <cmath>
#include <cstdio>
#include <limits>

#include "test/src/rviz/made_up_node.hpp"
#include "test/src/rviz/tool_fixture.hpp"

namespace rviz_test {
namespace {

constexpr double pi = 3.14159265358979323846;

TEST_F(RvizTools, TheRulerMeasures) {
  rviz::Tool* const ruler = use("desert_sim/Ruler");
  const auto measured = [&] { return text(ruler, "text"); };
  ASSERT_TRUE(window_->run_until([&] {  // two clicks, and what a third one would end
    click({100, 40});
    mouse(QEvent::MouseMove, {60, 10}, Qt::NoButton);
    return !measured().empty();
  }));
  double horizontal = 0, along = 0, height = 0, slope = 0;
  const auto read = [&] {
    return std::sscanf(measured().c_str(), "%lf m, along the ground %lf m\nheight %lf m, slope %lf",
                       &horizontal, &along, &height, &slope);
  };
  ASSERT_EQ(read(), 4) << measured();
  EXPECT_NEAR(horizontal, 50, 0.3);
  EXPECT_NEAR(along, 50, 0.3);
  EXPECT_NEAR(height, 0, 0.01);
  mouse(QEvent::MouseMove, {126, -10}, Qt::NoButton);  // on the marker of sand, 5.5 m above the plain
  ASSERT_EQ(read(), 4) << measured();
  EXPECT_NEAR(horizontal, std::hypot(26, 50), 0.5);
  EXPECT_NEAR(height, 5.5, 0.6);
  EXPECT_GT(along, horizontal);
  EXPECT_NEAR(slope, std::atan2(height, horizontal) * 180 / pi, 0.1);
  window_->run_frames(1);
  save("ruler");
  click({126, -10});
  const std::string ended = measured();
  mouse(QEvent::MouseMove, {60, 10}, Qt::NoButton);
  EXPECT_EQ(measured(), ended) << "the second click holds it";
}

/// It can never say how high unknown ground is.
TEST_F(RvizTools, TheRulerSaysWhereNoGroundIsKnown) {
  const float unknown = std::numeric_limits<float>::quiet_NaN();
  const auto flat = [](int, int) { return static_cast<float>(surface); };
  MadeUpNode node("/holes", "terrain");
  node.keyframe(140, 80, [&](int x, int y) { return x > 60 && x < 70 ? unknown : flat(x, y); });
  rviz::Tool* const ruler = use("desert_sim/Ruler");
  set_tool(ruler, "Node", "/holes");
  const auto says = [&](const std::string& words) {
    return text(ruler, "text").find(words) != std::string::npos;
  };
  const std::string none_there = "no ground known there", none_between = "the ground is not known all along";
  EXPECT_TRUE(window_->run_until([&] {
    mouse(QEvent::MouseMove, {65, 10}, Qt::NoButton);
    return says(none_there);
  })) << text(ruler, "text");
  click({50, 10});
  mouse(QEvent::MouseMove, {90, 10}, Qt::NoButton);
  EXPECT_TRUE(says("40.00 m, " + none_between)) << text(ruler, "text");
  EXPECT_TRUE(says("height +0.00 m, slope 0.0 deg (0 %)")) << text(ruler, "text");
  mouse(QEvent::MouseMove, {65, 10}, Qt::NoButton);
  EXPECT_TRUE(says(none_there)) << text(ruler, "text");
  click({90, 10});
  node.update(80, 0, 20, 80, [&](int, int) { return unknown; });
  EXPECT_TRUE(window_->run_until([&] { return says(none_there); })) << text(ruler, "text");
  EXPECT_FALSE(says("nan")) << text(ruler, "text");
  node.update(0, 0, 140, 80, [&](int, int) { return unknown; });
  window_->run_frames(3);
  EXPECT_FALSE(says("nan")) << text(ruler, "text");
  node.update(0, 0, 140, 80, flat);
  EXPECT_TRUE(window_->run_until([&] { return says("along the ground 40.0"); })) << text(ruler, "text");
}

}  // namespace
}  // namespace rviz_test
