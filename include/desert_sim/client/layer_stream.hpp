#pragma once
/// One layer of a TerrainClient: its subscriptions, the map that they make, and requests for keyframes.

#include <ros/node_handle.h>

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "desert_sim/client/keyframe_requests.hpp"
#include "desert_sim/client/layer_assembler.hpp"
#include "desert_sim/client/reconnection.hpp"
#include "desert_sim/client/waiting_notice.hpp"

namespace desert_sim {

/// Counts of one layer since it was subscribed to.
struct StreamStatistics : StreamCounts {
  std::uint64_t requests = 0;  ///< number of keyframe requests
  /// Latency of updates [s of ROS time], from the stamp of a state to the map that contains it: last, mean
  /// and largest; 0 before the first update. An offset between the clocks of two machines adds to it.
  double latency = 0, mean_latency = 0, largest_latency = 0;
};

/// What the streams of a client share.
struct StreamContext {
  ros::NodeHandle node;
  std::uint32_t update_queue;
  KeyframeRequests::Clock::duration shortest_pause, longest_pause;
  std::function<void(const MapChange&)> on_change;  ///< may be empty
  bool tell_each_step = false;                      ///< also maps of which only the time has changed

  std::mutex processing;              ///< held while a message is processed; queries do not wait for it
  mutable std::mutex mutex;           ///< guards what all streams tell; held only briefly
  std::condition_variable changed{};  ///< something that the mutex guards has changed
};

class LayerStream : public std::enable_shared_from_this<LayerStream> {
 public:
  struct Topics {
    std::string keyframes, updates, requests;
  };

  /// Does nothing yet. The context must outlive all callbacks of this stream.
  LayerStream(StreamContext& context, std::string layer, Topics topics);

  // By one thread at a time, which holds none of the context's mutexes:

  /// Subscribes. Waits for the ROS master if there is none.
  void start();
  bool started() const { return static_cast<bool>(updates_); }
  /// Unsubscribes, and waits for a callback that runs on another thread.
  void stop();
  /// Requests a keyframe if one is due.
  void request_keyframe_if_due();
  /// Subscribes anew to a topic that has been without a publisher for a while.
  void reconnect_if_due();

  // By any thread that does not hold the context's mutex:

  /// Whether keyframes have a publisher.
  bool connected() const;
  /// The topic of keyframes while none has come.
  std::optional<AwaitedTopic> awaited() const;

  // By any thread that holds the context's mutex:

  const std::shared_ptr<const LayerMap>& map() const { return map_; }
  bool up_to_date() const { return up_to_date_; }
  const StreamStatistics& statistics() const { return statistics_; }
  /// No change is told from now on.
  void close() { closed_ = true; }

 private:
  template <class Message>
  ros::Subscriber subscribe(const std::string& topic, std::uint32_t queue);
  void subscribe_to_keyframes();
  void subscribe_to_updates();
  template <class Message>
  void process(const boost::shared_ptr<const Message>& message);
  ros::Subscriber keyframe_subscriber() const;
  void publish_change(const MapChange& change, const ros::Time* update_stamp);
  void note_latency(double latency);
  bool keyframe_is_due();
  void request_by_message();
  void announce_requests();
  bool is_elevation() const;

  StreamContext& context_;
  const std::string layer_;
  const Topics topics_;
  ros::Publisher request_publisher_;
  ros::Subscriber updates_;
  Reconnection keyframe_reconnection_, update_reconnection_;

  // Guarded by context_.processing:
  LayerAssembler assembler_;
  KeyframeRequests requests_;

  // Guarded by context_.mutex:
  ros::Subscriber keyframes_;
  std::shared_ptr<const LayerMap> map_;
  StreamStatistics statistics_;
  std::uint64_t latency_count_ = 0;  ///< number of updates in the mean latency
  bool up_to_date_ = false, closed_ = false;
  bool requested_by_message_ = false;  ///< the last time
};

}  // namespace desert_sim
