#include "test/src/rviz/rviz_window.hpp"

#include <OgreRenderWindow.h>
#include <fcntl.h>
#include <rviz/display_group.h>
#include <rviz/ogre_helpers/render_system.h>
#include <rviz/properties/status_list.h>
#include <rviz/properties/status_property.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <QImage>
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <set>
#include <stdexcept>

#include "include/desert_sim/testing/node_process.hpp"

namespace rviz_test {

namespace {

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

constexpr int frames_to_move = 3;  // a camera moves at the end of a frame; a display sees it in the next one

}  // namespace

// ---- Screen ----

Screen::Screen(int width, int height) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe for Xvfb");
  pid_ = fork();
  if (pid_ == 0) {
    close(ends[0]);
    prctl(PR_SET_PDEATHSIG, SIGTERM);  // a test that crashes leaves no screen behind
    dup2(open("/dev/null", O_WRONLY), STDERR_FILENO);
    const std::string number = std::to_string(ends[1]),
                      size = std::to_string(width) + "x" + std::to_string(height) + "x24";
    execlp("Xvfb", "Xvfb", "-displayfd", number.c_str(), "-screen", "0", size.c_str(), "+extension", "GLX",
           "-noreset", "-nolisten", "tcp", static_cast<char*>(nullptr));
    _exit(127);
  }
  close(ends[1]);
  char text[16] = "";
  ssize_t length = 0;
  for (ssize_t n = 0; length < 15 && (n = read(ends[0], text + length, 1)) == 1 && text[length] != '\n';)
    ++length;
  close(ends[0]);
  text[length] = 0;
  if (length == 0) {
    problem_ = "Xvfb does not start: install xvfb and libgl1-mesa-dri (scripts/dependencies.txt)";
    return;
  }
  char folder[] = "/tmp/desert_rviz_XXXXXX";
  runtime_folder_ = mkdtemp(folder);
  setenv("XDG_RUNTIME_DIR", runtime_folder_.c_str(), 1);
  setenv("DISPLAY", (std::string(":") + text).c_str(), 1);
  setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
  setenv("GALLIUM_DRIVER", "llvmpipe", 1);
  setenv("QT_X11_NO_MITSHM", "1", 1);
  setenv("OGRE_RTT_MODE", "Copy", 1);
}

Screen::~Screen() {
  if (pid_ <= 0) return;
  kill(pid_, SIGTERM);
  waitpid(pid_, nullptr, 0);
  std::error_code ignored;  // a folder that stays harms nobody
  if (!runtime_folder_.empty()) std::filesystem::remove_all(runtime_folder_, ignored);
}

// ---- Window ----

Window::Window(int width, int height, int frame_rate) {
  rviz::RenderSystem::disableAntiAliasing();  // in software it takes more than all the rest
  panel_ = std::make_unique<rviz::RenderPanel>();
  panel_->resize(width, height);
  panel_->show();
  manager_ = std::make_unique<rviz::VisualizationManager>(panel_.get());
  panel_->initialize(manager_->getSceneManager(), manager_.get());
  manager_->initialize();
  property(manager_->getRootDisplayGroup(), {"Global Options", "Frame Rate"})->setValue(frame_rate);
  QObject::connect(manager_.get(), &rviz::VisualizationManager::preUpdate, [this] {
    if (for_each_frame_ && frames() > told_frames_) for_each_frame_();
    told_frames_ = frames();
  });
  manager_->startUpdate();
}

Window::~Window() {
  manager_->stopUpdate();
  manager_->removeAllDisplays();
  panel_.reset();
  manager_.reset();
}

rviz::Display* Window::add_terrain(const std::string& topic) {
  rviz::Display* const display = manager_->createDisplay("desert_sim/Terrain", "Terrain", false);
  display->setTopic(QString::fromStdString(topic), "desert_sim/ElevationGrid");
  display->setEnabled(true);
  return display;
}

void Window::remove(rviz::Display* display) {
  manager_->getRootDisplayGroup()->takeDisplay(display);
  delete display;
}

void Window::look_at(double side) {
  manager_->getViewManager()->setCurrentViewControllerType("rviz/Orbit");
  rviz::ViewController* const view = manager_->getViewManager()->getCurrent();
  view->subProp("Distance")->setValue(1.1 * side);
  view->subProp("Yaw")->setValue(-1.9);
  view->subProp("Pitch")->setValue(0.7);
  rviz::Property* const focus = view->subProp("Focal Point");
  focus->subProp("X")->setValue(0.5 * side);
  focus->subProp("Y")->setValue(0.5 * side);
  focus->subProp("Z")->setValue(0);
  run_frames(frames_to_move);
}

void Window::look_from_above(double x, double y, double pixels_per_metre) {
  manager_->getViewManager()->setCurrentViewControllerType("rviz/TopDownOrtho");
  rviz::ViewController* const view = manager_->getViewManager()->getCurrent();
  view->subProp("Scale")->setValue(pixels_per_metre);
  view->subProp("X")->setValue(x);
  view->subProp("Y")->setValue(y);
  run_frames(frames_to_move);
}

bool Window::run_until(const std::function<bool()>& condition, double seconds) {
  const double end = now() + seconds * desert_sim::test::patience();
  while (!condition()) {
    if (now() > end) return false;
    QApplication::processEvents(QEventLoop::WaitForMoreEvents);
  }
  return true;
}

void Window::run_frames(int count) {
  // What has happened between two frames is in the next one; what is asked for in a frame is rendered by it.
  for (int n = 0; n < count; ++n) {
    manager_->queueRender();
    const std::uint64_t before = frames();
    while (frames() == before) QApplication::processEvents(QEventLoop::WaitForMoreEvents);
  }
}

void Window::for_each_frame(const std::function<void()>& call) {
  told_frames_ = frames();
  for_each_frame_ = call;
}

void Window::save(const std::string& path) { panel_->getRenderWindow()->writeContentsToFile(path); }

std::vector<std::uint32_t> Window::pixels() {
  Ogre::RenderWindow* const window = panel_->getRenderWindow();
  const int width = static_cast<int>(window->getWidth()), height = static_cast<int>(window->getHeight());
  std::vector<std::uint32_t> all_pixels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  const Ogre::Box all(0, 0, static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height));
  window->copyContentsToMemory(all, Ogre::PixelBox(all, Ogre::PF_A8R8G8B8, all_pixels.data()),
                               Ogre::RenderTarget::FB_AUTO);
  return all_pixels;
}

std::size_t Window::colours() {
  const std::vector<std::uint32_t> all = pixels();
  return std::set<std::uint32_t>(all.begin(), all.end()).size();
}

std::uint32_t Window::pixel(int column, int row) {
  return pixels()[static_cast<std::size_t>(row) * panel_->getRenderWindow()->getWidth() +
                  static_cast<std::size_t>(column)] &
         0xffffffU;
}

// ---- properties ----

rviz::Property* property(rviz::Property* parent, const std::vector<std::string>& path) {
  for (const std::string& name : path) {
    rviz::Property* found = nullptr;
    for (int n = 0; n < parent->numChildren(); ++n)
      if (parent->childAt(n)->getNameStd() == name) found = parent->childAt(n);
    if (!found) return nullptr;
    parent = found;
  }
  return parent;
}

void set(rviz::Display* display, const std::vector<std::string>& path, const QVariant& value) {
  rviz::Property* const found = property(display, path);
  if (!found) throw std::runtime_error("the display has no property " + path.back());
  found->setValue(value);
}

Status status(rviz::Display* display, const std::string& name) {
  for (int n = 0; n < display->numChildren(); ++n) {
    if (!dynamic_cast<rviz::StatusList*>(display->childAt(n))) continue;
    if (auto* const found = dynamic_cast<rviz::StatusProperty*>(property(display->childAt(n), {name})))
      return {found->getLevel(), found->getValue().toString().toStdString()};
  }
  return {};
}

double resident_megabytes() {
  std::ifstream file("/proc/self/statm");
  double pages = 0, resident = 0;
  file >> pages >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

double steady_growth_megabytes(const std::function<void()>& round) {
  double least = std::numeric_limits<double>::infinity();
  for (int n = 0; n < 4; ++n) {
    const double before = resident_megabytes();
    round();
    const double after = resident_megabytes();
    std::printf("resident: %.1f MB before, %.1f MB after a round\n", before, after);
    least = std::min(least, after - before);
  }
  return least;
}

}  // namespace rviz_test
