#include "src/client/terrain_client.hpp"

#include <ros/console.h>
#include <ros/init.h>
#include <ros/master.h>
#include <ros/names.h>
#include <std_msgs/Empty.h>

#include <algorithm>
#include <cmath>

#include "src/core/error.hpp"

namespace desert_sim {

namespace {

using Clock = KeyframeRequests::Clock;

constexpr std::chrono::milliseconds poll_period{
    100};  // how often the client checks whether it needs a keyframe

Clock::duration duration_of(double seconds) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

/// Checks the options and fills in empty topic names. Throws ConfigError.
TerrainClient::Options checked(TerrainClient::Options options) {
  if (options.elevation_topic.empty()) options.elevation_topic = options.node + "/elevation";
  if (options.updates_topic.empty()) options.updates_topic = options.node + "/elevation_updates";
  if (options.request_topic.empty()) options.request_topic = options.node + "/request_keyframe";
  for (const std::string* name : {&options.elevation_topic, &options.updates_topic, &options.request_topic}) {
    std::string why;
    if (!ros::names::validate(*name, why))
      throw ConfigError("TerrainClient: '" + *name + "' is not a valid topic name: " + why);
  }
  if (options.update_queue == 0) throw ConfigError("TerrainClient: update_queue is 0 (allowed: at least 1)");
  if (!(options.shortest_pause > 0 && options.longest_pause >= options.shortest_pause &&
        options.longest_pause <= 3600))
    throw ConfigError("TerrainClient: shortest_pause and longest_pause are " +
                      std::to_string(options.shortest_pause) + " and " +
                      std::to_string(options.longest_pause) +
                      " s (allowed: 0 < shortest_pause <= longest_pause <= 3600 s)");
  return options;
}

}  // namespace

TerrainClient::TerrainClient(const ros::NodeHandle& node) : TerrainClient(node, Options()) {}

TerrainClient::TerrainClient(const ros::NodeHandle& node, Options options)
    : options_(checked(std::move(options))),
      node_(node),
      requests_(duration_of(options_.shortest_pause), duration_of(options_.longest_pause)) {
  if (options_.own_thread) node_.setCallbackQueue(&queue_);
  request_publisher_ = node_.advertise<std_msgs::Empty>(options_.request_topic, 1);
  subscribe_to_keyframes();
  updates_ = node_.subscribe<ElevationUpdate>(
      options_.updates_topic, options_.update_queue,
      [this](const ElevationUpdate::ConstPtr& update) { process(update); }, ros::VoidConstPtr(),
      ros::TransportHints().tcpNoDelay());
  thread_ = std::thread([this] { run_thread(); });
}

TerrainClient::~TerrainClient() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
    changed_.notify_all();
  }
  queue_.disable();  // wakes its thread
  thread_.join();
  updates_.shutdown();  // on a queue of the caller, this waits for a running callback
  keyframes_.shutdown();
}

// ---- queries ----

std::shared_ptr<const ElevationMap> TerrainClient::map() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return map_;
}

std::optional<double> TerrainClient::elevation(double x, double y) const {
  const std::shared_ptr<const ElevationMap> now = map();
  return now ? now->elevation(x, y) : std::nullopt;
}

std::optional<geometry_msgs::Vector3> TerrainClient::normal(double x, double y) const {
  const std::shared_ptr<const ElevationMap> now = map();
  return now ? now->normal(x, y) : std::nullopt;
}

std::optional<double> TerrainClient::slope(double x, double y) const {
  const std::shared_ptr<const ElevationMap> now = map();
  return now ? now->slope(x, y) : std::nullopt;
}

bool TerrainClient::up_to_date() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return up_to_date_;
}

bool TerrainClient::connected() const {
  ros::Subscriber keyframes;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    keyframes = keyframes_;
  }
  return keyframes.getNumPublishers() > 0;
}

TerrainClient::Statistics TerrainClient::statistics() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return statistics_;
}

bool TerrainClient::wait_for_terrain(double timeout) const {
  return wait([this] { return map_ != nullptr; }, timeout);
}

bool TerrainClient::wait_for_step(std::uint64_t step, double timeout) const {
  return wait([this, step] { return map_ && map_->info().step >= step; }, timeout);
}

bool TerrainClient::wait(const std::function<bool()>& condition, double timeout) const {
  const Clock::time_point end = Clock::now() + duration_of(std::clamp(timeout, 0.0, 1e8));
  std::unique_lock<std::mutex> lock(mutex_);
  while (!condition()) {
    if (!ros::ok() || Clock::now() >= end) return false;
    changed_.wait_until(lock, std::min(end, Clock::now() + poll_period));
  }
  return true;
}

// ---- messages ----

void TerrainClient::process(const ElevationGrid::ConstPtr& keyframe) {
  const std::lock_guard<std::mutex> one_at_a_time(processing_mutex_);
  publish_change(assembler_.process(keyframe), nullptr);
}

void TerrainClient::process(const ElevationUpdate::ConstPtr& update) {
  const std::lock_guard<std::mutex> one_at_a_time(processing_mutex_);
  publish_change(assembler_.process(update), &update->header.stamp);
}

void TerrainClient::publish_change(const MapChange& change, const ros::Time* update_stamp) {
  const StreamCounts& counts = assembler_.counts();
  std::string refusal, gap;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (counts.refused != statistics_.refused) refusal = counts.last_refusal;
    if (counts.gaps != statistics_.gaps) gap = counts.last_gap;
    static_cast<StreamCounts&>(statistics_) = counts;
    up_to_date_ = assembler_.map() && assembler_.need() != KeyframeNeed::lost;
    if (change.map) map_ = change.map;
    if (change.map && update_stamp) {
      statistics_.latency = (ros::Time::now() - *update_stamp).toSec();
      statistics_.mean_latency += (statistics_.latency - statistics_.mean_latency) / ++latency_count_;
      statistics_.largest_latency = std::max(statistics_.largest_latency, statistics_.latency);
    }
    changed_.notify_all();
  }
  if (!refusal.empty()) ROS_WARN_THROTTLE(5, "The terrain client rejected a message: %s", refusal.c_str());
  if (!gap.empty()) ROS_WARN_THROTTLE(5, "The terrain client needs a new keyframe: %s", gap.c_str());
  if (change.map && options_.on_change && (change.replaced || !change.cells.empty()))
    options_.on_change(change);
}

// ---- keyframes ----

void TerrainClient::run_thread() {
  for (;;) {
    if (options_.own_thread)
      queue_.callAvailable(ros::WallDuration(std::chrono::duration<double>(poll_period).count()));
    {
      std::unique_lock<std::mutex> lock(mutex_);
      if (!options_.own_thread) changed_.wait_for(lock, poll_period, [this] { return stopping_; });
      if (stopping_) return;
    }
    if (keyframe_is_due()) request_keyframe();
  }
}

bool TerrainClient::keyframe_is_due() {
  // Without a publisher there is nobody to ask, and a new publisher sends a keyframe anyway.
  if (!ros::ok() || !connected()) return false;
  const std::unique_lock<std::mutex> one_at_a_time(processing_mutex_, std::try_to_lock);
  if (!one_at_a_time) return false;  // a message is being processed, which may be the keyframe
  if (!requests_.due(assembler_.need(), Clock::now())) return false;
  assembler_.keyframe_overdue();
  publish_change({}, nullptr);
  return true;
}

void TerrainClient::request_keyframe() {
  bool by_message = request_publisher_.getNumSubscribers() > 0;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    by_message = by_message && statistics_.requests % 2 == 0;
    ++statistics_.requests;
  }
  if (by_message) {
    request_publisher_.publish(std_msgs::Empty());
  } else if (ros::master::check()) {  // subscribing without a master would block
    subscribe_to_keyframes();
  }
}

void TerrainClient::subscribe_to_keyframes() {
  ros::Subscriber before;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    before = keyframes_;
  }
  // shutdown() waits for running callbacks, so no lock may be held here.
  before.shutdown();
  const ros::Subscriber anew = node_.subscribe<ElevationGrid>(
      options_.elevation_topic, 1, [this](const ElevationGrid::ConstPtr& keyframe) { process(keyframe); },
      ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
  const std::lock_guard<std::mutex> lock(mutex_);
  keyframes_ = anew;
}

}  // namespace desert_sim
