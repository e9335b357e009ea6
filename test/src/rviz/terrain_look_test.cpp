// What a display desert_sim/Terrain shows on the ground: micro-relief near the camera, two overlays, and the
// colours that a scenario or a user asks for.

#include <desert_sim/Appearance.h>
#include <desert_sim/GetSubmap.h>
#include <desert_sim/WindField.h>
#include <ros/callback_queue.h>
#include <ros/spinner.h>
#include <rviz/properties/status_property.h>

#include <QColor>
#include <atomic>
#include <cmath>
#include <condition_variable>
#include <cstdlib>
#include <mutex>

#include "test/src/rviz/terrain_fixture.hpp"

namespace rviz_test {
namespace {

using rviz::StatusProperty;

float flat(int, int) { return 0; }

void save_picture(Window& window, const std::string& name) {
  if (const char* const folder = std::getenv("DESERT_PICTURES"))
    window.save(std::string(folder) + "/" + name);
}

/// Answers ~get_submap with ripples across the wind, or refuses; in a thread of its own, so that an answer
/// can be held back while frames are drawn.
class FineGround {
 public:
  explicit FineGround(const std::string& name) : spinner_(1, &queue_) {
    node_.setCallbackQueue(&queue_);
    service_ = node_.advertiseService(name + "/get_submap", &FineGround::answer, this);
    spinner_.start();
  }
  ~FineGround() {
    hold(false);
    service_.shutdown();
    spinner_.stop();
  }
  void refuse(const std::string& reason) {
    const std::lock_guard<std::mutex> lock(mutex_);
    reason_ = reason;
  }
  /// From now on no answer is given until it is called with false.
  void hold(bool on) {
    const std::lock_guard<std::mutex> lock(mutex_);
    held_ = on;
    changed_.notify_all();
  }
  int calls() const { return calls_; }
  int answers() const { return answers_; }
  double resolution() const { return resolution_; }

 private:
  bool answer(desert_sim::GetSubmapRequest& r, desert_sim::GetSubmapResponse& response) {
    ++calls_;
    resolution_ = r.resolution;
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return !held_; });
    response.success = reason_.empty();
    response.message = reason_;
    response.map.width = static_cast<std::uint32_t>(std::lround(r.length_x / r.resolution));
    response.map.height = static_cast<std::uint32_t>(std::lround(r.length_y / r.resolution));
    response.map.layers.resize(1);
    const double west = r.center.x - 0.5 * r.length_x;
    for (std::uint32_t y = 0; y < response.map.height; ++y)
      for (std::uint32_t x = 0; x < response.map.width; ++x)
        response.map.layers[0].data.push_back(
            0.05f * static_cast<float>(std::sin(8 * (west + (x + 0.5) * r.resolution))));
    ++answers_;
    return true;
  }

  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  ros::ServiceServer service_;
  std::mutex mutex_;  ///< guards the next two
  std::string reason_;
  bool held_ = false;
  std::condition_variable changed_;
  std::atomic<int> calls_{0}, answers_{0};
  std::atomic<double> resolution_{0};
  ros::AsyncSpinner spinner_;
};

TEST_F(TerrainDisplay, MicroReliefIsAShapeNearTheCamera) {
  MadeUpNode node("/fine");
  FineGround fine("/fine");
  rviz::Display* const display = show(node, "/fine", 128, flat);
  window_->run_frames(3);
  EXPECT_EQ(number(display, "near_triangles"), 0) << "from afar";
  EXPECT_EQ(fine.calls(), 0);
  window_->look_from_above(40, 40, 60);
  ASSERT_TRUE(window_->run_until([&] { return number(display, "near_triangles") > 0; }))
      << status(display, "Micro Relief").text;
  EXPECT_NEAR(fine.resolution(), 4.0 / 60, 0.01) << "four pixels";
  EXPECT_GT(number(display, "near_triangles"), 2 * 100 * 100);
  EXPECT_TRUE(settles(display));
  EXPECT_GT(window_->colours(), 20u) << "slopes of ripples have different light";
  save_picture(*window_, "micro_relief.png");
  EXPECT_TRUE(
      window_->run_until([&] { return status(display, "Micro Relief").level == StatusProperty::Ok; }));

  const int calls = fine.calls();
  window_->run_frames(20);
  EXPECT_EQ(fine.calls(), calls) << "nothing has changed";
  node.update(0, 0, 4, 4, [](int, int) { return 0.5f; });
  EXPECT_TRUE(window_->run_until([&] { return fine.calls() > calls; })) << "the terrain has changed";

  window_->look_at(128);
  EXPECT_TRUE(window_->run_until([&] { return number(display, "near_triangles") == 0; }));
  EXPECT_TRUE(settles(display));
  window_->look_from_above(40, 40, 60);
  EXPECT_TRUE(window_->run_until([&] { return number(display, "near_triangles") > 0; }));
  set(display, {"Micro Relief"}, false);
  EXPECT_TRUE(window_->run_until([&] { return number(display, "near_triangles") == 0; }));
}

TEST_F(TerrainDisplay, WhyThereIsNoMicroReliefIsAStatus) {
  MadeUpNode node("/coarse");
  FineGround fine("/coarse");
  fine.refuse("resolution: it is too warm today");
  rviz::Display* const display = show(node, "/coarse", 64, flat);
  window_->look_from_above(30, 30, 60);
  EXPECT_TRUE(
      window_->run_until([&] { return status(display, "Micro Relief").level == StatusProperty::Warn; }));
  EXPECT_EQ(status(display, "Micro Relief").text, "resolution: it is too warm today");
  EXPECT_GT(number(display, "triangles"), 0) << "the ground stays";
  fine.refuse("");
  EXPECT_TRUE(window_->run_until([&] { return number(display, "near_triangles") > 0; }));
  EXPECT_TRUE(
      window_->run_until([&] { return status(display, "Micro Relief").level == StatusProperty::Ok; }));
}

// Fine ground of the terrain before does not fit into the grid of another one.
TEST_F(TerrainDisplay, MicroReliefOfATerrainBeforeIsDroppedHoweverLateItComes) {
  MadeUpNode node("/replaced");
  FineGround fine("/replaced");
  rviz::Display* const display = show(node, "/replaced", 128, flat);
  window_->look_from_above(100, 100, 60);
  EXPECT_TRUE(window_->run_until([&] { return number(display, "near_triangles") > 0; }));
  fine.hold(true);
  const int calls = fine.calls(), answers = fine.answers();
  node.update(0, 0, 4, 4, [](int, int) { return 0.5f; });
  EXPECT_TRUE(window_->run_until([&] { return fine.calls() > calls; })) << "the ground has changed";
  node.keyframe(32, 32, flat);
  EXPECT_TRUE(window_->run_until([&] {
    return status(display, "Terrain").text.find("32 x 32") != std::string::npos;
  })) << status(display, "Terrain").text;
  EXPECT_EQ(number(display, "near_triangles"), 0);
  fine.hold(false);
  EXPECT_TRUE(window_->run_until([&] { return fine.answers() > answers; }));
  window_->run_frames(30);
  EXPECT_EQ(number(display, "near_triangles"), 0);
}

/// The colour in the middle of the picture.
QColor middle(Window& window) { return QColor(window.pixel(320, 240)); }

TEST_F(TerrainDisplay, ColoursAreTheScenariosOrTheUsers) {
  MadeUpNode node("/coloured");
  ros::NodeHandle handle;
  const ros::Publisher publisher = handle.advertise<desert_sim::Appearance>("/coloured/appearance", 1, true);
  ros::Publisher wind = handle.advertise<desert_sim::WindField>("/coloured/wind", 1);
  desert_sim::Appearance appearance;
  appearance.sand.r = 1;
  publisher.publish(appearance);
  rviz::Display* const display = show(node, "/coloured", 64, flat);
  window_->look_from_above(32, 32, 10);
  EXPECT_TRUE(window_->run_until([&] { return middle(*window_).red() > 200; }));
  EXPECT_LT(middle(*window_).blue(), 20);
  EXPECT_EQ(wind.getNumSubscribers(), 0u);

  set(display, {"Materials", "Scenario Colours"}, false);
  set(display, {"Materials", "Scenario Colours", "Sand"}, QColor(0, 0, 255));
  EXPECT_TRUE(window_->run_until([&] { return middle(*window_).blue() > 200; }));
  appearance.sand.r = 0;
  appearance.sand.g = 1;
  appearance.wind_arrows = true;
  publisher.publish(appearance);
  EXPECT_TRUE(window_->run_until([&] { return wind.getNumSubscribers() > 0; })) << "its wind is to be seen";
  EXPECT_GT(middle(*window_).blue(), 200) << "the user's colours stay";
  set(display, {"Materials", "Scenario Colours"}, true);
  EXPECT_TRUE(window_->run_until([&] { return middle(*window_).green() > 200; }));
}

TEST_F(TerrainDisplay, TwoOverlaysStandSideBySide) {
  MadeUpNode node("/twice");
  rviz::Display* const display =
      show(node, "/twice", 64, [](int x, int) { return 0.2f * static_cast<float>(x); });
  window_->look_from_above(32, 32, 7);
  set(display, {"Overlay"}, "slope");
  set(display, {"Overlay", "Opacity"}, 1);
  set(display, {"Second Overlay"}, "elevation");
  set(display, {"Second Overlay", "Opacity"}, 1);
  set(display, {"Second Overlay", "Side by Side"}, true);
  const auto at = [&](int column) { return window_->pixel(column, 240); };
  EXPECT_TRUE(settles(display));
  EXPECT_EQ(at(200), at(260)) << "the slope is the same in the west";
  EXPECT_NE(at(380), at(440)) << "the elevation is not in the east";
  save_picture(*window_, "two_overlays.png");
  set(display, {"Second Overlay", "Side by Side"}, false);
  EXPECT_TRUE(settles(display));
  EXPECT_NE(at(200), at(260)) << "the second one lies on the first one";
  window_->run_frames(2);
  EXPECT_EQ(status(display, "Second Overlay").level, StatusProperty::Ok);
}

}  // namespace
}  // namespace rviz_test
