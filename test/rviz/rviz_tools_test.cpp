// The tools desert_sim/Brush and desert_sim/Ruler in rviz, on a screen of Xvfb, with a mouse of Qt events. The
// terrain is that of a real, paused node with the scenario corner.yaml: 64 × 48 cells of 2 m, corner at (10, −20), half
// a metre of sand, so that its surface is at 1.5 m.

#include <OgreCamera.h>
#include <desert_sim/GetSubmap.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <rviz/properties/status_property.h>
#include <rviz/tool.h>
#include <rviz/tool_manager.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include <QMouseEvent>
#include <cmath>
#include <cstdlib>

#include "rostest/service_tests.hpp"
#include "rviz/rviz_window.hpp"

namespace rviz_test {
namespace {

using desert_sim::GetSubmap;
using node_test::call;
using node_test::hash;

constexpr int columns = 64, rows = 48;
constexpr double cell = 2, west = 10, south = -20, surface = 1.5;
constexpr double pi = 3.14159265358979323846;

struct At {
  double x, y;
};

double distance(const At& a, const At& b) { return std::hypot(b.x - a.x, b.y - a.y); }

double distance_to_segment(const At& p, const At& a, const At& b) {
  const double dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
  const double s = square > 0 ? std::min(1.0, std::max(0.0, ((p.x - a.x) * dx + (p.y - a.y) * dy) / square)) : 0;
  return distance(p, {a.x + s * dx, a.y + s * dy});
}

At centre(int x, int y) { return {west + cell * (x + 0.5), south + cell * (y + 0.5)}; }

/// All cells of a layer of the node, row-major.
std::vector<float> layer(const std::string& name) {
  GetSubmap::Request request;
  request.center.x = west + columns * cell / 2;
  request.center.y = south + rows * cell / 2;
  request.length_x = columns * cell;
  request.length_y = rows * cell;
  request.layers = {name};
  const GetSubmap::Response answer = call<GetSubmap>("get_submap", request);
  EXPECT_TRUE(answer.success) << answer.message;
  EXPECT_EQ(answer.map.layers.size(), 1u);
  return answer.map.layers.empty() ? std::vector<float>(columns * rows) : answer.map.layers[0].data;
}

class RvizTools : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    screen_ = new Screen;
    if (!screen_->problem().empty()) return;
    static int argument_count = 1;
    static char name[] = "rviz_tools_test";
    static char* arguments[] = {name, nullptr};
    new QApplication(argument_count, arguments);
    window_ = new Window(800, 600);
  }
  static void TearDownTestSuite() {
    delete window_;
    delete qApp;
    delete screen_;
  }
  void SetUp() override {
    if (!window_) GTEST_SKIP() << screen_->problem();
    ASSERT_TRUE(call<std_srvs::Trigger>("reset").success);
    window_->set_fixed_frame("terrain");
    display_ = window_->add_terrain("/desert_sim/elevation");
    window_->look_from_above(west + columns * cell / 2, south + rows * cell / 2, 5);
  }
  void TearDown() override {
    if (!window_) return;
    tools().removeAll();
    window_->manager().removeAllDisplays();
  }

  static rviz::ToolManager& tools() { return *window_->manager().getToolManager(); }
  /// The tool, in use and with the terrain known to it: the mouse at `over` points at the terrain.
  rviz::Tool* use(const char* name) {
    rviz::Tool* const tool = tools().addTool(name);
    tools().setCurrentTool(tool);
    EXPECT_TRUE(window_->run_until([&] { return display_->property("blocks").toDouble() > 0; }));
    EXPECT_TRUE(window_->run_until([&] { return display_->property("waiting_blocks").toDouble() == 0; }));
    return tool;
  }
  rviz::Tool* use_brush() {
    rviz::Tool* const brush = use("desert_sim/Brush");
    EXPECT_TRUE(window_->run_until([&] {
      mouse(QEvent::MouseMove, {70, 30}, Qt::NoButton);
      return brush->property("over_terrain").toBool();
    })) << "the brush finds the terrain";
    return brush;
  }

  /// The pixel that shows a point on the undisturbed surface, or another point of the fixed frame.
  static QPoint pixel(const At& at, double z = surface) {
    Ogre::Camera* const camera = window_->manager().getRenderPanel()->getCamera();
    const Ogre::Vector3 p = camera->getProjectionMatrix() * (camera->getViewMatrix() * Ogre::Vector3(float(at.x), float(at.y), float(z)));
    rviz::RenderPanel& panel = *window_->manager().getRenderPanel();
    return {static_cast<int>(std::lround((0.5 + 0.5 * double(p.x)) * panel.width())),
            static_cast<int>(std::lround((0.5 - 0.5 * double(p.y)) * panel.height()))};
  }
  static void mouse(QEvent::Type type, const At& at, Qt::MouseButtons down,
                    Qt::KeyboardModifiers modifiers = Qt::NoModifier, double z = surface) {
    const Qt::MouseButton acting = type == QEvent::MouseMove ? Qt::NoButton : Qt::LeftButton;
    QMouseEvent event(type, pixel(at, z), acting, down, modifiers);
    QApplication::sendEvent(window_->manager().getRenderPanel(), &event);
  }
  static void wheel(const At& at, int notches, Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
    const QPoint place = pixel(at);
    QWheelEvent event(place, window_->manager().getRenderPanel()->mapToGlobal(place), QPoint(), QPoint(0, 120 * notches),
                      Qt::NoButton, modifiers, Qt::NoScrollPhase, false);
    QApplication::sendEvent(window_->manager().getRenderPanel(), &event);
  }
  static void key(int code, Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
    QKeyEvent event(QEvent::KeyPress, code, modifiers);
    QApplication::sendEvent(window_->manager().getRenderPanel(), &event);
  }
  /// Press, so many moves, release; `pause` between them [s].
  static void drag(const At& from, const At& to, int moves, double pause, Qt::KeyboardModifiers modifiers = Qt::NoModifier,
                   double z = surface) {
    mouse(QEvent::MouseMove, from, Qt::NoButton, modifiers, z);
    mouse(QEvent::MouseButtonPress, from, Qt::LeftButton, modifiers, z);
    for (int n = 1; n <= moves; ++n) {
      const double share = static_cast<double>(n) / moves;
      mouse(QEvent::MouseMove, {from.x + share * (to.x - from.x), from.y + share * (to.y - from.y)}, Qt::LeftButton,
            modifiers, z);
      if (pause > 0) window_->run(pause);
    }
    mouse(QEvent::MouseButtonRelease, to, Qt::NoButton, modifiers, z);
  }
  static void wait_for(rviz::Tool* brush) {
    EXPECT_TRUE(window_->run_until([&] { return brush->property("idle").toBool(); }));
    window_->run(0.05);  // the report is shown in the next frame
  }
  static void set_tool(rviz::Tool* tool, const char* name, const QVariant& value) {
    rviz::Property* const found = property(tool->getPropertyContainer(), {name});
    ASSERT_TRUE(found) << name;
    found->setValue(value);
  }
  static double get_tool(rviz::Tool* tool, const char* name) {
    return property(tool->getPropertyContainer(), {name})->getValue().toDouble();
  }
  static std::string text(rviz::Tool* tool, const char* name) {
    return tool->property(name).toString().toStdString();
  }

  /// Exactly the cells within `radius` of the line have changed; `slack` for the size of a pixel.
  static void expect_changed(const std::vector<float>& before, const std::vector<float>& after, const At& from,
                             const At& to, double radius, double slack = 0.5) {
    for (int y = 0; y < rows; ++y)
      for (int x = 0; x < columns; ++x) {
        const double away = distance_to_segment(centre(x, y), from, to);
        const auto n = static_cast<std::size_t>(y * columns + x);
        if (std::abs(away - radius) < slack) continue;
        EXPECT_EQ(before[n] != after[n], away < radius) << "cell " << x << ", " << y;
      }
  }
  static float at(const std::vector<float>& values, const At& place) {
    const int x = static_cast<int>((place.x - west) / cell), y = static_cast<int>((place.y - south) / cell);
    return values[static_cast<std::size_t>(y * columns + x)];
  }

  static Screen* screen_;
  static Window* window_;
  rviz::Display* display_ = nullptr;
};

Screen* RvizTools::screen_ = nullptr;
Window* RvizTools::window_ = nullptr;

TEST_F(RvizTools, AStrokeChangesTheCellsUnderItAndUndoTakesItBack) {
  rviz::Tool* const brush = use_brush();
  const std::string start = hash();
  const std::vector<float> before = layer("sand_depth");
  const At from{40, 10}, to{90, 40};
  drag(from, to, 25, 0.02);
  wait_for(brush);
  const std::string painted = hash();
  const std::vector<float> after = layer("sand_depth");
  expect_changed(before, after, from, to, 5);
  EXPECT_EQ(layer("bedrock"), std::vector<float>(columns * rows, 1));
  // A pass gives the strength in the middle.
  EXPECT_NEAR(static_cast<double>(at(after, {65, 25}) - at(before, {65, 25})), 0.5, 0.15);
  EXPECT_NE(text(brush, "report").find("sand +"), std::string::npos) << text(brush, "report");
  if (const char* folder = std::getenv("DESERT_PICTURES")) window_->save(std::string(folder) + "/stroke.png");
  key(Qt::Key_Z);
  wait_for(brush);
  EXPECT_EQ(hash(), start) << text(brush, "report");
  key(Qt::Key_Y, Qt::ControlModifier);
  wait_for(brush);
  EXPECT_EQ(hash(), painted);
  key(Qt::Key_Z, Qt::ControlModifier);
  key(Qt::Key_Z, Qt::ControlModifier | Qt::ShiftModifier);
  wait_for(brush);
  EXPECT_EQ(hash(), painted);
}

TEST_F(RvizTools, EveryStrokeIsUndoneByItself) {
  rviz::Tool* const brush = use_brush();
  std::vector<std::string> hashes = {hash()};
  for (const double y : {0.0, 15.0, 30.0}) {
    drag({30, y}, {100, y + 10}, 20, 0.01, y == 15 ? Qt::ShiftModifier : Qt::NoModifier);
    wait_for(brush);
    hashes.push_back(hash());
    EXPECT_NE(hashes.back(), hashes[hashes.size() - 2]);
  }
  EXPECT_LT(at(layer("sand_depth"), {65, 20}), 0.5f) << "shift removes";
  for (int n = 2; n >= 0; --n) {
    key(Qt::Key_Z);
    wait_for(brush);
    EXPECT_EQ(hash(), hashes[static_cast<std::size_t>(n)]);
  }
  key(Qt::Key_Z);
  wait_for(brush);
  EXPECT_NE(text(brush, "report").find("no stroke"), std::string::npos) << text(brush, "report");
}

TEST_F(RvizTools, AFastStrokeIsCompleteAndNeedsFewCalls) {
  rviz::Tool* const brush = use_brush();
  const std::vector<float> before = layer("sand_depth");
  const qulonglong calls = brush->property("calls").toULongLong();
  drag({30, 10}, {110, 60}, 200, 0);  // as fast as events come
  wait_for(brush);
  expect_changed(before, layer("sand_depth"), {30, 10}, {110, 60}, 5);
  EXPECT_LE(brush->property("calls").toULongLong() - calls, 4u);
}

TEST_F(RvizTools, APressIsSentAtASaneRate) {
  rviz::Tool* const brush = use_brush();
  const qulonglong calls = brush->property("calls").toULongLong();
  const ros::WallTime begin = ros::WallTime::now();
  drag({20, 0}, {120, 0}, 200, 0.01);
  wait_for(brush);
  const double seconds = (ros::WallTime::now() - begin).toSec();
  EXPECT_LE(static_cast<double>(brush->property("calls").toULongLong() - calls), 20 * seconds + 2);
  EXPECT_GE(brush->property("calls").toULongLong() - calls, 5u) << "the stroke is seen while it is painted";
}

TEST_F(RvizTools, ObstaclesRockAndRefusals) {
  rviz::Tool* const brush = use_brush();
  const std::string start = hash();
  set_tool(brush, "Material", "Obstacle");
  drag({40, 10}, {60, 10}, 5, 0.01);
  wait_for(brush);
  EXPECT_EQ(at(layer("obstacle"), {51, 11}), 1.0f) << text(brush, "report");
  drag({40, 10}, {60, 10}, 5, 0.01, Qt::ShiftModifier);
  wait_for(brush);
  EXPECT_EQ(layer("obstacle"), std::vector<float>(columns * rows, 0));
  set_tool(brush, "Material", "Rock");
  drag({80, 40}, {80, 40}, 1, 0);
  wait_for(brush);
  EXPECT_NEAR(static_cast<double>(at(layer("bedrock"), {79, 39})), 1.5, 0.01) << "a click gives the strength";
  set_tool(brush, "Operation", "Flatten");
  drag({79, 39}, {95, 39}, 8, 0.01);
  wait_for(brush);
  EXPECT_NEAR(static_cast<double>(at(layer("bedrock"), {91, 39})), 1.5, 0.02) << "as high as where it began";
  for (int n = 0; n < 4; ++n) key(Qt::Key_Z);
  wait_for(brush);
  EXPECT_EQ(hash(), start);

  set_tool(brush, "Material", "Plants");
  drag({40, 10}, {60, 10}, 5, 0.01);
  EXPECT_NE(text(brush, "report").find("Operation"), std::string::npos) << text(brush, "report");
  set_tool(brush, "Operation", "Add");
  drag({40, 10}, {60, 10}, 5, 0.01);
  EXPECT_NE(text(brush, "report").find("Species"), std::string::npos) << text(brush, "report");
  set_tool(brush, "Material", "Water");
  drag({40, 10}, {60, 10}, 5, 0.01);
  wait_for(brush);
  EXPECT_NE(text(brush, "report").find("no layer water"), std::string::npos) << "what the node says is shown";
  if (const char* folder = std::getenv("DESERT_PICTURES")) window_->save(std::string(folder) + "/refused.png");
  EXPECT_EQ(hash(), start);
}

TEST_F(RvizTools, TheWheelChangesRadiusAndStrength) {
  rviz::Tool* const brush = use_brush();
  wheel({70, 30}, 2);
  EXPECT_NEAR(get_tool(brush, "Radius"), 5 * 1.21, 1e-4);
  EXPECT_NEAR(get_tool(brush, "Strength"), 0.5, 1e-6);
  wheel({70, 30}, -1, Qt::ControlModifier);
  EXPECT_NEAR(get_tool(brush, "Strength"), 0.5 / 1.1, 1e-4);
  EXPECT_NEAR(get_tool(brush, "Radius"), 5 * 1.21, 1e-4);
}

TEST_F(RvizTools, PaintsWhatIsSeenThoughExaggeratedAndTurned) {
  tf2_ros::StaticTransformBroadcaster broadcaster;
  geometry_msgs::TransformStamped turned;
  turned.header.stamp = ros::Time::now();
  turned.header.frame_id = "turned";
  turned.child_frame_id = "terrain";
  turned.transform.translation.z = 7;
  turned.transform.rotation.z = turned.transform.rotation.w = std::sqrt(0.5);  // (x, y) is at (-y, x)
  broadcaster.sendTransform(turned);
  window_->set_fixed_frame("turned");
  set(display_, {"Vertical Exaggeration"}, 10);
  const double z = 7 + 10 * surface;
  window_->look_at(80);
  rviz::Property* const focus = window_->manager().getViewManager()->getCurrent()->subProp("Focal Point");
  focus->subProp("X")->setValue(-30);
  focus->subProp("Y")->setValue(55);
  focus->subProp("Z")->setValue(z);
  rviz::Tool* const brush = use("desert_sim/Brush");
  set_tool(brush, "Strength", 0.01);  // ground that rises under the mouse would turn the stroke aside
  EXPECT_TRUE(window_->run_until([&] {
    mouse(QEvent::MouseMove, {-30, 60}, Qt::NoButton, Qt::NoModifier, z);
    return brush->property("over_terrain").toBool();
  }));
  const std::vector<float> before = layer("sand_depth");
  drag({-20, 50}, {-40, 60}, 10, 0.01, Qt::NoModifier, z);
  wait_for(brush);
  expect_changed(before, layer("sand_depth"), {50, 20}, {60, 40}, 5, 0.7);
  if (const char* folder = std::getenv("DESERT_PICTURES")) window_->save(std::string(folder) + "/turned.png");
}

TEST_F(RvizTools, TheNodesAbsenceIsAMessage) {
  rviz::Tool* const brush = use_brush();
  set_tool(brush, "Node", "/nobody");
  mouse(QEvent::MouseMove, {70, 30}, Qt::NoButton);
  EXPECT_FALSE(brush->property("over_terrain").toBool());
  drag({40, 10}, {60, 10}, 5, 0.01);
  EXPECT_NE(text(brush, "report").find("/nobody"), std::string::npos) << text(brush, "report");
  key(Qt::Key_Z);
  wait_for(brush);
  EXPECT_NE(text(brush, "report").find("/nobody/undo"), std::string::npos) << text(brush, "report");
}

TEST_F(RvizTools, TheRulerMeasures) {
  rviz::Tool* const ruler = use("desert_sim/Ruler");
  const auto measured = [&] { return text(ruler, "text"); };
  ASSERT_TRUE(window_->run_until([&] {  // two clicks, and what a third one would end
    mouse(QEvent::MouseButtonPress, {100, 40}, Qt::LeftButton);
    mouse(QEvent::MouseButtonRelease, {100, 40}, Qt::NoButton);
    mouse(QEvent::MouseMove, {60, 10}, Qt::NoButton);
    return !measured().empty();
  }));
  double horizontal = 0, along = 0, height = 0, slope = 0;
  const auto read = [&] {
    return std::sscanf(measured().c_str(), "%lf m, along the ground %lf m\nheight %lf m, slope %lf", &horizontal,
                       &along, &height, &slope);
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
  window_->run(0.3);
  if (const char* folder = std::getenv("DESERT_PICTURES")) window_->save(std::string(folder) + "/ruler.png");
  mouse(QEvent::MouseButtonPress, {126, -10}, Qt::LeftButton);
  mouse(QEvent::MouseButtonRelease, {126, -10}, Qt::NoButton);
  const std::string ended = measured();
  mouse(QEvent::MouseMove, {60, 10}, Qt::NoButton);
  EXPECT_EQ(measured(), ended) << "the second click holds it";
}

TEST_F(RvizTools, ShowsTheOutline) {
  rviz::Tool* const brush = use_brush();
  window_->look_at(60);
  set_tool(brush, "Radius", 12);
  mouse(QEvent::MouseMove, {-200, 25}, Qt::NoButton);
  window_->run(0.3);
  EXPECT_FALSE(brush->property("over_terrain").toBool());
  const std::size_t without = window_->colours();
  mouse(QEvent::MouseMove, {50, 25}, Qt::NoButton);
  window_->run(0.3);
  EXPECT_GE(window_->colours(), without + 2) << "two rings";
  if (const char* folder = std::getenv("DESERT_PICTURES")) window_->save(std::string(folder) + "/hover.png");
}

}  // namespace
}  // namespace rviz_test

int main(int argc, char** argv) { return node_test::run_tests(argc, argv, "rviz_tools_test"); }
