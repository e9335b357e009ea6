#include "test/src/rviz/tool_fixture.hpp"

#include <OgreCamera.h>
#include <desert_sim/GetSubmap.h>
#include <desert_sim/LoadScenario.h>

#include <cmath>
#include <cstdlib>

namespace rviz_test {

double distance_to_segment(const At& p, const At& a, const At& b) {
  const double dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
  const double s =
      square > 0 ? std::min(1.0, std::max(0.0, ((p.x - a.x) * dx + (p.y - a.y) * dy) / square)) : 0;
  return std::hypot(p.x - a.x - s * dx, p.y - a.y - s * dy);
}

At centre(int x, int y) { return {west + cell * (x + 0.5), south + cell * (y + 0.5)}; }

std::vector<float> layer(const std::string& name) {
  desert_sim::GetSubmap::Request request;
  request.center.x = west + columns * cell / 2;
  request.center.y = south + rows * cell / 2;
  request.length_x = columns * cell;
  request.length_y = rows * cell;
  request.layers = {name};
  const desert_sim::GetSubmap::Response answer = call<desert_sim::GetSubmap>("get_submap", request);
  EXPECT_TRUE(answer.success) << answer.message;
  EXPECT_EQ(answer.map.layers.size(), 1u);
  return answer.map.layers.empty() ? std::vector<float>(columns * rows) : answer.map.layers[0].data;
}

float at(const std::vector<float>& values, const At& place) {
  const int x = static_cast<int>((place.x - west) / cell), y = static_cast<int>((place.y - south) / cell);
  return values[static_cast<std::size_t>(y * columns + x)];
}

void load(const std::string& scenario) {
  desert_sim::LoadScenario::Request request;
  request.name = scenario;
  const auto answer = call<desert_sim::LoadScenario>("load_scenario", request);
  ASSERT_TRUE(answer.success) << answer.message;
}

Screen* RvizTools::screen_ = nullptr;
Window* RvizTools::window_ = nullptr;

void RvizTools::SetUpTestSuite() {
  if (screen_) return;
  screen_ = new Screen;
  if (!screen_->problem().empty()) return;
  static int argument_count = 1;
  static char name[] = "rviz_tools_test";
  static char* arguments[] = {name, nullptr};
  new QApplication(argument_count, arguments);
  window_ = new Window(800, 600, 60);
}

void RvizTools::close() {
  delete window_;
  delete qApp;
  delete screen_;
}

void RvizTools::SetUp() {
  if (!window_) GTEST_SKIP() << screen_->problem();
  load("corner.yaml");
  window_->set_fixed_frame("terrain");
  display_ = window_->add_terrain("/desert_sim/elevation");
  window_->look_from_above(west + columns * cell / 2, south + rows * cell / 2, 5);
}

void RvizTools::TearDown() {
  if (!window_) return;
  tools().removeAll();
  window_->manager().removeAllDisplays();
}

rviz::Tool* RvizTools::use(const char* name) {
  rviz::Tool* const tool = tools().addTool(name);
  tools().setCurrentTool(tool);
  EXPECT_TRUE(window_->run_until([&] { return display_->property("blocks").toDouble() > 0; }));
  EXPECT_TRUE(window_->run_until([&] { return display_->property("waiting_blocks").toDouble() == 0; }));
  return tool;
}

rviz::Tool* RvizTools::use_brush(const char* node) {
  rviz::Tool* const brush = use("desert_sim/Brush");
  set_tool(brush, "Node", node);
  EXPECT_TRUE(window_->run_until([&] {
    mouse(QEvent::MouseMove, {70, 30}, Qt::NoButton);
    return brush->property("over_terrain").toBool();
  })) << "the brush finds the terrain";
  return brush;
}

QPoint RvizTools::pixel(const At& at, double z) {
  Ogre::Camera* const camera = window_->manager().getRenderPanel()->getCamera();
  const Ogre::Vector3 p = camera->getProjectionMatrix() *
                          (camera->getViewMatrix() * Ogre::Vector3(float(at.x), float(at.y), float(z)));
  rviz::RenderPanel& panel = *window_->manager().getRenderPanel();
  return {static_cast<int>(std::lround((0.5 + 0.5 * double(p.x)) * panel.width())),
          static_cast<int>(std::lround((0.5 - 0.5 * double(p.y)) * panel.height()))};
}

void RvizTools::mouse(QEvent::Type type, const At& at, Qt::MouseButtons down, Qt::KeyboardModifiers modifiers,
                      double z) {
  const Qt::MouseButton acting = type == QEvent::MouseMove ? Qt::NoButton : Qt::LeftButton;
  QMouseEvent event(type, pixel(at, z), acting, down, modifiers);
  QApplication::sendEvent(window_->manager().getRenderPanel(), &event);
}

void RvizTools::wheel(const At& at, int notches, Qt::KeyboardModifiers modifiers) {
  const QPoint place = pixel(at);
  QWheelEvent event(place, window_->manager().getRenderPanel()->mapToGlobal(place), QPoint(),
                    QPoint(0, 120 * notches), Qt::NoButton, modifiers, Qt::NoScrollPhase, false);
  QApplication::sendEvent(window_->manager().getRenderPanel(), &event);
}

void RvizTools::key(int code, Qt::KeyboardModifiers modifiers) {
  QKeyEvent event(QEvent::KeyPress, code, modifiers);
  QApplication::sendEvent(window_->manager().getRenderPanel(), &event);
}

void RvizTools::drag(const At& from, const At& to, int moves, Qt::KeyboardModifiers modifiers, double z) {
  mouse(QEvent::MouseMove, from, Qt::NoButton, modifiers, z);
  mouse(QEvent::MouseButtonPress, from, Qt::LeftButton, modifiers, z);
  for (int n = 1; n <= moves; ++n) {
    const double share = static_cast<double>(n) / moves;
    mouse(QEvent::MouseMove, {from.x + share * (to.x - from.x), from.y + share * (to.y - from.y)},
          Qt::LeftButton, modifiers, z);
    QApplication::processEvents();
  }
  mouse(QEvent::MouseButtonRelease, to, Qt::NoButton, modifiers, z);
}

void RvizTools::wait_for(rviz::Tool* brush) {
  EXPECT_TRUE(window_->run_until([&] { return brush->property("idle").toBool(); }));
  window_->run_frames(1);  // which shows the report
}

void RvizTools::set_tool(rviz::Tool* tool, const char* name, const QVariant& value) {
  rviz::Property* const found = property(tool->getPropertyContainer(), {name});
  ASSERT_TRUE(found) << name;
  found->setValue(value);
}

double RvizTools::get_tool(rviz::Tool* tool, const char* name) {
  return property(tool->getPropertyContainer(), {name})->getValue().toDouble();
}

std::string RvizTools::text(rviz::Tool* tool, const char* name) {
  return tool->property(name).toString().toStdString();
}

void RvizTools::expect_changed(const std::vector<float>& before, const std::vector<float>& after,
                               const At& from, const At& to, double radius, double slack) {
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const double away = distance_to_segment(centre(x, y), from, to);
      const auto n = static_cast<std::size_t>(y * columns + x);
      if (std::abs(away - radius) < slack) continue;
      EXPECT_EQ(before[n] != after[n], away < radius) << "cell " << x << ", " << y;
    }
}

void RvizTools::click(const At& at) {
  mouse(QEvent::MouseButtonPress, at, Qt::LeftButton);
  mouse(QEvent::MouseButtonRelease, at, Qt::NoButton);
}

void RvizTools::save(const std::string& name) {
  if (const char* folder = std::getenv("DESERT_PICTURES"))
    window_->save(std::string(folder) + "/" + name + ".png");
}

namespace {

class Closing : public testing::Environment {
  void TearDown() override { RvizTools::close(); }
};

}  // namespace
}  // namespace rviz_test

int main(int argc, char** argv) {
  testing::AddGlobalTestEnvironment(new rviz_test::Closing);
  return node_test::run_tests(argc, argv, "rviz_tools_test");
}
