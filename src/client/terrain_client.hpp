#pragma once
/// The live terrain of a desert_sim node, for other programs: subscribes to keyframes and updates, keeps the
/// surface up to date, and answers questions about it from any thread.
///
///     ros::init(argc, argv, "my_planner");
///     desert_sim::TerrainClient terrain;
///     if (!terrain.wait_for_terrain(10.0)) ...;                         // no node
///     std::optional<double> z = terrain.elevation(12.0, 34.0);          // [m], in
///     terrain.map()->info().frame std::shared_ptr<const desert_sim::ElevationMap> map = terrain.map();  //
///     one moment, which never changes
///
/// What is lost between the node and the client is noticed, and a new keyframe is asked for; until it comes
/// the last good map is held. There are two ways to ask, taken in turn: a message on ~request_keyframe of the
/// node, and a new connection for keyframes, which any sender answers that sends its present state to new
/// subscribers (roscpp makes no new connection while something else in the process is subscribed to the same
/// topic).

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
    std::string node = "desert_sim";  ///< name of the simulator's node; topics are in its namespace
    std::string elevation_topic;      ///< of keyframes; empty: <node>/elevation
    std::string updates_topic;        ///< empty: <node>/elevation_updates
    std::string request_topic;        ///< empty: <node>/request_keyframe
    /// Whether messages are taken in by a thread of the client's own. Otherwise by the callback queue of the
    /// node handle that was given (ros::spin(), a spinner, a nodelet's threads).
    bool own_thread = true;
    std::uint32_t update_queue = 200;  ///< updates that may wait to be taken in; more are a gap
    double shortest_pause = 0.5;       ///< between requests for a keyframe [s], > 0
    double longest_pause = 10;         ///< it doubles up to this while requests do not help for long [s]
    /// Called after each change of cells, one at a time and in order, on the thread that takes messages in.
    /// It may use the client, but not destroy it, and must not throw. While it runs no message is taken in.
    std::function<void(const MapChange&)> on_change;
  };

  struct Statistics : StreamCounts {
    std::uint64_t requests = 0;  ///< times that a keyframe was asked for
    /// From the time at which a state was reached to its being readable here, of updates [s of ROS time]:
    /// last, mean and largest; 0 before the first. Clocks of two machines differ: so does this.
    double latency = 0, mean_latency = 0, largest_latency = 0;
  };

  /// Subscribes. Waits for the master if there is none, but not for the node. Throws ConfigError for options
  /// that cannot be.
  explicit TerrainClient(const ros::NodeHandle& node = ros::NodeHandle());
  TerrainClient(const ros::NodeHandle& node, Options options);
  /// Ends after the message that is being taken in.
  ~TerrainClient();
  TerrainClient(const TerrainClient&) = delete;
  TerrainClient& operator=(const TerrainClient&) = delete;

  /// The newest map; null before the first keyframe. For questions that belong together: it never changes.
  std::shared_ptr<const ElevationMap> map() const;
  /// Of the newest map, as ElevationMap's; none without one.
  std::optional<double> elevation(double x, double y) const;
  std::optional<geometry_msgs::Vector3> normal(double x, double y) const;
  std::optional<double> slope(double x, double y) const;

  /// Whether nothing is known to be missing: false before the first keyframe and between a gap and the next
  /// one.
  bool up_to_date() const;
  /// Whether someone publishes keyframes.
  bool connected() const;
  /// Waits for the first map, at most `timeout` seconds of wall time. False if there is none then, or ROS
  /// ends. Another thread must take messages in.
  bool wait_for_terrain(double timeout) const;
  /// Waits for a map of this step or a later one. False as above.
  bool wait_for_step(std::uint64_t step, double timeout) const;
  Statistics statistics() const;

 private:
  void subscribe_to_keyframes();
  void ask_for_keyframe();
  void take(const ElevationGrid::ConstPtr& keyframe);
  void take(const ElevationUpdate::ConstPtr& update);
  void tell(const MapChange& change, const ros::Time* update_stamp);
  bool wait(const std::function<bool()>& happened, double timeout) const;
  void thread();
  bool keyframe_is_due();

  Options options_;
  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  ros::Publisher asks_;
  ros::Subscriber updates_;

  std::mutex taking_;  ///< held while a message is taken in and told of; readers never wait for it
  ElevationAssembler assembler_;
  KeyframeRequests requests_;

  mutable std::mutex mutex_;  ///< of what readers see; held for an instant
  mutable std::condition_variable changed_;
  std::shared_ptr<const ElevationMap> map_;
  Statistics statistics_;
  std::uint64_t timed_ = 0;  ///< updates in the mean latency
  bool up_to_date_ = false, stopping_ = false;
  ros::Subscriber keyframes_;
  std::thread thread_;
};

}  // namespace desert_sim
