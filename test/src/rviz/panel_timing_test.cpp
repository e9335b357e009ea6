// The panel desert_sim/Panel never keeps Qt waiting.

#include <algorithm>
#include <csignal>

#include "test/src/rviz/panel_fixture.hpp"

namespace rviz_test {
namespace {

/// The longest time that Qt was not served while the condition was waited for [s].
double longest_stall(const PanelWindow& window, const std::function<bool()>& condition) {
  double longest = 0;
  ros::WallTime last = ros::WallTime::now();
  EXPECT_TRUE(window.run_until([&] {
    longest = std::max(longest, (ros::WallTime::now() - last).toSec());
    last = ros::WallTime::now();
    return condition();
  }));
  return longest;
}

TEST_F(Panel, GoesOnWhileItLooksForANodeThatHasVanished) {
  node_->end(SIGKILL);
  EXPECT_LT(longest_stall(*window_, [&] { return window_->text("state") == "/panel_node is not there"; }),
            0.5);
}

TEST_F(Panel, GoesOnWhileANodeHangs) {
  node_->hold();
  window_->click("step");
  window_->click("reset");
  const ros::WallTime begin = ros::WallTime::now();
  const auto passed = [&begin] { return (ros::WallTime::now() - begin).toSec(); };
  EXPECT_LT(longest_stall(*window_, [&] { return passed() > 1.5; }), 0.5);
  EXPECT_EQ(window_->text("run_error"), "reset ...");
  window_.reset();
  EXPECT_LT(passed(), 10) << "also at its end";
  node_->release();
}

}  // namespace
}  // namespace rviz_test

int main(int argc, char** argv) { return rviz_test::run_panel_tests(argc, argv, "panel_timing_test"); }
