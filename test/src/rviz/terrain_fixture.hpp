#pragma once
/// Displays desert_sim/Terrain of terrains that a test makes up.

#include <gtest/gtest.h>
#include <ros/ros.h>

#include "test/src/rviz/made_up_node.hpp"
#include "test/src/rviz/rviz_window.hpp"

namespace rviz_test {

inline double number(rviz::Display* display, const char* name) { return display->property(name).toDouble(); }

class TerrainDisplay : public testing::Test {
 protected:
  /// OGRE and rviz know one window in the life of a process.
  static void SetUpTestSuite() {
    screen_ = new Screen;
    if (!screen_->problem().empty()) return;
    static int argument_count = 1;
    static char name[] = "terrain_display_test";
    static char* arguments[] = {name, nullptr};
    new QApplication(argument_count, arguments);
    window_ = new Window(640, 480);
  }
  static void TearDownTestSuite() {
    delete window_;
    delete qApp;
    delete screen_;
  }
  void SetUp() override {
    if (!window_) GTEST_SKIP() << screen_->problem();
    window_->set_fixed_frame("map");  // a terrain in that frame needs no transform
  }
  void TearDown() override {
    if (!window_) return;
    window_->for_each_frame(nullptr);
    window_->manager().removeAllDisplays();
  }

  /// A display that shows all of a made-up terrain, and receives its updates.
  rviz::Display* show(MadeUpNode& node, const std::string& name, int side, const Height& height = dunes) {
    rviz::Display* const display = window_->add_terrain(name + "/elevation");
    set(display, {"Materials"}, false);
    set(display, {"Water"}, false);
    set(display, {"Plants"}, false);
    set(display, {"Sky"}, false);
    window_->look_at(side);
    node.keyframe(side, side, height);
    EXPECT_TRUE(settles(display, [&] { return node.has_subscribers(); })) << status(display, "Topic").text;
    return display;
  }
  /// Waits until `also` holds and the display shows all blocks at the levels that it keeps. A frame chooses
  /// levels anew, from those of the frame before: only one that builds nothing shows that they stay.
  static bool settles(
      rviz::Display* display, const std::function<bool()>& also = [] { return true; }) {
    return window_->run_until([&] {
      if (!also() || !is_ready(display)) return false;
      const double built = number(display, "built_blocks");
      window_->run_frames(1);
      return is_ready(display) && number(display, "built_blocks") == built;
    });
  }
  static bool is_ready(rviz::Display* display) {
    return number(display, "blocks") > 0 && number(display, "waiting_blocks") == 0 &&
           number(display, "triangles") > 0;
  }

  static inline Screen* screen_ = nullptr;
  static inline Window* window_ = nullptr;
};

inline int run_terrain_tests(int argc, char** argv, const char* name) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, name, ros::init_options::NoSigintHandler);
  ros::start();
  const int result = RUN_ALL_TESTS();
  ros::shutdown();
  return result;
}

}  // namespace rviz_test
