// Frames per second and milliseconds per frame of the display desert_sim/Terrain under OpenGL in software,
// while a keyframe comes in and while updates come at 10 Hz; for grids of several sizes, and with the
// displays that lie on the ground. With a number of plants, only while messages of so many come. Needs a ROS
// master and Xvfb:
//
//     roscore & rosrun desert_sim rviz_terrain_bench [WIDTHxHEIGHT] [plants=N] [SECONDS] [SIDE]...
//
// The size is that of the picture, 1024x768 if it is left out.

#include <nav_msgs/OccupancyGrid.h>
#include <nav_msgs/Path.h>
#include <ros/ros.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <thread>

#include "test/src/rviz/made_up_node.hpp"
#include "test/src/rviz/made_up_plants.hpp"
#include "test/src/rviz/rviz_window.hpp"

namespace rviz_test {
namespace {

struct Figures {
  std::vector<double> milliseconds;

  double most() const {
    return milliseconds.empty() ? 0 : *std::max_element(milliseconds.begin(), milliseconds.end());
  }
  double mean() const {
    double sum = 0;
    for (const double one : milliseconds) sum += one;
    return milliseconds.empty() ? 0 : sum / static_cast<double>(milliseconds.size());
  }
};

double number(rviz::Display* display, const char* name) { return display->property(name).toDouble(); }

/// Draws frames for so many seconds.
void run(Window& window, double seconds) {
  const double end = ros::WallTime::now().toSec() + seconds;
  window.run_until([end] { return ros::WallTime::now().toSec() > end; }, 2 * seconds + 60);
}

/// Draws for some seconds, with an update of this part of the grid ten times a second.
void measure_updates(Window& window, rviz::Display* display, MadeUpNode& node, int side, int part,
                     double seconds) {
  Figures all, with_update;
  std::atomic<bool> stop{false};
  std::thread sender([&] {
    for (int n = 0; !stop; ++n) {
      const int range = std::max(1, side - part);
      node.update(part == side ? 0 : n * 61 % range, part == side ? 0 : n * 83 % range, part, part,
                  [n](int x, int y) { return dunes(x, y) + 0.02f * static_cast<float>(n % 50); });
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
  });
  const std::uint64_t frames = window.frames();
  const std::clock_t begin_of_work = std::clock();
  const double begin = ros::WallTime::now().toSec();
  window.for_each_frame([&] {
    all.milliseconds.push_back(number(display, "frame_milliseconds"));
    if (number(display, "frame_messages") > 0) with_update.milliseconds.push_back(all.milliseconds.back());
  });
  run(window, seconds);
  window.for_each_frame(nullptr);
  const double elapsed = ros::WallTime::now().toSec() - begin;
  const double drawn = static_cast<double>(window.frames() - frames);
  const double work = 1e3 * static_cast<double>(std::clock() - begin_of_work) / CLOCKS_PER_SEC;
  stop = true;
  sender.join();
  std::printf(
      "%5d  updates of %4d x %-4d  %5.1f frames/s (%3.0f ms of processor time each, publisher included)  our "
      "work: %5.2f "
      "ms/frame, %5.2f ms with an update, at most %5.2f ms  %6.0f triangles\n",
      side, part, part, drawn / elapsed, work / drawn, all.mean(), with_update.mean(), all.most(),
      number(display, "triangles"));
}

/// The costs of the whole grid, a path across it and a scale bar.
class Draped {
 public:
  Draped(Window& window, const std::string& name, int side) : window_(window) {
    maps_ = node_.advertise<nav_msgs::OccupancyGrid>(name + "/costmap", 1, true);
    paths_ = node_.advertise<nav_msgs::Path>(name + "/path", 1, true);
    nav_msgs::OccupancyGrid map;
    map.header.frame_id = "map";
    map.info.resolution = 1;
    map.info.width = map.info.height = static_cast<std::uint32_t>(side);
    map.info.origin.orientation.w = 1;
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) map.data.push_back(static_cast<std::int8_t>((x / 8 + y / 8) % 101));
    maps_.publish(map);
    nav_msgs::Path path;
    path.header.frame_id = "map";
    path.poses.resize(static_cast<std::size_t>(side));
    for (int n = 0; n < side; ++n) {
      path.poses[static_cast<std::size_t>(n)].pose.position.x = n;
      path.poses[static_cast<std::size_t>(n)].pose.position.y = 0.5 * side * (1 + 0.5 * std::sin(0.03 * n));
    }
    paths_.publish(path);
    set(add("desert_sim/DrapedMap", name + "/costmap"), {"Node"}, QString::fromStdString(name));
    set(add("desert_sim/DrapedPath", name + "/path"), {"Node"}, QString::fromStdString(name));
    add("desert_sim/ScaleBar", "");
    window.run_until(
        [this] { return number(displays_[0], "maps") > 0 && number(displays_[1], "points") > 0; });
  }
  ~Draped() {
    for (rviz::Display* const display : displays_) window_.remove(display);
  }
  Draped(const Draped&) = delete;
  Draped& operator=(const Draped&) = delete;

 private:
  rviz::Display* add(const char* type, const std::string& topic) {
    rviz::Display* const display = window_.manager().createDisplay(type, type, false);
    if (!topic.empty()) display->setTopic(QString::fromStdString(topic), "");
    display->setEnabled(true);
    displays_.push_back(display);
    return display;
  }

  Window& window_;
  ros::NodeHandle node_;
  ros::Publisher maps_, paths_;
  std::vector<rviz::Display*> displays_;
};

/// Looks at the middle of the terrain from so far.
void look_from(Window& window, int side, double distance) {
  window.look_at(side);
  window.manager().getViewManager()->getCurrent()->subProp("Distance")->setValue(distance);
  window.run_frames(3);
}

/// Draws for some seconds without a new message, and as long with one each second.
void measure_view(Window& window, rviz::Display* display, const ros::Publisher& publisher,
                  const std::vector<desert_sim::PlantsPtr>& messages, double distance, double seconds) {
  for (const bool sending : {false, true}) {
    std::atomic<bool> stop{false};
    std::thread sender([&] {
      for (std::size_t n = 0; sending && !stop; ++n) {
        publisher.publish(messages[n % messages.size()]);
        for (int part = 0; part < 10 && !stop; ++part)
          std::this_thread::sleep_for(std::chrono::milliseconds(100));
      }
    });
    Figures all;
    const std::uint64_t frames = window.frames();
    const double begin = ros::WallTime::now().toSec();
    window.for_each_frame([&] { all.milliseconds.push_back(number(display, "frame_milliseconds")); });
    run(window, seconds);
    window.for_each_frame(nullptr);
    const double elapsed = ros::WallTime::now().toSec() - begin;
    stop = true;
    sender.join();
    std::printf(
        "  from %5.0f m, %-18s %5.1f frames/s  our work: %6.2f ms/frame, at most %7.2f ms  %6.0f shapes  "
        "resident %4.0f MB\n",
        distance, sending ? "a message a second" : "no message",
        static_cast<double>(window.frames() - frames) / elapsed, all.mean(), all.most(),
        number(display, "plants"), resident_megabytes());
  }
}

void measure_plants(Window& window, int side, std::size_t count, double seconds) {
  const std::string name = "/plants" + std::to_string(side);
  MadeUpNode node(name);
  ros::NodeHandle handle;
  const ros::Publisher publisher = handle.advertise<desert_sim::Plants>(name + "/plants", 1, true);
  rviz::Display* const display = window.add_terrain(name + "/elevation");
  window.look_at(side);
  node.keyframe(side, side, dunes);
  window.run_until(
      [&] { return number(display, "triangles") > 0 && number(display, "waiting_blocks") == 0; });
  std::vector<desert_sim::PlantsPtr> messages;
  for (int moment = 0; moment < 2; ++moment) messages.push_back(made_up_plants(count, side, moment));
  std::printf("%5d  %zu plants; resident, with two messages of them: %.0f MB\n", side, count,
              resident_megabytes());
  for (const double distance : {1.1 * side, 0.2 * side, 40.0}) {
    look_from(window, side, distance);
    publisher.publish(messages.front());
    run(window, 3);
    measure_view(window, display, publisher, messages, distance, seconds);
    if (const char* folder = std::getenv("DESERT_PICTURES"))
      window.save(std::string(folder) + "/plants_from_" + std::to_string(static_cast<int>(distance)) +
                  ".png");
  }
  window.remove(display);
}

void measure(Window& window, int side, double seconds) {
  const std::string name = "/bench" + std::to_string(side);
  MadeUpNode node(name);
  rviz::Display* const display = window.add_terrain(name + "/elevation");
  set(display, {"Plants"}, false);
  window.look_at(side);
  std::thread sender([&] { node.keyframe(side, side, dunes); });
  Figures keyframe;
  const double begin = ros::WallTime::now().toSec();
  window.for_each_frame([&] { keyframe.milliseconds.push_back(number(display, "frame_milliseconds")); });
  window.run_until(
      [&] { return number(display, "triangles") > 0 && number(display, "waiting_blocks") == 0; });
  window.for_each_frame(nullptr);
  sender.join();
  std::printf("%5d  keyframe shown after %.2f s, our work at most %.2f ms in a frame\n", side,
              ros::WallTime::now().toSec() - begin, keyframe.most());
  run(window, 0.5);
  measure_updates(window, display, node, side, 64, seconds);
  measure_updates(window, display, node, side, side, seconds);
  {
    const Draped draped(window, name, side);
    std::printf("with costs, a path and a scale bar on it:\n");
    measure_updates(window, display, node, side, 64, seconds);
  }
  window.remove(display);
}

}  // namespace
}  // namespace rviz_test

int main(int argc, char** argv) {
  using namespace rviz_test;
  ros::init(argc, argv, "rviz_terrain_bench");
  ros::start();
  int width = 0, height = 0, next = 1;
  if (argc > 1 && std::sscanf(argv[1], "%dx%d", &width, &height) == 2)
    ++next;
  else
    width = 1024, height = 768;
  unsigned long plants = 0;
  if (argc > next && std::sscanf(argv[next], "plants=%lu", &plants) == 1) ++next;
  const double seconds = argc > next ? std::atof(argv[next++]) : 8;
  std::vector<int> sides;
  for (; next < argc; ++next) sides.push_back(std::atoi(argv[next]));
  if (sides.empty()) sides = {256, 512, 1024, 2048};
  const Screen screen(width, height);
  if (!screen.problem().empty()) {
    std::fprintf(stderr, "%s\n", screen.problem().c_str());
    return 2;
  }
  QApplication application(argc, argv);
  Window window(width, height, 30);
  window.set_fixed_frame("map");
  for (const int side : sides)
    if (plants > 0)
      measure_plants(window, side, plants, seconds);
    else
      measure(window, side, seconds);
  return 0;
}
