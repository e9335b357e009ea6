// How long the display desert_sim/Terrain keeps rviz from its next frame.

#include <algorithm>
#include <cstdio>
#include <thread>

#include "test/src/rviz/terrain_fixture.hpp"

namespace rviz_test {
namespace {

// (1) Big maps stall rviz.
TEST_F(TerrainDisplay, Complaint1ALargeKeyframeTakesNoFrameMoreThan20Milliseconds) {
  MadeUpNode node("/large");
  rviz::Display* const display = show(node, "/large", 256);
  std::vector<double> milliseconds;
  window_->for_each_frame([&] { milliseconds.push_back(number(display, "frame_milliseconds")); });
  std::thread sender([&] { node.keyframe(2048, 2048, dunes); });  // rviz goes on drawing meanwhile
  EXPECT_TRUE(settles(display, [&] { return number(display, "blocks") == 256; }));
  sender.join();
  window_->run_frames(1);
  ASSERT_FALSE(milliseconds.empty());
  const double most = *std::max_element(milliseconds.begin(), milliseconds.end());
  std::printf("longest frame: %.1f ms of our work, of %zu\n", most, milliseconds.size());
  EXPECT_LE(most, 20);
}

}  // namespace
}  // namespace rviz_test

int main(int argc, char** argv) {
  return rviz_test::run_terrain_tests(argc, argv, "terrain_display_timing_test");
}
