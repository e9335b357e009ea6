// The tool desert_sim/Brush with nodes that are slow, that hang, and that have plants.

#include <desert_sim/EditTerrain.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>

#include "test/src/rviz/made_up_node.hpp"
#include "test/src/rviz/tool_fixture.hpp"

namespace rviz_test {
namespace {

using desert_sim::EditTerrain;

/// A node with a flat terrain whose edits take so long [s], and that remembers them.
class SlowNode {
 public:
  SlowNode(const std::string& name, double seconds) : node_(name, "terrain"), seconds_(seconds) {
    node_.keyframe(140, 80, [](int, int) { return static_cast<float>(surface); });
    service_ = ros::NodeHandle().advertiseService(name + "/edit_terrain", &SlowNode::edit, this);
  }
  ~SlowNode() { released_ = true; }

  std::vector<EditTerrain::Request> edits() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return edits_;
  }
  int most_at_once() const { return most_at_once_; }

 private:
  bool edit(EditTerrain::Request& request, EditTerrain::Response& response) {
    most_at_once_ = std::max<int>(most_at_once_, ++at_once_);
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      edits_.push_back(request);
    }
    const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(seconds_);
    while (!released_ && ros::WallTime::now() < end) ros::WallDuration(0.01).sleep();
    --at_once_;
    response.success = true;
    return true;
  }

  MadeUpNode node_;
  const double seconds_;
  std::atomic<int> at_once_{0}, most_at_once_{0};
  std::atomic<bool> released_{false};
  mutable std::mutex mutex_;
  std::vector<EditTerrain::Request> edits_;
  ros::ServiceServer service_;
};

TEST_F(RvizTools, ALaggingNodeLosesNothingAndHoldsNothingUp) {
  SlowNode node("/slow", 0.4);
  rviz::Tool* const brush = use_brush();
  set_tool(brush, "Node", "/slow");
  ASSERT_TRUE(window_->run_until([&] {
    mouse(QEvent::MouseMove, {70, 30}, Qt::NoButton);
    return brush->property("over_terrain").toBool();
  }));
  std::vector<At> path;
  for (int n = 0; n <= 200; ++n) path.push_back({20 + 0.5 * n, 30 + 20 * std::sin(0.03 * n)});
  mouse(QEvent::MouseButtonPress, path.front(), Qt::LeftButton);
  double longest = 0;
  for (const At& place : path) {
    const ros::WallTime begin = ros::WallTime::now();
    mouse(QEvent::MouseMove, place, Qt::LeftButton);
    longest = std::max(longest, (ros::WallTime::now() - begin).toSec());
    window_->run(0.01);
  }
  mouse(QEvent::MouseButtonRelease, path.back(), Qt::NoButton);
  EXPECT_LT(longest, 0.2) << "no event of the mouse waits for a call";
  wait_for(brush);

  const std::vector<EditTerrain::Request> edits = node.edits();
  EXPECT_EQ(node.most_at_once(), 1);
  EXPECT_GE(edits.size(), 3u);
  EXPECT_LE(edits.size(), 14u) << "200 places";
  for (std::size_t n = 0; n < edits.size(); ++n) {
    EXPECT_EQ(edits[n].shape, "capsule");
    EXPECT_EQ(edits[n].stroke, edits[0].stroke);
    ASSERT_EQ(edits[n].points.size(), 2u);
    if (n > 0) {
      EXPECT_EQ(edits[n].points[0].x, edits[n - 1].points[1].x);
      EXPECT_EQ(edits[n].points[0].y, edits[n - 1].points[1].y);
    }
  }
  for (const At& place : path) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const EditTerrain::Request& edit : edits)
      nearest = std::min(nearest, distance_to_segment(place, {edit.points[0].x, edit.points[0].y},
                                                      {edit.points[1].x, edit.points[1].y}));
    EXPECT_LT(nearest, 5.0 / 8 + 0.3) << "an eighth of the radius, and the size of a pixel";
  }
}

TEST_F(RvizTools, ANodeThatHangsDoesNotHoldUpRviz) {
  SlowNode node("/hangs", 1000);
  rviz::Tool* const brush = use_brush();
  set_tool(brush, "Node", "/hangs");
  ASSERT_TRUE(window_->run_until([&] {
    mouse(QEvent::MouseMove, {70, 30}, Qt::NoButton);
    return brush->property("over_terrain").toBool();
  }));
  drag({30, 20}, {60, 20}, 10, 0.01);
  ASSERT_TRUE(window_->run_until([&] { return node.most_at_once() == 1; }));
  const std::uint64_t frames = window_->frames();
  window_->run(1);
  EXPECT_GT(window_->frames(), frames + 5);
  const ros::WallTime begin = ros::WallTime::now();
  tools().removeAll();
  EXPECT_LT((ros::WallTime::now() - begin).toSec(), 2) << "closing rviz does not wait for the node";
}

TEST_F(RvizTools, StrokesHaveTheirOwnNames) {
  SlowNode node("/names", 0);
  rviz::Tool* const brush = use_brush();
  set_tool(brush, "Node", "/names");
  ASSERT_TRUE(window_->run_until([&] {
    mouse(QEvent::MouseMove, {70, 30}, Qt::NoButton);
    return brush->property("over_terrain").toBool();
  }));
  for (int n = 0; n < 3; ++n) click({30.0 + 10 * n, 20});
  wait_for(brush);
  const std::vector<EditTerrain::Request> edits = node.edits();
  ASSERT_EQ(edits.size(), 3u);
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_EQ(edits[n].shape, "circle");
    EXPECT_NEAR(edits[n].center.x, 30.0 + 10 * static_cast<double>(n), 0.2);
    EXPECT_NE(edits[n].stroke, edits[(n + 1) % 3].stroke);
    EXPECT_FALSE(edits[n].stroke.empty());
  }
}

TEST_F(RvizTools, PlantsArePutAndCleared) {
  load("garden.yaml");
  window_->look_from_above(32, 24, 10);
  rviz::Tool* const brush = use("desert_sim/Brush");
  EXPECT_TRUE(window_->run_until([&] {
    mouse(QEvent::MouseMove, {32, 24}, Qt::NoButton, Qt::NoModifier, 4);
    return brush->property("over_terrain").toBool();
  }));
  const std::string empty = hash();
  set_tool(brush, "Material", "Plants");
  set_tool(brush, "Species", "bush");
  set_tool(brush, "Plant Density", 0.3);
  drag({15, 20}, {45, 28}, 20, 0.02, Qt::NoModifier, 4);
  wait_for(brush);
  const std::string planted = hash();
  EXPECT_NE(planted, empty) << text(brush, "report");
  int plants = 0;
  ASSERT_EQ(std::sscanf(text(brush, "report").c_str(), "%d plants", &plants), 1) << text(brush, "report");
  EXPECT_GT(plants, 20);
  EXPECT_LT(plants, 1.5 * 0.3 * 2 * 5 * 31) << "a pass puts about the density on its width";
  drag({15, 20}, {45, 28}, 20, 0.02, Qt::ShiftModifier, 4);
  wait_for(brush);
  int cleared = 0;
  ASSERT_EQ(std::sscanf(text(brush, "report").c_str(), "%d plants", &cleared), 1) << text(brush, "report");
  EXPECT_NEAR(cleared, -plants, 3) << "but those at the edge, by the size of a pixel";
  key(Qt::Key_Z);
  wait_for(brush);
  EXPECT_EQ(hash(), planted);
  key(Qt::Key_Z);
  wait_for(brush);
  EXPECT_EQ(hash(), empty);
}

}  // namespace
}  // namespace rviz_test
