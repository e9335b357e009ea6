// How often the tool desert_sim/Brush calls its node.

#include "test/src/rviz/tool_fixture.hpp"

namespace rviz_test {
namespace {

TEST_F(RvizTools, APressIsSentAtASaneRate) {
  rviz::Tool* const brush = use_brush();
  const qulonglong start = calls(brush);
  const ros::WallTime begin = ros::WallTime::now();
  mouse(QEvent::MouseMove, {20, 0}, Qt::NoButton);
  mouse(QEvent::MouseButtonPress, {20, 0}, Qt::LeftButton);
  for (int n = 1; n <= 200; ++n) {
    mouse(QEvent::MouseMove, {20 + 0.5 * n, 0}, Qt::LeftButton);
    window_->run_frames(1);
  }
  mouse(QEvent::MouseButtonRelease, {120, 0}, Qt::NoButton);
  wait_for(brush);
  const double seconds = (ros::WallTime::now() - begin).toSec();
  EXPECT_LE(static_cast<double>(calls(brush) - start), 50 * seconds + 2);
}

}  // namespace
}  // namespace rviz_test
