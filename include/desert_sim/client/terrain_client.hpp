#pragma once
/// The live terrain of a desert_sim node, for other programs. The client subscribes to keyframes and updates
/// of the elevation and of other layers, keeps a map of each up to date, and answers queries from any thread.
///
///     ros::init(argc, argv, "my_planner");
///     desert_sim::TerrainClient::Options options;
///     options.layers.push_back("traversability");               // besides the elevation
///     desert_sim::TerrainClient terrain(ros::NodeHandle(), options);
///     if (!terrain.wait_for_terrain(10.0)) ...;                 // there is no node
///     // Elevation [m] in the frame terrain.map()->info().frame:
///     std::optional<double> z = terrain.elevation(12.0, 34.0);
///     std::optional<double> free = terrain.value("traversability", 12.0, 34.0);
///     // An immutable map of one moment:
///     std::shared_ptr<const desert_sim::LayerMap> map = terrain.map();
///
/// The client detects lost messages and requests a new keyframe; until it arrives, the last valid map stays.
/// It uses two kinds of request in turn: a message on the node's topic ~request_keyframe (for layers
/// ~layers/request_keyframe), and a new subscription to the keyframes, since publishers send the present
/// state to new subscribers. (roscpp makes no new connection while another subscriber in the process uses the
/// same topic, so the second kind alone is not enough.)

#include <ros/callback_queue.h>
#include <ros/node_handle.h>

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "desert_sim/client/layer_map.hpp"
#include "desert_sim/client/layer_stream.hpp"
#include "desert_sim/client/waiting_notice.hpp"

namespace desert_sim {

class TerrainClient {
 public:
  struct Options {
    std::string node = "desert_sim";  ///< name of the simulator's node, whose namespace has the topics
    /// The layers to subscribe to from the start: names of known_layers(). Another list than the default
    /// may leave the elevation out.
    std::vector<std::string> layers = {"elevation"};
    std::string elevation_topic;  ///< topic of keyframes; empty: <node>/elevation
    std::string updates_topic;    ///< topic of updates; empty: <node>/elevation_updates
    std::string request_topic;    ///< topic of requests; empty: <node>/request_keyframe
    /// Whether the client processes messages on its own thread. Otherwise they are processed by the callback
    /// queue of the given node handle (ros::spin(), a spinner, a nodelet's threads).
    bool own_thread = true;
    std::uint32_t update_queue = 200;  ///< size of the subscriber queue of updates; an overflow is a gap
    double shortest_pause = 0.5;       ///< shortest pause between keyframe requests [s], > 0
    double longest_pause = 10;         ///< limit of the pause, which doubles while requests do not help [s]
    /// Called after each change of cells of any layer, which map->info().layer names; in order and never
    /// concurrently, on the thread that processes messages. The function may use the client, but must not
    /// destroy it and must not throw. No message is processed while it runs.
    std::function<void(const MapChange&)> on_change;
    /// Whether on_change is also called when a message says that a map is still valid at a later step.
    bool tell_each_step = false;
  };

  using Statistics = StreamStatistics;

  /// Subscribes. Waits for the ROS master if there is none, but not for the node: while a topic does not
  /// come, a warning names it. Throws std::runtime_error for invalid options.
  explicit TerrainClient(const ros::NodeHandle& node = ros::NodeHandle());
  TerrainClient(const ros::NodeHandle& node, Options options);
  /// Waits for the message that is being processed.
  ~TerrainClient();
  TerrainClient(const TerrainClient&) = delete;
  TerrainClient& operator=(const TerrainClient&) = delete;

  // ---- The elevation.

  /// The newest map; null before the first keyframe. It is immutable, so that several queries on it agree.
  std::shared_ptr<const ElevationMap> map() const { return layer_map("elevation"); }
  /// The query of the same name on the newest map; empty if there is no map.
  std::optional<double> elevation(double x, double y) const { return value("elevation", x, y); }
  std::optional<geometry_msgs::Vector3> normal(double x, double y) const;
  std::optional<double> slope(double x, double y) const;

  // ---- Layers. All throw std::runtime_error for a name that is not known.

  /// The names of all layers, which every node of this version has: elevation, sand_depth, traversability, …
  /// A layer that the terrain does not have is 0 everywhere.
  static const std::vector<std::string>& known_layers();
  /// Subscribes to a layer; nothing happens if it is subscribed to already. From any thread, also in
  /// on_change. Its map comes later.
  void subscribe_layer(const std::string& name);
  /// Gives a layer and its map up; nothing happens if it is not subscribed to. From any thread, also in
  /// on_change. Maps that somebody has stay valid.
  void unsubscribe_layer(const std::string& name);
  /// The names of the layers that are subscribed to.
  std::vector<std::string> layers() const;
  /// The newest map of a layer; null before its first keyframe, and if the layer is not subscribed to.
  std::shared_ptr<const LayerMap> layer_map(const std::string& name) const;
  /// LayerMap::value() on that map, in the layer's unit; empty if there is no map.
  std::optional<double> value(const std::string& name, double x, double y) const;

  // ---- The state of all layers that are subscribed to, or of one.

  /// Whether no message is known to be missing: false before the first keyframe, and from a gap to the next
  /// keyframe. Of one layer false, too, if it is not subscribed to.
  bool up_to_date() const;
  bool up_to_date(const std::string& layer) const;
  /// Whether keyframes of all of them have a publisher.
  bool connected() const;
  /// Whether keyframes of this one have a publisher; false if it is not subscribed to.
  bool connected(const std::string& layer) const;
  /// Waits until each layer that is subscribed to has a map, at most `timeout` seconds of wall time. False if
  /// one has none by then, or if ROS shuts down. Messages must be processed by another thread meanwhile.
  bool wait_for_terrain(double timeout) const;
  /// Waits in the same way for maps of this step or a later one.
  bool wait_for_step(std::uint64_t step, double timeout) const;
  /// Counts of one layer; all 0 if it is not subscribed to.
  Statistics statistics(const std::string& layer = "elevation") const;

 private:
  std::shared_ptr<LayerStream> make_stream(const std::string& name);
  std::vector<std::shared_ptr<LayerStream>> streams() const;
  template <class Result, class Read>
  Result read(const std::string& name, Result without, const Read& read) const;
  bool all_streams(const std::function<bool(const LayerStream&)>& condition) const;
  bool wait(const std::function<bool(const LayerStream&)>& condition, double timeout) const;
  void run_thread();
  void start_and_stop_streams();
  void tell_what_is_awaited();

  Options options_;
  ros::CallbackQueue queue_;
  mutable StreamContext context_;
  WaitingNotice notice_;  ///< used by the client's thread only

  // Guarded by context_.mutex:
  std::map<std::string, std::shared_ptr<LayerStream>> streams_;  ///< by layer
  std::vector<std::shared_ptr<LayerStream>> retired_;            ///< of which the client's thread takes leave
  bool stopping_ = false, streams_changed_ = false;

  std::thread thread_;
};

}  // namespace desert_sim
