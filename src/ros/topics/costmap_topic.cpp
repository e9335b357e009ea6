/// ~costmap and ~costmap_updates: the costs of the terrain for a rover, as costmap_2d's static layer takes
/// them: whole maps (keyframes), and one rectangle for each update.

#include <map_msgs/OccupancyGridUpdate.h>
#include <nav_msgs/OccupancyGrid.h>

#include <boost/make_shared.hpp>
#include <deque>

#include "src/ros/conversion/messages.hpp"
#include "src/ros/topics/topic_list.hpp"

namespace desert_sim {

namespace {

/// The costs that subscribers hold, and which of them were sent lately. The simulation keeps the same costs
/// and answers what subscribers lack, tile by tile; they are kept here too, because the rectangle of an
/// update has to have all its cells.
class SubscriberCosts {
 public:
  /// Row-major from the south-west, of the size of the terrain.
  const std::vector<std::int8_t>& costs() const { return costs_; }
  CellBox all_cells() const { return {0, 0, width_, height_}; }
  int width() const { return width_; }

  /// Whether these are costs of the state's terrain.
  bool match_terrain(const TerrainState& state) const {
    return !costs_.empty() && terrain_ == state.moment.terrain && width_ == state.snapshot->width &&
           height_ == state.snapshot->height;
  }
  void apply(const CostChanges& changes, const TerrainState& state) {
    if (!match_terrain(state)) {
      if (!costs_.empty()) replaced_ = SteadyClock::now();
      terrain_ = state.moment.terrain;
      width_ = state.snapshot->width;
      height_ = state.snapshot->height;
      costs_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_),
                    held_costs::unknown_cost);
      sent_.clear();
    }
    changes.write_to(costs_, width_);
  }

  void note_sent(const CellBox& cells) { sent_.push_back({SteadyClock::now(), cells}); }
  /// A box with all cells that were noted as sent less than `time` ago.
  CellBox sent_within(std::chrono::duration<double> time) {
    while (!sent_.empty() && SteadyClock::now() - sent_.front().time > time) sent_.pop_front();
    CellBox cells;
    for (const Sent& sent : sent_) cells = cells.united_with(sent.cells);
    return cells;
  }
  bool terrain_replaced_within(std::chrono::duration<double> time) const {
    return SteadyClock::now() - replaced_ < time;
  }

 private:
  struct Sent {
    SteadyClock::time_point time;
    CellBox cells;
  };

  int width_ = 0, height_ = 0;
  std::vector<std::int8_t> costs_;
  std::uint64_t terrain_ = 0;         ///< counter of Moment
  std::deque<Sent> sent_;             ///< of the last time, without cells that were only sent again
  SteadyClock::time_point replaced_;  ///< when costs of another terrain took the place of the old ones
};

// ---- Messages.

nav_msgs::OccupancyGridPtr costmap_message(const SubscriberCosts& held, const TerrainState& state,
                                           const std::string& frame) {
  const Snapshot& s = *state.snapshot;
  nav_msgs::OccupancyGridPtr message = boost::make_shared<nav_msgs::OccupancyGrid>();
  message->header = header_of(state.moment, frame);
  message->info.map_load_time = state.moment.stamp;
  message->info.resolution = static_cast<float>(s.cell_size);
  message->info.width = static_cast<std::uint32_t>(s.width);
  message->info.height = static_cast<std::uint32_t>(s.height);
  message->info.origin = origin_of(s);
  message->data = held.costs();
  return message;
}

map_msgs::OccupancyGridUpdatePtr update_message(const SubscriberCosts& held, const CellBox& box,
                                                const TerrainState& state, const std::string& frame) {
  map_msgs::OccupancyGridUpdatePtr message = boost::make_shared<map_msgs::OccupancyGridUpdate>();
  message->header = header_of(state.moment, frame);
  message->x = box.x0;
  message->y = box.y0;
  message->width = static_cast<std::uint32_t>(box.width());
  message->height = static_cast<std::uint32_t>(box.height());
  message->data.reserve(static_cast<std::size_t>(box.width()) * static_cast<std::size_t>(box.height()));
  for (int y = box.y0; y < box.y1; ++y) {
    const auto first = held.costs().begin() + static_cast<std::ptrdiff_t>(y) * held.width() + box.x0;
    message->data.insert(message->data.end(), first, first + box.width());
  }
  return message;
}

// ---- Topics. Messages have no numbers: a subscriber needs one whole map and all updates since.

constexpr const char* costmap = "costmap";

class CostmapTopic : public MessageTopic<nav_msgs::OccupancyGrid> {
 public:
  CostmapTopic(const TopicContext& context, ros::Publisher latched)
      : MessageTopic(context, costmap), latched_(latched) {}
  SubscriberCosts& held() { return held_; }

  double rate() const override { return parameters().maps.parameters.costmap_keyframe_rate; }
  void add_to(StateQuery& query) override { query.costs.whole = true; }
  bool publish(const TerrainState& state) override {
    held_.apply(*state.whole_costs, state);
    publish_held(state);
    return true;
  }
  void publish_held(const TerrainState& state) {
    publisher_.publish(costmap_message(held_, state, frame()));
    held_.note_sent(held_.all_cells());
  }

 private:
  ros::Publisher latched_;  ///< publishes nothing: see add_costmap_topics()
  SubscriberCosts held_;
};

class CostmapUpdatesTopic : public MessageTopic<map_msgs::OccupancyGridUpdate> {
 public:
  /// A new subscriber needs a whole map first, which the updates are written over.
  CostmapUpdatesTopic(const TopicContext& context, CostmapTopic& keyframes)
      : MessageTopic(context, "costmap_updates", 10, keyframes), keyframes_(keyframes) {
    keyframes.set_updates(*this);
  }

  double rate() const override { return parameters().maps.parameters.costmap_update_rate; }
  void add_to(StateQuery& query) override {
    query.costs.update = true;
    query.costs.threshold = parameters().maps.parameters.costmap_update_threshold;
    query.costs.recent = query.costs.recent.united_with(keyframes_.held().sent_within(repeat_time()));
  }
  /// Publishes the smallest rectangle with all cells whose costs differ from what subscribers hold by more
  /// than the threshold, and with those that were sent a moment ago. Publishes nothing if no cell does, or if
  /// a whole map is due first, because subscribers hold none, or one of another terrain. Soon after the
  /// terrain was replaced, a whole map goes out instead: a message on one topic may overtake one on another,
  /// and costmap_2d writes an update that does not fit its map past the end of that map.
  bool publish(const TerrainState& state) override {
    SubscriberCosts& held = keyframes_.held();
    // There is no update if the simulation keeps no costs: it forgets them when nobody has asked for long.
    const CostChanges& changes = state.cost_update ? *state.cost_update : *state.whole_costs;
    // Updates start from these costs if there were none of this terrain, even if nobody gets a whole map.
    const bool continues = held.match_terrain(state);
    held.apply(changes, state);
    if (!continues || changes.box.empty()) return false;
    if (held.terrain_replaced_within(repeat_time()) && keyframes_.has_subscribers()) {
      keyframes_.publish_held(state);
      return true;
    }
    held.note_sent(changes.changed);
    publisher_.publish(update_message(held, changes.box, state, frame()));
    return true;
  }

 private:
  /// A costmap_2d that receives two messages between two of its own cycles looks at the cells of the second
  /// one only. So what was sent less than one and a half periods ago is part of the next rectangle too.
  std::chrono::duration<double> repeat_time() const {
    return std::chrono::duration<double>(1.5 / (rate() > 0 ? rate() : 1));
  }

  CostmapTopic& keyframes_;
};

}  // namespace

void add_costmap_topics(const TopicContext& context, TopicList& topics) {
  // move_base has two costmaps in one process, of which the second waits for a map and is no new subscriber
  // of ours. roscpp hands it the last message that there was, but only of a topic that was first advertised
  // as latched.
  ros::NodeHandle node = context.node;
  const ros::Publisher latched = node.advertise<nav_msgs::OccupancyGrid>(costmap, 1, true);
  auto keyframes = std::make_unique<CostmapTopic>(context, latched);
  // Updates are first in the list: where both are due, the last update of the old map goes out before the new
  // one.
  topics.push_back(std::make_unique<CostmapUpdatesTopic>(context, *keyframes));
  topics.push_back(std::move(keyframes));
}

}  // namespace desert_sim
