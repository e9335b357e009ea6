// The tool desert_sim/Ruler in rviz.

#include <cmath>
#include <cstdio>

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

}  // namespace
}  // namespace rviz_test
