/// ~elevation and ~elevation_updates, ~layers/<name> and ~layers/<name>_updates: a layer as a whole
/// (keyframes), and the cells that changed since. The simulation keeps the values that subscribers hold, and
/// forgets them when its terrain is replaced.

#include <desert_sim/ElevationGrid.h>
#include <desert_sim/ElevationUpdate.h>
#include <desert_sim/LayerGrid.h>
#include <desert_sim/LayerUpdate.h>
#include <ros/console.h>
#include <std_msgs/Empty.h>
#include <std_msgs/String.h>

#include <algorithm>
#include <boost/make_shared.hpp>

#include "src/core/did_you_mean.hpp"
#include "src/ros/conversion/messages.hpp"
#include "src/ros/topics/layer_tile_message.hpp"
#include "src/ros/topics/topic_list.hpp"

namespace desert_sim {

namespace {

// ---- The two kinds of streams: their messages and parameters.

struct ElevationMessages {
  using Keyframe = ElevationGrid;
  using Update = ElevationUpdate;
  static constexpr bool repeats_keyframes = true;

  static double keyframe_rate(const PublisherSetup& p) { return p.topics.keyframe_rate; }
  static double update_rate(const PublisherSetup& p) { return p.topics.update_rate; }
  static double threshold(const PublisherSetup& p, const MapLayer&) { return p.topics.update_threshold; }
  static void set_layer(ElevationGrid&, const MapLayer&) {}
  static void set_layer(ElevationUpdate&, const MapLayer&) {}
  static std::vector<float>& values(ElevationGrid& keyframe) { return keyframe.elevation; }
};

struct LayerMessages {
  using Keyframe = LayerGrid;
  using Update = LayerUpdate;
  static constexpr bool repeats_keyframes = false;

  static double keyframe_rate(const PublisherSetup& p) { return p.topics.layer_keyframe_rate; }
  static double update_rate(const PublisherSetup& p) { return p.topics.layer_update_rate; }
  static double threshold(const PublisherSetup& p, const MapLayer& layer) {
    const auto chosen = p.layer_thresholds.find(layer.name);
    return chosen == p.layer_thresholds.end() ? layer.threshold : chosen->second;
  }
  static void set_layer(LayerGrid& keyframe, const MapLayer& layer) {
    keyframe.layer = layer.name;
    keyframe.unit = info(layer.layer).unit;
  }
  static void set_layer(LayerUpdate& update, const MapLayer& layer) { update.layer = layer.name; }
  static std::vector<float>& values(LayerGrid& keyframe) { return keyframe.data; }
};

// ---- Messages.

template <class Messages>
boost::shared_ptr<typename Messages::Keyframe> keyframe_message(const TerrainState& state,
                                                                const std::string& frame,
                                                                const MapLayer& layer,
                                                                std::uint32_t keyframe) {
  const Snapshot& s = *state.snapshot;
  auto message = boost::make_shared<typename Messages::Keyframe>();
  message->header = header_of(state.moment, frame);
  message->step = s.step;
  message->sim_time = s.time;
  message->keyframe = keyframe;
  message->width = static_cast<std::uint32_t>(s.width);
  message->height = static_cast<std::uint32_t>(s.height);
  message->cell_size = s.cell_size;
  message->origin = origin_of(s);
  Messages::set_layer(*message, layer);
  if (const std::vector<float>* const values = s.find(layer.layer))
    Messages::values(*message) = *values;
  else
    Messages::values(*message).assign(static_cast<std::size_t>(s.width) * static_cast<std::size_t>(s.height),
                                      0);
  return message;
}

/// An update without tiles if `changes` is null: it starts a keyframe that nobody gets.
template <class Messages>
boost::shared_ptr<typename Messages::Update> update_message(const TerrainState& state,
                                                            const LayerChanges* changes,
                                                            const std::string& frame, const MapLayer& layer,
                                                            std::uint32_t keyframe, std::uint32_t sequence) {
  auto message = boost::make_shared<typename Messages::Update>();
  message->header = header_of(state.moment, frame);
  message->step = state.snapshot->step;
  message->sim_time = state.snapshot->time;
  message->keyframe = keyframe;
  message->sequence = sequence;
  Messages::set_layer(*message, layer);
  if (changes)
    for (const TileChange& change : changes->tiles) message->tiles.push_back(tile_message(change));
  return message;
}

// ---- Topics.

/// What the two topics of a stream share: the number of the present keyframe, and of the last update to it.
struct StreamState {
  std::uint32_t keyframe = 0, update = 0;
  /// Whether the state that was asked for may start a keyframe that nobody gets.
  bool may_start_unpublished = false;
  /// Whether the simulation may hold values for subscribers.
  bool held = false;

  void start_keyframe() {
    ++keyframe;
    update = 0;
  }
};

template <class Messages>
class KeyframeTopic : public MessageTopic<typename Messages::Keyframe> {
 public:
  KeyframeTopic(const TopicContext& context, const std::string& name, const MapLayer& layer)
      : MessageTopic<typename Messages::Keyframe>(context, name), layer_(layer) {}
  /// roscpp has one connection for each topic and process: subscribers that share one are no new subscribers,
  /// and have to ask for a keyframe. A message that `names` accepts does so.
  template <class Request>
  void listen(const std::string& topic, std::uint32_t queue, bool (*names)(const Request&, const MapLayer&)) {
    ros::NodeHandle node = this->context().node;
    requests_ =
        node.subscribe<Request>(topic, queue, [this, names](const boost::shared_ptr<const Request>& request) {
          if (names(*request, layer_)) this->request();
        });
  }
  StreamState& state() { return state_; }
  const MapLayer& layer() const { return layer_; }

  double rate() const override { return Messages::keyframe_rate(this->parameters()); }
  bool repeats_for_updated_nodes() const override { return Messages::repeats_keyframes; }
  std::vector<Layer> layers() const override { return {layer_.layer}; }
  void add_to(StateQuery& query) override {
    state_.may_start_unpublished = false;
    state_.held = this->updates()->has_subscribers();
    query.held[layer_.layer].hold = state_.held ? HeldQuery::Hold::present : HeldQuery::Hold::none;
  }
  bool publish(const TerrainState& terrain) override {
    state_.start_keyframe();
    this->publisher_.publish(keyframe_message<Messages>(terrain, this->frame(), layer_, state_.keyframe));
    return true;
  }

 private:
  const MapLayer& layer_;
  StreamState state_;
  ros::Subscriber requests_;  ///< ends first: its callback uses the rest
};

template <class Messages>
class UpdatesTopic : public MessageTopic<typename Messages::Update> {
 public:
  /// A new subscriber needs a keyframe first, which the updates are written over.
  UpdatesTopic(const TopicContext& context, std::uint32_t queue, KeyframeTopic<Messages>& keyframes)
      : MessageTopic<typename Messages::Update>(context, keyframes.short_name() + "_updates", queue,
                                                keyframes),
        keyframes_(keyframes) {
    keyframes.set_updates(*this);
  }

  double rate() const override { return Messages::update_rate(this->parameters()); }
  bool is_refreshed() const override { return false; }
  void add_to(StateQuery& query) override {
    const MapLayer& layer = keyframes_.layer();
    HeldQuery& held = query.held[layer.layer];
    held.changes = true;
    held.tolerance = {static_cast<float>(Messages::threshold(this->parameters(), layer)),
                      layer.zero_is_special};
    held.tile = this->parameters().topics.update_tile;
    StreamState& stream = keyframes_.state();
    stream.may_start_unpublished = !keyframes_.has_subscribers();
    held.hold = stream.may_start_unpublished ? HeldQuery::Hold::present_if_none : HeldQuery::Hold::as_before;
    stream.held = true;
  }
  /// Publishes nothing if the simulation holds no values of subscribers and some of them listen to keyframes:
  /// then a keyframe is due first. If nobody listens to keyframes, one is started that nobody gets.
  bool publish(const TerrainState& terrain) override {
    StreamState& stream = keyframes_.state();
    const auto found = terrain.changes.find(keyframes_.layer().layer);
    const LayerChanges* const changes = found == terrain.changes.end() ? nullptr : found->second.get();
    if (!changes) {
      if (!stream.may_start_unpublished) return false;
      stream.start_keyframe();
    }
    this->publisher_.publish(update_message<Messages>(terrain, changes, this->frame(), keyframes_.layer(),
                                                      stream.keyframe, ++stream.update));
    return true;
  }
  void release() override {
    if (!keyframes_.state().held) return;
    keyframes_.state().held = false;
    this->context().simulation.forget(keyframes_.layer().layer);
  }

 private:
  KeyframeTopic<Messages>& keyframes_;
};

/// How many updates may wait for a slow subscriber; a subscriber that misses one asks for a keyframe. An
/// update is at most about as large as the whole layer.
std::uint32_t update_queue(const TopicContext& context) {
  constexpr std::size_t max_length = 100, min_length = 2, max_bytes = std::size_t{256} << 20;
  const TerrainState terrain = context.simulation.terrain({}).get();
  const std::size_t bytes = sizeof(float) * static_cast<std::size_t>(terrain.snapshot->width) *
                            static_cast<std::size_t>(terrain.snapshot->height);
  return static_cast<std::uint32_t>(std::clamp(max_bytes / bytes, min_length, max_length));
}

/// Updates are first in the list: where both are due, the last update of the old keyframe goes out before the
/// new keyframe.
template <class Messages>
KeyframeTopic<Messages>& add_stream(const TopicContext& context, TopicList& topics, const std::string& name,
                                    const MapLayer& layer, std::uint32_t queue) {
  auto keyframes = std::make_unique<KeyframeTopic<Messages>>(context, name, layer);
  topics.push_back(std::make_unique<UpdatesTopic<Messages>>(context, queue, *keyframes));
  KeyframeTopic<Messages>& added = *keyframes;
  topics.push_back(std::move(keyframes));
  return added;
}

bool names_elevation(const std_msgs::Empty&, const MapLayer&) { return true; }

bool names_layer(const std_msgs::String& request, const MapLayer& layer) {
  if (!find_map_layer(request.data))
    ROS_WARN_THROTTLE(5, "layers/request_keyframe: %s", not_one_of(request.data, map_layer_names()).c_str());
  return request.data == layer.name;
}

}  // namespace

void add_elevation_topics(const TopicContext& context, TopicList& topics) {
  const MapLayer& layer = *find_map_layer("elevation");
  add_stream<ElevationMessages>(context, topics, "elevation", layer, update_queue(context))
      .listen("request_keyframe", 1, names_elevation);
}

void add_layer_topics(const TopicContext& context, TopicList& topics) {
  const std::uint32_t queue = update_queue(context);
  for (const MapLayer& layer : map_layers)
    if (layer.layer != Layer::elevation)
      add_stream<LayerMessages>(context, topics, "layers/" + std::string(layer.name), layer, queue)
          .listen("layers/request_keyframe", map_layers.size(), names_layer);
}

}  // namespace desert_sim
