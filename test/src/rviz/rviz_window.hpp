#pragma once
/// rviz in the test's own process, on a screen of Xvfb and with OpenGL in software.

#include <rviz/display.h>
#include <rviz/render_panel.h>
#include <rviz/visualization_manager.h>

#include <QApplication>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace rviz_test {

/// A screen without a monitor. Sets DISPLAY, and the variables that make OpenGL run in software.
class Screen {
 public:
  explicit Screen(int width = 1280, int height = 900);
  ~Screen();
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;
  /// Why there is no screen; empty if there is one.
  const std::string& problem() const { return problem_; }

 private:
  int pid_ = -1;
  std::string problem_, runtime_folder_;
};

/// rviz's view, with displays of plugins. Frames are drawn while run_frames() or run_until() waits.
class Window {
 public:
  /// `frame_rate`: rviz's property; tests draw more than the 30 frames a second that users get.
  Window(int width, int height, int frame_rate = 200);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// A display desert_sim/Terrain of this topic.
  rviz::Display* add_terrain(const std::string& topic);
  void remove(rviz::Display* display);
  rviz::VisualizationManager& manager() { return *manager_; }
  void set_fixed_frame(const std::string& frame) { manager_->setFixedFrame(QString::fromStdString(frame)); }
  /// Looks at a square of this side, whose south-west corner is the origin of the fixed frame [m].
  /// Returns when the displays have seen that the camera moved.
  void look_at(double side);
  /// Looks from above with this scale [pixels/m]. Returns when the displays have seen it.
  void look_from_above(double x, double y, double pixels_per_metre);

  /// Draws frames until the condition holds; false if it does not within the time [s], times patience().
  bool run_until(const std::function<bool()>& condition, double seconds = 60);
  /// Draws so many frames from beginning to end. What was there before is in all of them.
  void run_frames(int count);
  /// From the next frame on, `call` is called for each frame that was drawn, before the one after it begins;
  /// null: nothing is.
  void for_each_frame(const std::function<void()>& call);
  std::uint64_t frames() const { return manager_->getFrameCount(); }
  /// Distinct colours in the picture: more than a few if something was drawn.
  std::size_t colours();
  /// A pixel of the picture, 0xrrggbb.
  std::uint32_t pixel(int column, int row);
  /// Writes the picture as a PNG.
  void save(const std::string& path);

 private:
  std::vector<std::uint32_t> pixels();

  std::unique_ptr<rviz::RenderPanel> panel_;
  std::unique_ptr<rviz::VisualizationManager> manager_;
  std::function<void()> for_each_frame_;
  std::uint64_t told_frames_ = 0;  ///< up to which for_each_frame_ was called
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
/// By how much that grows in the one of four rounds in which it grows least [MB]. A leak grows in every
/// round; what a library takes once (OGRE and its driver: 17 MB), at a time of its own, is none.
double steady_growth_megabytes(const std::function<void()>& round);

}  // namespace rviz_test
