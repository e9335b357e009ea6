/// The expectations of a Desert.
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "include/desert_sim/testing.hpp"
#include "src/core/error.hpp"
#include "src/core/number_text.hpp"
#include "src/testing/failure_picture.hpp"

namespace desert_sim::test {

namespace fs = std::filesystem;

namespace {

/// As rospkg.get_test_results_dir() has it.
std::string results_folder() {
  for (const char* name : {"DESERT_TEST_PICTURES", "ROS_TEST_RESULTS_DIR"})
    if (const char* folder = std::getenv(name)) return folder;
  if (const char* home = std::getenv("ROS_HOME")) return std::string(home) + "/test_results";
  const char* home = std::getenv("HOME");
  return (home ? std::string(home) : "") + "/.ros/test_results";
}

/// The name of a new file in a folder, which is made if it is missing.
std::string new_picture(const std::string& folder, std::uint64_t step) {
  fs::create_directories(folder);
  std::string path = folder + "/desert_sim_step_" + std::to_string(step) + "_XXXXXX.png";
  const int file = mkstemps(path.data(), 4);
  if (file < 0) throw Error(path + ": the picture cannot be made");
  close(file);
  return path;
}

std::ostream& operator<<(std::ostream& out, const Point& p) { return out << point_text(p.x, p.y); }

}  // namespace

Expectation Desert::fail(const std::string& message, const std::optional<Point>& goal) const {
  if (!has_failure_pictures) return {false, message + "; no picture: this build has no OpenCV", 0};
  const std::string path = new_picture(options_.pictures.empty() ? results_folder() : options_.pictures,
                                       terrain_->map()->info().step);
  write_picture(path, goal);
  return {false, message + "; picture: " + path, 0};
}

Expectation Desert::expect_cost(const Point& p, int at_least, int at_most) {
  const int found = cost(p);
  if (at_least <= found && found <= at_most) return {true, "", 0};
  std::ostringstream text;
  text << "the cost at " << p << " is " << found << " (expected: " << at_least << " ... " << at_most << ")";
  return fail(text.str(), p);
}

Expectation Desert::expect(const std::function<bool()>& happens, int within, const std::string& what) {
  for (int steps = 0;; ++steps) {
    if (happens()) return {true, "", steps};
    if (steps == within) return fail(what + ": not within " + std::to_string(within) + " steps");
    step();
  }
}

Expectation Desert::expect_rover_arrives(const Point& goal, int within, double tolerance) {
  const auto is_commanded = [this](const RoverStatus& s) { return s.commands > commands_seen_; };
  for (int steps = 0; steps <= within; ++steps) {
    if (rover().distance_to(goal) <= tolerance) return {true, "", steps};
    if (steps == within) break;
    rover_->wait_for_status(is_commanded, options_.reaction * patience());
    step();
  }
  const Pose now = rover_->pose();
  const RoverStatus status = rover_->status();
  std::ostringstream text;
  text << "after " << within << " steps the rover is at " << Point{now.x, now.y} << ", "
       << rover_->distance_to(goal) << " m from " << goal << " (expected: at most " << tolerance
       << " m); it is " << status.state << (status.reason.empty() ? "" : ": " + status.reason) << ", and got "
       << status.commands << " commands";
  return fail(text.str(), goal);
}

Expectation Desert::expect_replanned(const std::string& topic, int within,
                                     const std::function<void()>& change, double by) {
  const Inbox<nav_msgs::Path>& paths = inbox(topic);
  const double pause = options_.reaction * patience();
  for (int steps = 0; steps < within && !paths.wait_for_more_than(0, pause); ++steps) step();
  if (!paths.last())
    return fail("nobody has published a path on " + topic + " within " + std::to_string(within) + " steps");
  const std::vector<Point> before = points_of(*paths.last());
  const std::size_t seen = paths.count();
  change();
  for (int steps = 0; steps <= within; ++steps) {
    paths.wait_for_more_than(seen, pause);
    for (const auto& path : paths.since(seen))
      if (deviation(points_of(*path), before) > by) return {true, "", steps};
    if (steps < within) step();
  }
  std::ostringstream text;
  text << topic << " has " << paths.count() - seen << " paths since the change, and none leads farther than "
       << by << " m from the one before, after " << within << " steps";
  return fail(text.str());
}

}  // namespace desert_sim::test
