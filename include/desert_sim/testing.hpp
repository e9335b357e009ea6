#pragma once
/// A desert for a test with GoogleTest and rostest, and what may be expected of it.
///
///     TEST(MyPlanner, GoesRoundAWall) {
///       desert_sim::test::Options options;
///       options.scenario = "rover_barchans";
///       options.seed = 3;
///       options.rover = {12, 64};
///       desert_sim::test::Desert desert(options);
///       EXPECT_TRUE(desert.expect_cost({12, 64}, 0, 30));
///       EXPECT_TRUE(desert.expect_rover_arrives({20, 64}, 300));
///     }

#include <desert_sim/EditTerrain.h>
#include <desert_sim/GetSubmap.h>
#include <desert_sim/Step.h>
#include <nav_msgs/Path.h>
#include <ros/callback_queue.h>
#include <ros/service.h>
#include <ros/spinner.h>

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "desert_sim/client/service_call.hpp"
#include "desert_sim/client/terrain_client.hpp"
#include "desert_sim/testing/expectation.hpp"
#include "desert_sim/testing/node_process.hpp"
#include "desert_sim/testing/rover.hpp"

namespace desert_sim::test {

/// Where a rover starts, in the terrain's frame [m].
struct RoverStart {
  double x = 0, y = 0, yaw_deg = 0;
};

struct Options {
  /// A name of config/scenarios, or a YAML file (a path with a slash); empty: the node that runs already,
  /// which is paused.
  std::string scenario;
  std::optional<std::uint64_t> seed;  ///< of the scenario; empty: the one it has
  /// Keys of the scenario to override: {"grid.width=128", "wind.speed=7"}.
  std::vector<std::string> settings;
  std::optional<RoverStart> rover;    ///< empty: none
  double seconds_per_step = 0.1;      ///< time of the rover in a step of the desert [s]
  Parameters parameters;              ///< more private parameters of the node (config/node_parameters.md)
  Parameters rover_parameters;        ///< and of the rover's (config/rover_parameters.md)
  std::string node = "/desert_sim";   ///< full name of the node
  std::string rover_name = "/rover";  ///< namespace of the rover
  /// How long expect_rover_arrives() waits for a command, and expect_replanned() for a path, before the next
  /// step [s of wall time, times patience()].
  double reaction = 1;
  /// Folder for pictures of failures; empty: that of the environment's DESERT_TEST_PICTURES, else the folder
  /// of rostest's results.
  std::string pictures;
};

/// A paused node for the length of a test, and a rover on it in lockstep: both move by step() only, so that
/// the same calls lead to the same bits. To be used by one thread. What cannot be done throws a
/// std::runtime_error with the node's reason; an expectation that is not met names a picture: the terrain
/// with lethal cells in red, the rover's way in white, paths in blue, the goal in green.
class Desert {
 public:
  explicit Desert(const Options& options);
  ~Desert();

  /// Makes so many steps one by one, and the rover drives with them. Its pose and the terrain are those of
  /// the last step then.
  desert_sim::Step::Response step(std::uint32_t steps = 1);
  /// The answer of a service of the node ("edit_terrain") or of another one ("/rover/desert_rover/drive").
  /// Throws a std::runtime_error with the reason if it is refused.
  template <class Service>
  typename Service::Response call(const std::string& service,
                                  const typename Service::Request& request = {}) const;
  /// A brush on the ground. Whoever subscribes to the terrain is shown it before this returns.
  desert_sim::EditTerrain::Response edit(const desert_sim::EditTerrain::Request& request);

  const TerrainClient& terrain() const { return *terrain_; }
  /// Throws a std::runtime_error if there is none.
  Rover& rover();
  /// Cost of the cell at a point as in ~costmap: 0 … 99, 100 lethal, -1 unknown. Throws a std::runtime_error
  /// for a point off the grid.
  int cost(const Point& p) const;

  // ---- Expectations.

  /// The cost at a point is in a range; at_least = 100 expects a lethal cell.
  Expectation expect_cost(const Point& p, int at_least, int at_most);
  /// `happens()` is true now, or after at most `within` steps.
  Expectation expect(const std::function<bool()>& happens, int within, const std::string& what);
  /// The rover comes within `tolerance` [m] of the goal in at most `within` steps, as something under test
  /// commands it. Before each step a command is waited for, so that a planner that answers each pose is in
  /// lockstep, too.
  Expectation expect_rover_arrives(const Point& goal, int within, double tolerance = 0.5);
  /// What `change` changes makes a planner publish another way on `topic` (nav_msgs/Path) in at most `within`
  /// steps: one that leads farther than `by` [m] away from the last one before.
  Expectation expect_replanned(const std::string& topic, int within, const std::function<void()>& change,
                               double by = 1);

  /// The terrain as it is now, as a picture file. Throws a std::runtime_error if it cannot be written, or if
  /// desert_sim was built without OpenCV (DESERT_PARTS=client); failures then come without a picture, too.
  void write_picture(const std::string& path, const std::optional<Point>& goal = std::nullopt) const;

 private:
  void start_node();
  void start_rover();
  void wait_for_node(Process& process, const std::string& name, const std::function<bool()>& is_there);
  desert_sim::Step::Response show(std::uint32_t steps);
  std::vector<std::int8_t> costs(const Point& center, double length_x, double length_y) const;
  const Inbox<nav_msgs::Path>& inbox(const std::string& topic);
  Expectation fail(const std::string& message, const std::optional<Point>& goal = std::nullopt) const;
  [[noreturn]] static void throw_error(const std::string& message);

  const Options options_;
  std::string folder_;  ///< of checkpoints, removed at the end
  ros::CallbackQueue queue_;
  ros::NodeHandle handle_;
  ros::AsyncSpinner spinner_{1, &queue_};
  std::vector<std::unique_ptr<Process>> processes_;
  std::unique_ptr<TerrainClient> terrain_;
  std::unique_ptr<Rover> rover_;
  std::uint64_t commands_seen_ = 0;  ///< of the rover, before the last step
  std::vector<Point> way_;
  std::map<std::string, std::unique_ptr<Inbox<nav_msgs::Path>>> paths_;
};

template <class Service>
typename Service::Response Desert::call(const std::string& service,
                                        const typename Service::Request& request) const {
  const std::string name = service.front() == '/' ? service : options_.node + "/" + service;
  Service exchange;
  exchange.request = request;
  // Not by waitForService(): its time stands still where the node is the clock and is paused.
  if (!wait_until([&] { return ros::service::exists(name, false); }, 60) || !call_service(name, exchange))
    throw_error(name + " does not answer");
  if (!exchange.response.success) throw_error(name + ": " + exchange.response.message);
  return exchange.response;
}

}  // namespace desert_sim::test
