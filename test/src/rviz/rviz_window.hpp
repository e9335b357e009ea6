#pragma once
/// rviz in the test's own process, on a screen of Xvfb and with OpenGL in software.

#include <rviz/display.h>
#include <rviz/render_panel.h>
#include <rviz/visualization_manager.h>

#include <QApplication>
#include <functional>
#include <memory>
#include <string>

namespace rviz_test {

/// A screen without a monitor. Sets DISPLAY, and the variables that make OpenGL run in software.
class Screen {
 public:
  Screen();
  ~Screen();
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;
  /// Why there is no screen; empty if there is one.
  const std::string& problem() const { return problem_; }

 private:
  int pid_ = -1;
  std::string problem_, runtime_folder_;
};

/// rviz's view, with displays of plugins. Frames are drawn while run() or run_until() waits.
class Window {
 public:
  Window(int width, int height);
  ~Window();

  /// A display desert_sim/Terrain of this topic.
  rviz::Display* add_terrain(const std::string& topic);
  void remove(rviz::Display* display);
  rviz::VisualizationManager& manager() { return *manager_; }
  void set_fixed_frame(const std::string& frame) { manager_->setFixedFrame(QString::fromStdString(frame)); }
  /// Looks at a square of this side, whose south-west corner is the origin of the fixed frame [m].
  void look_at(double side);
  /// Looks from above with this scale [pixels/m].
  void look_from_above(double x, double y, double pixels_per_metre);

  /// Draws frames for so many seconds; `each_frame` is called after each.
  void run(double seconds, const std::function<void()>& each_frame = nullptr);
  /// Draws frames until the condition holds; false if it does not within the time.
  bool run_until(const std::function<bool()>& condition, double seconds = 20);
  std::uint64_t frames() const { return manager_->getFrameCount(); }
  /// Distinct colours in the picture: more than a few if something was drawn.
  std::size_t colours();
  /// Writes the picture as a PNG.
  void save(const std::string& path);

 private:
  std::unique_ptr<rviz::RenderPanel> panel_;
  std::unique_ptr<rviz::VisualizationManager> manager_;
};

/// A property of a display by its path, such as {"Overlay", "Minimum"}; null if there is none.
rviz::Property* property(rviz::Property* parent, const std::vector<std::string>& path);
void set(rviz::Display* display, const std::vector<std::string>& path, const QVariant& value);
/// A status of a display by its name.
struct Status {
  int level = -1;  ///< rviz::StatusProperty::Level; -1: there is no such status
  std::string text;
};
Status status(rviz::Display* display, const std::string& name);
/// Memory of this process that is in use [MB].
double resident_megabytes();

}  // namespace rviz_test
