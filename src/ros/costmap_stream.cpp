#include "desert_sim/ros/costmap_stream.hpp"

#include <algorithm>
#include <boost/make_shared.hpp>

#include "desert_sim/ros/messages.hpp"

namespace desert_sim {

namespace {

std::vector<std::int8_t> costs(const Snapshot& s) {
  const std::vector<float>& worth = s.layers.at(Layer::traversability);
  std::vector<std::int8_t> all(worth.size());
  std::transform(worth.begin(), worth.end(), all.begin(), cost_of);
  return all;
}

}  // namespace

CostmapStream::CostmapStream(ros::Publisher keyframes, ros::Publisher updates, std::string frame)
    : keyframes_(std::move(keyframes)), updates_(std::move(updates)), frame_(std::move(frame)) {}

void CostmapStream::configure(double update_rate, int threshold) {
  repeat_ = std::chrono::duration<double>(1.5 / (update_rate > 0 ? update_rate : 1));
  held_.configure(threshold);
}

void CostmapStream::hold(const TerrainState& state, std::vector<std::int8_t> now) {
  held_.hold(state.snapshot->width, std::move(now));
  terrain_ = state.moment.terrain;
  sent_.clear();
}

bool CostmapStream::holds(const TerrainState& state) const {
  return !held_.empty() && terrain_ == state.moment.terrain && held_.width() == state.snapshot->width &&
         held_.size() == state.snapshot->layers.at(Layer::traversability).size();
}

CellBox CostmapStream::with_recent(const CellBox& cells) {
  const Clock::time_point now = Clock::now();
  while (!sent_.empty() && now - sent_.front().time > repeat_) sent_.pop_front();
  CellBox all = cells;
  for (const Sent& sent : sent_) all = all.with(sent.cells);
  sent_.push_back({now, cells});
  return all;
}

void CostmapStream::publish_keyframe(const TerrainState& state) {
  const Snapshot& s = *state.snapshot;
  if (!held_.empty() && !holds(state)) replaced_ = Clock::now();
  const std::vector<std::int8_t> now = costs(s);
  hold(state, now);
  with_recent({0, 0, s.width, s.height});
  nav_msgs::OccupancyGridPtr message = boost::make_shared<nav_msgs::OccupancyGrid>();
  message->header = header_of(state.moment, frame_);
  message->info.map_load_time = state.moment.stamp;
  message->info.resolution = static_cast<float>(s.cell_size);
  message->info.width = static_cast<std::uint32_t>(s.width);
  message->info.height = static_cast<std::uint32_t>(s.height);
  message->info.origin = origin_of(s);
  message->data = now;
  keyframes_.publish(message);
}

bool CostmapStream::publish_update(const TerrainState& state) {
  if (!holds(state)) {
    // Without keyframes, updates count from here on.
    if (keyframes_.getNumSubscribers() == 0) hold(state, costs(*state.snapshot));
    return false;
  }
  const std::vector<std::int8_t> now = costs(*state.snapshot);
  const CellBox changed = held_.changes(now);
  if (changed.empty()) return false;
  if (Clock::now() - replaced_ < repeat_ && keyframes_.getNumSubscribers() > 0) {
    publish_keyframe(state);
    return true;
  }
  const CellBox cells = with_recent(changed);
  map_msgs::OccupancyGridUpdatePtr message = boost::make_shared<map_msgs::OccupancyGridUpdate>();
  message->header = header_of(state.moment, frame_);
  message->x = cells.x0;
  message->y = cells.y0;
  message->width = static_cast<std::uint32_t>(cells.width());
  message->height = static_cast<std::uint32_t>(cells.height());
  message->data = held_.take(now, cells);
  updates_.publish(message);
  return true;
}

}  // namespace desert_sim
