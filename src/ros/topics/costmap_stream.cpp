#include "src/ros/topics/costmap_stream.hpp"

#include <boost/make_shared.hpp>

#include "src/ros/conversion/messages.hpp"

namespace desert_sim {

CostmapStream::CostmapStream(ros::Publisher keyframes, ros::Publisher updates, std::string frame)
    : keyframes_(std::move(keyframes)), updates_(std::move(updates)), frame_(std::move(frame)) {}

void CostmapStream::configure(double update_rate, int threshold) {
  repeat_ = std::chrono::duration<double>(1.5 / (update_rate > 0 ? update_rate : 1));
  threshold_ = threshold;
}

void CostmapStream::ask_for_update(CostQuery& query) {
  query.update = true;
  query.threshold = threshold_;
  while (!sent_.empty() && Clock::now() - sent_.front().time > repeat_) sent_.pop_front();
  for (const Sent& sent : sent_) query.recent = query.recent.with(sent.cells);
}

bool CostmapStream::holds(const TerrainState& state) const {
  return !held_.empty() && terrain_ == state.moment.terrain && width_ == state.snapshot->width &&
         height_ == state.snapshot->height;
}

void CostmapStream::take(const CostChanges& changes, const TerrainState& state) {
  if (!holds(state)) {
    if (!held_.empty()) replaced_ = Clock::now();
    terrain_ = state.moment.terrain;
    width_ = state.snapshot->width;
    height_ = state.snapshot->height;
    held_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_),
                 held_costs::unknown_cost);
    sent_.clear();
  }
  changes.write_to(held_, width_);
}

void CostmapStream::publish_keyframe(const TerrainState& state) {
  take(*state.whole_costs, state);
  publish_whole(state);
}

void CostmapStream::publish_whole(const TerrainState& state) {
  const Snapshot& s = *state.snapshot;
  nav_msgs::OccupancyGridPtr message = boost::make_shared<nav_msgs::OccupancyGrid>();
  message->header = header_of(state.moment, frame_);
  message->info.map_load_time = state.moment.stamp;
  message->info.resolution = static_cast<float>(s.cell_size);
  message->info.width = static_cast<std::uint32_t>(s.width);
  message->info.height = static_cast<std::uint32_t>(s.height);
  message->info.origin = origin_of(s);
  message->data = held_;
  keyframes_.publish(message);
  sent_.push_back({Clock::now(), {0, 0, width_, height_}});
}

void CostmapStream::publish_box(const CellBox& box, const TerrainState& state) {
  map_msgs::OccupancyGridUpdatePtr message = boost::make_shared<map_msgs::OccupancyGridUpdate>();
  message->header = header_of(state.moment, frame_);
  message->x = box.x0;
  message->y = box.y0;
  message->width = static_cast<std::uint32_t>(box.width());
  message->height = static_cast<std::uint32_t>(box.height());
  message->data.reserve(static_cast<std::size_t>(box.width()) * static_cast<std::size_t>(box.height()));
  for (int y = box.y0; y < box.y1; ++y) {
    const auto first = held_.begin() + static_cast<std::ptrdiff_t>(y) * width_ + box.x0;
    message->data.insert(message->data.end(), first, first + box.width());
  }
  updates_.publish(message);
}

bool CostmapStream::publish_update(const TerrainState& state) {
  const CostChanges& changes = state.cost_update ? *state.cost_update : *state.whole_costs;
  // Without keyframes, updates count from here on. (The simulation may hold nothing although the terrain is
  // the same: nobody asked for long.)
  const bool goes_on = holds(state);
  take(changes, state);
  if (!goes_on || changes.box.empty()) return false;
  if (Clock::now() - replaced_ < repeat_ && keyframes_.getNumSubscribers() > 0) {
    publish_whole(state);
    return true;
  }
  sent_.push_back({Clock::now(), changes.changed});
  publish_box(changes.box, state);
  return true;
}

}  // namespace desert_sim
