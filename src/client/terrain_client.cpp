#include "include/desert_sim/client/terrain_client.hpp"

#include <ros/console.h>
#include <ros/init.h>
#include <ros/master.h>
#include <ros/message_traits.h>
#include <ros/names.h>

#include <algorithm>
#include <chrono>
#include <initializer_list>

#include "src/core/did_you_mean.hpp"
#include "src/core/error.hpp"
#include "src/terrain/map_layers.hpp"

namespace desert_sim {

namespace {

using Clock = KeyframeRequests::Clock;

constexpr std::chrono::milliseconds poll_period{
    100};  // how often the client checks whether it needs a keyframe

Clock::duration duration_of(double seconds) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

/// Throws ConfigError.
void check_layer(const std::string& name) {
  if (!find_map_layer(name)) throw ConfigError("TerrainClient: layer " + not_one_of(name, map_layer_names()));
}

/// Checks the options and fills in empty topic names. Throws ConfigError.
TerrainClient::Options checked(TerrainClient::Options options) {
  if (options.elevation_topic.empty()) options.elevation_topic = options.node + "/elevation";
  if (options.updates_topic.empty()) options.updates_topic = options.node + "/elevation_updates";
  if (options.request_topic.empty()) options.request_topic = options.node + "/request_keyframe";
  const std::string layers = options.node + "/layers";
  for (const std::string* name : std::initializer_list<const std::string*>{
           &options.elevation_topic, &options.updates_topic, &options.request_topic, &layers}) {
    std::string why;
    if (!ros::names::validate(*name, why))
      throw ConfigError("TerrainClient: '" + *name + "' is not a valid topic name: " + why);
  }
  for (const std::string& layer : options.layers) check_layer(layer);
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
    : options_(checked(std::move(options))) {
  context_.node = node;
  if (options_.own_thread) context_.node.setCallbackQueue(&queue_);
  context_.update_queue = options_.update_queue;
  context_.shortest_pause = duration_of(options_.shortest_pause);
  context_.longest_pause = duration_of(options_.longest_pause);
  context_.on_change = options_.on_change;
  context_.tell_each_step = options_.tell_each_step;
  for (const std::string& layer : options_.layers) subscribe_layer(layer);
  for (const std::shared_ptr<LayerStream>& stream : streams()) stream->start();
  thread_ = std::thread([this] { run_thread(); });
}

TerrainClient::~TerrainClient() {
  {
    const std::lock_guard<std::mutex> lock(context_.mutex);
    stopping_ = true;
    context_.changed.notify_all();
  }
  queue_.disable();  // wakes its thread
  thread_.join();
  for (const std::shared_ptr<LayerStream>& stream : retired_) stream->stop();
  for (const auto& entry : streams_) entry.second->stop();  // waits for a callback on a queue of the caller
}

// ---- layers ----

const std::vector<std::string>& TerrainClient::known_layers() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    all.reserve(map_layers.size());
    for (const MapLayer& layer : map_layers) all.emplace_back(layer.name);
    return all;
  }();
  return names;
}

std::shared_ptr<LayerStream> TerrainClient::make_stream(const std::string& name) {
  LayerStream::Topics topics{options_.elevation_topic, options_.updates_topic, options_.request_topic};
  const std::string folder = options_.node + "/layers/";
  if (name != "elevation") topics = {folder + name, folder + name + "_updates", folder + "request_keyframe"};
  return std::make_shared<LayerStream>(context_, name, topics);
}

void TerrainClient::subscribe_layer(const std::string& name) {
  check_layer(name);
  const std::lock_guard<std::mutex> lock(context_.mutex);
  std::shared_ptr<LayerStream>& stream = streams_[name];
  if (stream) return;
  stream = make_stream(name);
  streams_changed_ = true;
  context_.changed.notify_all();
}

void TerrainClient::unsubscribe_layer(const std::string& name) {
  check_layer(name);
  const std::lock_guard<std::mutex> lock(context_.mutex);
  const auto found = streams_.find(name);
  if (found == streams_.end()) return;
  found->second->close();
  retired_.push_back(found->second);
  streams_.erase(found);
  streams_changed_ = true;
  context_.changed.notify_all();
}

std::vector<std::shared_ptr<LayerStream>> TerrainClient::streams() const {
  const std::lock_guard<std::mutex> lock(context_.mutex);
  std::vector<std::shared_ptr<LayerStream>> all;
  for (const auto& entry : streams_) all.push_back(entry.second);
  return all;
}

std::vector<std::string> TerrainClient::layers() const {
  const std::lock_guard<std::mutex> lock(context_.mutex);
  std::vector<std::string> names;
  for (const auto& entry : streams_) names.push_back(entry.first);
  return names;
}

// ---- queries ----

/// What `read` finds in the stream of a layer; `without` if there is none.
template <class Result, class Read>
Result TerrainClient::read(const std::string& name, Result without, const Read& read) const {
  check_layer(name);
  const std::lock_guard<std::mutex> lock(context_.mutex);
  const auto found = streams_.find(name);
  return found == streams_.end() ? without : read(*found->second);
}

std::shared_ptr<const LayerMap> TerrainClient::layer_map(const std::string& name) const {
  return read(name, std::shared_ptr<const LayerMap>(),
              [](const LayerStream& stream) { return stream.map(); });
}

std::optional<double> TerrainClient::value(const std::string& name, double x, double y) const {
  const std::shared_ptr<const LayerMap> now = layer_map(name);
  return now ? now->value(x, y) : std::nullopt;
}

std::optional<geometry_msgs::Vector3> TerrainClient::normal(double x, double y) const {
  const std::shared_ptr<const LayerMap> now = map();
  return now ? now->normal(x, y) : std::nullopt;
}

std::optional<double> TerrainClient::slope(double x, double y) const {
  const std::shared_ptr<const LayerMap> now = map();
  return now ? now->slope(x, y) : std::nullopt;
}

bool TerrainClient::up_to_date(const std::string& layer) const {
  return read(layer, false, [](const LayerStream& stream) { return stream.up_to_date(); });
}

TerrainClient::Statistics TerrainClient::statistics(const std::string& layer) const {
  return read(layer, Statistics(), [](const LayerStream& stream) { return stream.statistics(); });
}

bool TerrainClient::all_streams(const std::function<bool(const LayerStream&)>& condition) const {
  return std::all_of(streams_.begin(), streams_.end(),
                     [&](const auto& entry) { return condition(*entry.second); });
}

bool TerrainClient::up_to_date() const {
  const std::lock_guard<std::mutex> lock(context_.mutex);
  return all_streams([](const LayerStream& stream) { return stream.up_to_date(); });
}

bool TerrainClient::connected() const {
  const std::vector<std::shared_ptr<LayerStream>> all = streams();
  return std::all_of(all.begin(), all.end(), [](const auto& stream) { return stream->connected(); });
}

bool TerrainClient::connected(const std::string& layer) const {
  check_layer(layer);
  std::shared_ptr<LayerStream> stream;
  {
    const std::lock_guard<std::mutex> lock(context_.mutex);
    const auto found = streams_.find(layer);
    if (found != streams_.end()) stream = found->second;
  }
  return stream && stream->connected();
}

bool TerrainClient::wait_for_terrain(double timeout) const {
  return wait([](const LayerStream& stream) { return stream.map() != nullptr; }, timeout);
}

bool TerrainClient::wait_for_step(std::uint64_t step, double timeout) const {
  return wait([step](const LayerStream& stream) { return stream.map() && stream.map()->info().step >= step; },
              timeout);
}

bool TerrainClient::wait(const std::function<bool(const LayerStream&)>& condition, double timeout) const {
  const Clock::time_point end = Clock::now() + duration_of(std::clamp(timeout, 0.0, 1e8));
  std::unique_lock<std::mutex> lock(context_.mutex);
  while (!all_streams(condition)) {
    if (!ros::ok() || Clock::now() >= end) return false;
    context_.changed.wait_until(lock, std::min(end, Clock::now() + poll_period));
  }
  return true;
}

// ---- the client's thread ----

void TerrainClient::run_thread() {
  for (;;) {
    if (options_.own_thread)
      queue_.callAvailable(ros::WallDuration(std::chrono::duration<double>(poll_period).count()));
    {
      std::unique_lock<std::mutex> lock(context_.mutex);
      if (!options_.own_thread) context_.changed.wait_for(lock, poll_period, [this] { return stopping_; });
      if (stopping_) return;
    }
    start_and_stop_streams();
    for (const std::shared_ptr<LayerStream>& stream : streams()) {
      stream->reconnect_if_due();
      stream->request_keyframe_if_due();
    }
    tell_what_is_awaited();
  }
}

void TerrainClient::tell_what_is_awaited() {
  std::vector<AwaitedTopic> awaited;
  for (const std::shared_ptr<LayerStream>& stream : streams())
    if (std::optional<AwaitedTopic> topic = stream->awaited()) awaited.push_back(std::move(*topic));
  if (!notice_.due(!awaited.empty(), Clock::now()) || !ros::master::check()) return;
  ros::master::V_TopicInfo all;
  std::vector<std::string> published;
  if (ros::master::getTopics(all))
    for (const ros::master::TopicInfo& topic : all)
      if (topic.datatype == ros::message_traits::datatype<ElevationGrid>() ||
          topic.datatype == ros::message_traits::datatype<LayerGrid>())
        published.push_back(topic.name);
  ROS_WARN("%s", waiting_text(awaited, published).c_str());
}

/// Unsubscribing waits for a callback that runs, which may be the one that asked for it: so only this thread
/// does it, and holds no lock.
void TerrainClient::start_and_stop_streams() {
  std::vector<std::shared_ptr<LayerStream>> retired;
  {
    const std::lock_guard<std::mutex> lock(context_.mutex);
    if (!streams_changed_) return;
  }
  if (!ros::master::check()) return;  // subscribing without a master would block
  {
    const std::lock_guard<std::mutex> lock(context_.mutex);
    retired.swap(retired_);
    streams_changed_ = false;
  }
  for (const std::shared_ptr<LayerStream>& stream : retired) stream->stop();
  for (const std::shared_ptr<LayerStream>& stream : streams())
    if (!stream->started()) stream->start();
}

}  // namespace desert_sim
