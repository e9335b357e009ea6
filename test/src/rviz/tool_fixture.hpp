#pragma once
/// Tools of rviz on a screen of Xvfb, with a mouse of Qt events. The terrain is that of a real, paused
/// node, /desert_sim, with the scenario corner.yaml: 64 × 48 cells of 2 m, corner at (10, −20), half a
/// metre of sand on rock at 1 m, so that its surface is at 1.5 m.

#include <gtest/gtest.h>
#include <rviz/tool.h>
#include <rviz/tool_manager.h>

#include <QMouseEvent>
#include <string>
#include <vector>

#include "test/src/rviz/rviz_window.hpp"
#include "test/support/ros/service_tests.hpp"

namespace rviz_test {

using node_test::call;
using node_test::hash;

constexpr int columns = 64, rows = 48;
constexpr double cell = 2, west = 10, south = -20, surface = 1.5;

struct At {
  double x, y;
};

double distance_to_segment(const At& p, const At& a, const At& b);
At centre(int x, int y);
/// Loads one of test/support/ros/scenarios.
void load(const std::string& scenario);
/// All cells of a layer of the node, row-major.
std::vector<float> layer(const std::string& name);
float at(const std::vector<float>& values, const At& place);

/// Each test begins with the scenario's start, a view from above of all of it, and a display of it.
class RvizTools : public testing::Test {
 public:
  /// The window, after all suites: rviz is started once.
  static void close();

 protected:
  static void SetUpTestSuite();
  void SetUp() override;
  void TearDown() override;

  static rviz::ToolManager& tools() { return *window_->manager().getToolManager(); }
  /// A new tool, in use, when the terrain is shown.
  rviz::Tool* use(const char* name);
  /// A brush that has found the terrain of this node.
  rviz::Tool* use_brush(const char* node = "/desert_sim");

  /// The pixel that shows a point of the fixed frame; by default on the undisturbed surface.
  static QPoint pixel(const At& at, double z = surface);
  static void mouse(QEvent::Type type, const At& at, Qt::MouseButtons down,
                    Qt::KeyboardModifiers modifiers = Qt::NoModifier, double z = surface);
  static void wheel(const At& at, int notches, Qt::KeyboardModifiers modifiers = Qt::NoModifier);
  static void key(int code, Qt::KeyboardModifiers modifiers = Qt::NoModifier);
  /// Press, so many moves, release. rviz goes on drawing meanwhile if it can: what is painted while a call is
  /// under way, and how many calls there are, depends on the machine.
  static void drag(const At& from, const At& to, int moves, Qt::KeyboardModifiers modifiers = Qt::NoModifier,
                   double z = surface);
  static void click(const At& at);
  /// Until the brush has nothing more to send.
  static void wait_for(rviz::Tool* brush);

  static void set_tool(rviz::Tool* tool, const char* name, const QVariant& value);
  static double get_tool(rviz::Tool* tool, const char* name);
  static std::string text(rviz::Tool* tool, const char* name);
  static qulonglong calls(rviz::Tool* brush) { return brush->property("calls").toULongLong(); }
  /// Writes the picture to the folder that the environment's variable DESERT_PICTURES names, if it names one.
  static void save(const std::string& name);

  /// Exactly the cells within `radius` of the line have changed; `slack` for the size of a pixel.
  static void expect_changed(const std::vector<float>& before, const std::vector<float>& after,
                             const At& from, const At& to, double radius, double slack = 0.5);

  static Screen* screen_;
  static Window* window_;
  rviz::Display* display_ = nullptr;
};

}  // namespace rviz_test
