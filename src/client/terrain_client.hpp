#pragma once
/// The live terrain of a desert_sim node, for other programs. The client subscribes to keyframes and updates,
/// keeps an elevation map up to date, and answers queries on it from any thread.
///
///     ros::init(argc, argv, "my_planner");
///     desert_sim::TerrainClient terrain;
///     if (!terrain.wait_for_terrain(10.0)) ...;                 // there is no node
///     // Elevation [m] in the frame terrain.map()->info().frame:
///     std::optional<double> z = terrain.elevation(12.0, 34.0);
///     // An immutable map of one moment:
///     std::shared_ptr<const desert_sim::ElevationMap> map = terrain.map();
///
/// The client detects lost messages and requests a new keyframe; until it arrives, the last valid map stays.
/// It uses two kinds of request in turn: a message on the node's topic ~request_keyframe, and a new
/// subscription to the keyframes, since publishers send the present state to new subscribers. (roscpp makes
/// no new connection while another subscriber in the process uses the same topic, so the second kind alone is
/// not enough.)

#include <ros/callback_queue.h>
#include <ros/node_handle.h>

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "src/client/elevation_assembler.hpp"
#include "src/client/elevation_map.hpp"
#include "src/client/keyframe_requests.hpp"

namespace desert_sim {

class TerrainClient {
 public:
  struct Options {
    std::string node = "desert_sim";  ///< name of the simulator's node, whose namespace has the topics
    std::string elevation_topic;      ///< topic of keyframes; empty: <node>/elevation
    std::string updates_topic;        ///< topic of updates; empty: <node>/elevation_updates
    std::string request_topic;        ///< topic of requests; empty: <node>/request_keyframe
    /// Whether the client processes messages on its own thread. Otherwise they are processed by the callback
    /// queue of the given node handle (ros::spin(), a spinner, a nodelet's threads).
    bool own_thread = true;
    std::uint32_t update_queue = 200;  ///< size of the subscriber queue of updates; an overflow is a gap
    double shortest_pause = 0.5;       ///< shortest pause between keyframe requests [s], > 0
    double longest_pause = 10;         ///< limit of the pause, which doubles while requests do not help [s]
    /// Called after each change of cells, in order and never concurrently, on the thread that processes
    /// messages. The function may use the client, but must not destroy it and must not throw. No message is
    /// processed while it runs.
    std::function<void(const MapChange&)> on_change;
  };

  struct Statistics : StreamCounts {
    std::uint64_t requests = 0;  ///< number of keyframe requests
    /// Latency of updates [s of ROS time], from the stamp of a state to the map that contains it: last, mean
    /// and largest; 0 before the first update. An offset between the clocks of two machines adds to it.
    double latency = 0, mean_latency = 0, largest_latency = 0;
  };

  /// Subscribes. Waits for the ROS master if there is none, but not for the node. Throws ConfigError for
  /// invalid options.
  explicit TerrainClient(const ros::NodeHandle& node = ros::NodeHandle());
  TerrainClient(const ros::NodeHandle& node, Options options);
  /// Waits for the message that is being processed.
  ~TerrainClient();
  TerrainClient(const TerrainClient&) = delete;
  TerrainClient& operator=(const TerrainClient&) = delete;

  /// The newest map; null before the first keyframe. It is immutable, so that several queries on it agree.
  std::shared_ptr<const ElevationMap> map() const;
  /// The query of the same name on the newest map; empty if there is no map.
  std::optional<double> elevation(double x, double y) const;
  std::optional<geometry_msgs::Vector3> normal(double x, double y) const;
  std::optional<double> slope(double x, double y) const;

  /// Whether no message is known to be missing: false before the first keyframe, and from a gap to the next
  /// keyframe.
  bool up_to_date() const;
  /// Whether keyframes have a publisher.
  bool connected() const;
  /// Waits for the first map, at most `timeout` seconds of wall time. False if there is no map by then, or if
  /// ROS shuts down. Messages must be processed by another thread meanwhile.
  bool wait_for_terrain(double timeout) const;
  /// Waits in the same way for a map of this step or a later one.
  bool wait_for_step(std::uint64_t step, double timeout) const;
  Statistics statistics() const;

 private:
  void subscribe_to_keyframes();
  void request_keyframe();
  void process(const ElevationGrid::ConstPtr& keyframe);
  void process(const ElevationUpdate::ConstPtr& update);
  void publish_change(const MapChange& change, const ros::Time* update_stamp);
  bool wait(const std::function<bool()>& condition, double timeout) const;
  void run_thread();
  bool keyframe_is_due();

  Options options_;
  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  ros::Publisher request_publisher_;
  ros::Subscriber updates_;

  std::mutex processing_mutex_;  ///< held while a message is processed; queries do not wait for it
  ElevationAssembler assembler_;
  KeyframeRequests requests_;

  mutable std::mutex mutex_;  ///< protects the members below; held only briefly
  mutable std::condition_variable changed_;
  std::shared_ptr<const ElevationMap> map_;
  Statistics statistics_;
  std::uint64_t latency_count_ = 0;  ///< number of updates in the mean latency
  bool up_to_date_ = false, stopping_ = false;
  ros::Subscriber keyframes_;
  std::thread thread_;
};

}  // namespace desert_sim
