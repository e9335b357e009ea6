// The tool desert_sim/Brush with nodes that are slow, that hang, and that have plants.

#include <desert_sim/EditTerrain.h>
#include <desert_sim/Undo.h>
#include <ros/callback_queue.h>

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <limits>
#include <mutex>

#include "test/src/rviz/made_up_node.hpp"
#include "test/src/rviz/tool_fixture.hpp"

namespace rviz_test {
namespace {

using desert_sim::EditTerrain;

/// A node with a flat terrain that remembers the edits that it was asked for. While it is held, it answers
/// none.
class EditedNode {
 public:
  explicit EditedNode(const std::string& name, bool held = false) : node_(name, "terrain"), held_(held) {
    node_.keyframe(140, 80, [](int, int) { return static_cast<float>(surface); });
    handle_.setCallbackQueue(&queue_);  // rviz serves the global one
    service_ = handle_.advertiseService(name + "/edit_terrain", &EditedNode::edit, this);
    undo_ = handle_.advertiseService(name + "/undo", &EditedNode::undo, this);
    spinner_.start();
  }
  /// Waits for edits that are being answered: roscpp does not.
  ~EditedNode() {
    release();
    spinner_.stop();
  }
  EditedNode(const EditedNode&) = delete;
  EditedNode& operator=(const EditedNode&) = delete;

  void release() {
    const std::lock_guard<std::mutex> lock(mutex_);
    held_ = false;
    released_.notify_all();
  }
  std::vector<EditTerrain::Request> edits() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return edits_;
  }
  /// Edits that wait for their answers.
  int waiting() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return waiting_;
  }
  int most_at_once() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return most_at_once_;
  }

 private:
  /// Some of it has gone.
  bool undo(desert_sim::Undo::Request&, desert_sim::Undo::Response& response) {
    response.success = true;
    response.materials.resize(2);
    response.materials[0].material = "soil";
    response.materials[1].material = "sand";
    response.materials[1].missing = 2.5;
    response.missing_plants = 3;
    response.undoable = 4;
    return true;
  }
  bool edit(EditTerrain::Request& request, EditTerrain::Response& response) {
    std::unique_lock<std::mutex> lock(mutex_);
    most_at_once_ = std::max(most_at_once_, ++waiting_);
    edits_.push_back(request);
    released_.wait(lock, [this] { return !held_; });
    --waiting_;
    response.success = true;
    return true;
  }

  MadeUpNode node_;
  mutable std::mutex mutex_;  ///< guards the following members
  std::condition_variable released_;
  bool held_;
  int waiting_ = 0, most_at_once_ = 0;
  std::vector<EditTerrain::Request> edits_;
  ros::CallbackQueue queue_;
  ros::NodeHandle handle_;
  ros::ServiceServer service_, undo_;
  ros::AsyncSpinner spinner_{2, &queue_};  // two edits at once would be seen
};

/// If an event of the mouse waited for a call, this would not end: the node answers the first call after the
/// stroke.
TEST_F(RvizTools, ALaggingNodeLosesNothingAndHoldsNothingUp) {
  EditedNode node("/slow", true);
  rviz::Tool* const brush = use_brush("/slow");
  std::vector<At> path;
  for (int n = 0; n <= 200; ++n) path.push_back({20 + 0.5 * n, 30 + 20 * std::sin(0.03 * n)});
  mouse(QEvent::MouseButtonPress, path.front(), Qt::LeftButton);
  for (std::size_t n = 0; n < path.size(); ++n) {
    mouse(QEvent::MouseMove, path[n], Qt::LeftButton);
    if (n == path.size() / 4) {
      EXPECT_TRUE(window_->run_until([&] { return node.waiting() == 1; })) << "it does not wait for the end";
    }
  }
  mouse(QEvent::MouseButtonRelease, path.back(), Qt::NoButton);
  EXPECT_EQ(node.waiting(), 1);
  node.release();
  wait_for(brush);

  const std::vector<EditTerrain::Request> edits = node.edits();
  EXPECT_EQ(node.most_at_once(), 1);
  double length = 0;
  for (std::size_t n = 1; n < path.size(); ++n)
    length += std::hypot(path[n].x - path[n - 1].x, path[n].y - path[n - 1].y);
  EXPECT_NEAR(static_cast<double>(edits.size()), length / 2.5, 4)
      << "half a radius each, however slow it was";
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

TEST_F(RvizTools, TheStatusBarSaysWhatAnUndoCouldNotBringBack) {
  EditedNode node("/forgetful");
  rviz::Tool* const brush = use_brush("/forgetful");
  QString status_bar;
  const auto connection = QObject::connect(&window_->manager(), &rviz::VisualizationManager::statusUpdate,
                                           [&](const QString& message) { status_bar = message; });
  key(Qt::Key_Z);
  wait_for(brush);
  QObject::disconnect(connection);
  const std::string said = status_bar.toStdString();
  EXPECT_NE(
      said.find("Undone, missing, because they have moved on: 2.5 m³ of sand, 3 plants; 4 can be undone"),
      std::string::npos)
      << said;
  EXPECT_EQ(said.find("soil"), std::string::npos) << said;
}

TEST_F(RvizTools, ASlowNodeGetsTheSamePieces) {
  std::vector<std::size_t> counts;
  for (const bool slow : {false, true}) {
    EditedNode node("/pieces", slow);
    rviz::Tool* const brush = use_brush("/pieces");
    drag({30, 10}, {110, 60}, 100);
    if (slow) node.release();
    wait_for(brush);
    const std::vector<EditTerrain::Request> edits = node.edits();
    counts.push_back(edits.size());
    for (std::size_t n = 0; n + 1 < edits.size(); ++n)
      EXPECT_NEAR(std::hypot(edits[n].points[1].x - edits[n].points[0].x,
                             edits[n].points[1].y - edits[n].points[0].y),
                  2.5, 1e-6)
          << n;
  }
  EXPECT_EQ(counts[0], counts[1]);
  EXPECT_NEAR(static_cast<double>(counts[0]), std::hypot(80, 50) / 2.5, 2);
}

/// It hangs as long as this test lasts.
TEST_F(RvizTools, ANodeThatHangsDoesNotHoldUpRviz) {
  EditedNode node("/hangs", true);
  use_brush("/hangs");
  drag({30, 20}, {60, 20}, 10);
  ASSERT_TRUE(window_->run_until([&] { return node.waiting() == 1; }));
  window_->run_frames(10);
  tools().removeAll();  // as when rviz is closed
  EXPECT_EQ(node.waiting(), 1);
}

TEST_F(RvizTools, StrokesHaveTheirOwnNames) {
  EditedNode node("/names");
  rviz::Tool* const brush = use_brush("/names");
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
  drag({15, 20}, {45, 28}, 20, Qt::NoModifier, 4);
  wait_for(brush);
  const std::string planted = hash();
  EXPECT_NE(planted, empty) << text(brush, "report");
  int plants = 0;
  ASSERT_EQ(std::sscanf(text(brush, "report").c_str(), "%d plants", &plants), 1) << text(brush, "report");
  EXPECT_GT(plants, 20);
  EXPECT_LT(plants, 1.5 * 0.3 * 2 * 5 * 31) << "a pass puts about the density on its width";
  drag({15, 20}, {45, 28}, 20, Qt::ShiftModifier, 4);
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
