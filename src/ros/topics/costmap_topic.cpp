/// ~costmap and ~costmap_updates: the costs of the terrain for a rover, as costmap_2d's static layer takes
/// them: whole maps (keyframes), and rectangles of what has changed since.

#include <map_msgs/OccupancyGridUpdate.h>
#include <nav_msgs/OccupancyGrid.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <deque>

#include "src/ros/conversion/messages.hpp"
#include "src/ros/topics/covering_boxes.hpp"
#include "src/ros/topics/topic_list.hpp"

namespace desert_sim {

namespace {

/// The costs that subscribers hold, and which of them were sent lately. The simulation keeps the same costs
/// and answers what subscribers lack, tile by tile; they are kept here too, because rectangles have to have
/// all their cells.
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
  /// Takes them in. What changes of a terrain that subscribers know waits to be sent.
  void apply(const CostChanges& changes, const TerrainState& state, SteadyClock::time_point now) {
    const bool known = match_terrain(state);
    if (!known) {
      if (!costs_.empty()) replaced_ = now;
      terrain_ = state.moment.terrain;
      width_ = state.snapshot->width;
      height_ = state.snapshot->height;
      costs_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), cell_cost::unknown);
      sent_.clear();
      waiting_.clear();
    }
    const std::vector<CellBox> changed = changes.write_to(costs_, width_);
    if (known) waiting_.insert(waiting_.end(), changed.begin(), changed.end());
  }

  /// Boxes that have changed and were not sent since, the oldest first.
  const std::vector<CellBox>& waiting() const { return waiting_; }
  void note_sent(const CellBox& cells, SteadyClock::time_point now) {
    sent_.push_back({now, cells});
    waiting_.erase(std::remove_if(waiting_.begin(), waiting_.end(),
                                  [&](const CellBox& box) { return cells.contains(box); }),
                   waiting_.end());
  }
  /// A box with all cells that were noted as sent less than `time` before `now`.
  CellBox sent_within(std::chrono::duration<double> time, SteadyClock::time_point now) {
    while (!sent_.empty() && now - sent_.front().time > time) sent_.pop_front();
    CellBox cells;
    for (const Sent& sent : sent_) cells = cells.united_with(sent.cells);
    return cells;
  }
  bool terrain_replaced_within(std::chrono::duration<double> time, SteadyClock::time_point now) const {
    return now - replaced_ < time;
  }

 private:
  struct Sent {
    SteadyClock::time_point time;
    CellBox cells;
  };

  int width_ = 0, height_ = 0;
  std::vector<std::int8_t> costs_;
  std::uint64_t terrain_ = 0;  ///< counter of Moment
  std::vector<CellBox> waiting_;
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
  const SubscriberCosts& held() const { return held_; }

  double rate() const override { return parameters().maps.parameters.costmap_keyframe_rate; }
  void add_to(StateQuery& query) override { query.costs.whole = true; }
  bool publish(const TerrainState& state) override {
    held_.apply(*state.whole_costs, state, now());
    publish_held(state);
    return true;
  }
  void publish_held(const TerrainState& state) {
    held_.note_sent(held_.all_cells(), now());
    publisher_.publish(costmap_message(held_, state, frame()));
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
  bool is_refreshed() const override { return false; }
  /// Rectangles in turn are never nearer in time than their spacing.
  double pace() const override {
    const MapParameters& p = parameters().maps.parameters;
    if (p.costmap_update_rectangles == 1) return rate();
    const double fastest = 1 / p.costmap_update_spacing;
    return has_backlog() ? fastest : std::min(rate(), fastest);
  }
  bool only_after_change() const override { return !has_backlog(); }
  bool may_be_early() const override { return false; }  // a costmap_2d wants them apart
  void add_to(StateQuery& query) override {
    query.costs.update = true;
    query.costs.threshold = parameters().maps.parameters.costmap_update_threshold;
  }
  /// Publishes a rectangle with costs that differ from what subscribers hold; if they are far apart, with
  /// those that have waited longest, and the others follow after `costmap_update_spacing`.
  bool publish(const TerrainState& state) override {
    return publish_rectangle(state, parameters().maps.parameters.costmap_update_rectangles);
  }
  bool publish_all(const TerrainState& state) override { return publish_rectangle(state, 1); }

 private:
  /// One of at most `most` rectangles that have all cells which wait. Publishes nothing if none does, or if a
  /// whole map is due first, because subscribers hold none, or one of another terrain. Soon after the terrain
  /// was replaced, a whole map goes out instead: a message on one topic may overtake one on another, and
  /// costmap_2d writes an update that does not fit its map past the end of that map.
  bool publish_rectangle(const TerrainState& state, int most) {
    SubscriberCosts& held = keyframes_.held();
    // There is no update if the simulation keeps no costs: it forgets them when nobody has asked for long.
    const CostChanges& changes = state.cost_update ? *state.cost_update : *state.whole_costs;
    // Updates start from these costs if there were none of this terrain, even if nobody gets a whole map.
    const bool continues = held.match_terrain(state);
    const SteadyClock::time_point time = now();
    held.apply(changes, state, time);
    if (!continues || held.waiting().empty()) return false;
    if (held.terrain_replaced_within(repeat_time(), time) && keyframes_.has_subscribers()) {
      keyframes_.publish_held(state);
      return true;
    }
    const CellBox oldest = held.waiting().front();
    CellBox changed;
    for (const CellBox& rectangle : covering_boxes(held.waiting(), most, worth_a_message))
      if (changed.empty() && rectangle.contains(oldest)) changed = rectangle;
    const CellBox box = changed.united_with(held.sent_within(repeat_time(), time));
    held.note_sent(changed, time);
    publisher_.publish(update_message(held, box, state, frame()));
    return true;
  }

  static constexpr long worth_a_message = 1024;  // cells, the bytes of half a packet

  /// Whether rectangles wait, even if the state has not changed since.
  bool has_backlog() const { return !keyframes_.held().waiting().empty(); }
  /// A costmap_2d that receives two messages between two of its own cycles looks at the cells of the second
  /// one only. So what was sent less than one and a half periods ago is part of the next rectangle too, where
  /// a subscriber's cycle may be as long as the period of updates. Rectangles in turn rely on their spacing.
  std::chrono::duration<double> repeat_time() const {
    const MapParameters& p = parameters().maps.parameters;
    return std::chrono::duration<double>(p.costmap_update_rectangles > 1
                                             ? p.costmap_update_spacing
                                             : 1.5 / (p.costmap_update_rate > 0 ? p.costmap_update_rate : 1));
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
