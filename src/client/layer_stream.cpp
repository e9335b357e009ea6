#include "include/desert_sim/client/layer_stream.hpp"

#include <ros/console.h>
#include <ros/init.h>
#include <ros/master.h>
#include <ros/this_node.h>
#include <ros/xmlrpc_manager.h>
#include <std_msgs/Empty.h>
#include <std_msgs/String.h>

#include <algorithm>
#include <type_traits>

#include "src/client/recycled_messages.hpp"
#include "src/client/ros_time.hpp"

namespace desert_sim {

LayerStream::LayerStream(StreamContext& context, std::string layer, Topics topics)
    : context_(context),
      layer_(std::move(layer)),
      topics_(std::move(topics)),
      requests_(context.shortest_pause, context.longest_pause) {}

bool LayerStream::is_elevation() const { return layer_ == "elevation"; }

// ---- messages ----

/// The time that an update shows; null for a keyframe, whose way takes longer and does not count.
template <class Message>
const ros::Time* update_stamp(const Message& message) {
  const bool is_update = std::is_same_v<Message, ElevationUpdate> || std::is_same_v<Message, LayerUpdate>;
  return is_update ? &message.header.stamp : nullptr;
}

template <class Message>
void LayerStream::process(const boost::shared_ptr<const Message>& message) {
  const std::lock_guard<std::mutex> one_at_a_time(context_.processing);
  publish_change(assembler_.process(message), update_stamp(*message));
}

void LayerStream::publish_change(const MapChange& change, const ros::Time* update_stamp) {
  const StreamCounts& counts = assembler_.counts();
  std::string refusal, gap;
  {
    const std::lock_guard<std::mutex> lock(context_.mutex);
    if (closed_) return;
    if (counts.refused != statistics_.refused) refusal = counts.last_refusal;
    if (counts.gaps != statistics_.gaps) gap = counts.last_gap;
    static_cast<StreamCounts&>(statistics_) = counts;
    const KeyframeNeed need = assembler_.need();
    up_to_date_ = assembler_.map() && need != KeyframeNeed::lost && need != KeyframeNeed::restarted;
    if (change.map) map_ = change.map;
    if (change.map && update_stamp) note_latency(seconds_between(*update_stamp, ros::Time::now()));
    context_.changed.notify_all();
  }
  if (!refusal.empty())
    ROS_WARN_THROTTLE(5, "The terrain client rejected a message of the layer %s: %s", layer_.c_str(),
                      refusal.c_str());
  if (!gap.empty())
    ROS_WARN_THROTTLE(5, "The terrain client needs a new keyframe of the layer %s: %s", layer_.c_str(),
                      gap.c_str());
  if (change.map && context_.on_change &&
      (context_.tell_each_step || change.replaced || !change.cells.empty()))
    context_.on_change(change);
}

/// The caller holds the context's mutex.
void LayerStream::note_latency(double latency) {
  statistics_.latency = latency;
  statistics_.mean_latency += (latency - statistics_.mean_latency) / static_cast<double>(++latency_count_);
  statistics_.largest_latency = std::max(statistics_.largest_latency, latency);
}

// ---- subscriptions ----

template <class Message>
ros::Subscriber LayerStream::subscribe(const std::string& topic, std::uint32_t queue) {
  // A callback may run while the client forgets the stream.
  const auto process_message = [stream = weak_from_this()](const boost::shared_ptr<const Message>& message) {
    if (const std::shared_ptr<LayerStream> alive = stream.lock()) alive->process(message);
  };
  ros::SubscribeOptions options;
  options.initByFullCallbackType<const boost::shared_ptr<const Message>&>(topic, queue, process_message,
                                                                          RecycledMessages<Message>());
  options.transport_hints = ros::TransportHints().tcpNoDelay();
  return context_.node.subscribe(options);
}

void LayerStream::subscribe_to_keyframes() {
  // shutdown() waits for running callbacks, so no lock may be held here.
  keyframe_subscriber().shutdown();
  const ros::Subscriber anew = is_elevation() ? subscribe<ElevationGrid>(topics_.keyframes, 1)
                                              : subscribe<LayerGrid>(topics_.keyframes, 1);
  const std::lock_guard<std::mutex> lock(context_.mutex);
  keyframes_ = anew;
}

void LayerStream::subscribe_to_updates() {
  updates_.shutdown();
  updates_ = is_elevation() ? subscribe<ElevationUpdate>(topics_.updates, context_.update_queue)
                            : subscribe<LayerUpdate>(topics_.updates, context_.update_queue);
}

void LayerStream::start() {
  request_publisher_ = is_elevation() ? context_.node.advertise<std_msgs::Empty>(topics_.requests, 1)
                                      : context_.node.advertise<std_msgs::String>(topics_.requests, 10);
  subscribe_to_keyframes();
  subscribe_to_updates();
}

void LayerStream::stop() {
  updates_.shutdown();
  keyframe_subscriber().shutdown();
  request_publisher_.shutdown();
}

ros::Subscriber LayerStream::keyframe_subscriber() const {
  const std::lock_guard<std::mutex> lock(context_.mutex);
  return keyframes_;
}

std::optional<AwaitedTopic> LayerStream::awaited() const {
  const ros::Subscriber keyframes = keyframe_subscriber();
  {
    const std::lock_guard<std::mutex> lock(context_.mutex);
    if (map_) return std::nullopt;
  }
  return AwaitedTopic{keyframes ? keyframes.getTopic() : topics_.keyframes, keyframes.getNumPublishers() > 0};
}

bool LayerStream::connected() const { return keyframe_subscriber().getNumPublishers() > 0; }

void LayerStream::reconnect_if_due() {
  const Reconnection::Clock::time_point now = Reconnection::Clock::now();
  const bool keyframes_are_due = keyframe_reconnection_.due(connected(), now);
  const bool updates_are_due = update_reconnection_.due(updates_.getNumPublishers() > 0, now);
  // Subscribing without a master would block.
  if (!ros::ok() || !(keyframes_are_due || updates_are_due) || !ros::master::check()) return;
  if (keyframes_are_due) subscribe_to_keyframes();
  if (updates_are_due) subscribe_to_updates();
}

// ---- keyframes ----

void LayerStream::request_keyframe_if_due() {
  if (!keyframe_is_due()) return;
  bool by_message = request_publisher_.getNumSubscribers() > 0;
  {
    const std::lock_guard<std::mutex> lock(context_.mutex);
    by_message = by_message && !requested_by_message_;
    requested_by_message_ = by_message;  // what comes next is the other
    ++statistics_.requests;
  }
  if (by_message) {
    request_by_message();
  } else if (ros::master::check()) {  // subscribing without a master would block
    if (request_publisher_.getNumSubscribers() == 0) announce_requests();
    subscribe_to_keyframes();
  }
}

bool LayerStream::keyframe_is_due() {
  // Without a publisher there is nobody to ask, and a new publisher sends a keyframe anyway.
  if (!ros::ok() || !connected()) return false;
  const std::unique_lock<std::mutex> one_at_a_time(context_.processing, std::try_to_lock);
  if (!one_at_a_time) return false;  // a message is being processed, which may be the keyframe
  if (!requests_.due(assembler_.need(), KeyframeRequests::Clock::now())) return false;
  assembler_.keyframe_overdue();
  publish_change({}, nullptr);
  return true;
}

/// Makes the master tell the node anew who publishes requests. A node connects once when it is told so; if
/// that fails, because publishers of this process had just come and gone, it is not told again by itself.
void LayerStream::announce_requests() {
  XmlRpc::XmlRpcValue arguments, result, payload;
  arguments[0] = ros::this_node::getName();
  arguments[1] = request_publisher_.getTopic();
  arguments[2] = std::string(is_elevation() ? ros::message_traits::datatype<std_msgs::Empty>()
                                            : ros::message_traits::datatype<std_msgs::String>());
  arguments[3] = ros::XMLRPCManager::instance()->getServerURI();
  if (!ros::master::execute("registerPublisher", arguments, result, payload, false))
    ROS_WARN_THROTTLE(5, "The terrain client cannot tell the master that it publishes %s.",
                      request_publisher_.getTopic().c_str());
}

void LayerStream::request_by_message() {
  if (is_elevation()) {
    request_publisher_.publish(std_msgs::Empty());
    return;
  }
  std_msgs::String request;
  request.data = layer_;
  request_publisher_.publish(request);
}

}  // namespace desert_sim
