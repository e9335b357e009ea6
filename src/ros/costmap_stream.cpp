#include "desert_sim/ros/costmap_stream.hpp"

#include <algorithm>
#include <boost/make_shared.hpp>
#include <cmath>

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

CostRectangle CostRectangle::with(const CostRectangle& other) const {
  if (empty()) return other;
  if (other.empty()) return *this;
  return {std::min(x0, other.x0), std::min(y0, other.y0), std::max(x1, other.x1), std::max(y1, other.y1)};
}

std::int8_t cost_of(float traversability) {
  if (std::isnan(traversability)) return -1;
  if (traversability <= 0) return 100;
  return static_cast<std::int8_t>(std::lround(99 * (1 - std::min(traversability, 1.0f))));
}

CostmapStream::CostmapStream(ros::Publisher keyframes, ros::Publisher updates, std::string frame,
                             std::chrono::duration<double> repeat)
    : keyframes_(std::move(keyframes)),
      updates_(std::move(updates)),
      frame_(std::move(frame)),
      repeat_(repeat) {}

void CostmapStream::hold(const TerrainState& state) {
  width_ = state.snapshot->width;
  height_ = state.snapshot->height;
  terrain_ = state.moment.terrain;
  held_ = costs(*state.snapshot);
  sent_.clear();
}

bool CostmapStream::holds(const TerrainState& state) const {
  return !held_.empty() && terrain_ == state.moment.terrain && width_ == state.snapshot->width &&
         height_ == state.snapshot->height;
}

CostRectangle CostmapStream::changes(const std::vector<std::int8_t>& now) const {
  CostRectangle all{width_, height_, 0, 0};
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + x;
      if (now[i] == held_[i]) continue;
      all = {std::min(all.x0, x), std::min(all.y0, y), std::max(all.x1, x + 1), y + 1};
    }
  return all;
}

CostRectangle CostmapStream::with_recent(const CostRectangle& cells) {
  const Clock::time_point now = Clock::now();
  while (!sent_.empty() && now - sent_.front().time > repeat_) sent_.pop_front();
  CostRectangle all = cells;
  for (const Sent& sent : sent_) all = all.with(sent.cells);
  sent_.push_back({now, cells});
  return all;
}

void CostmapStream::publish_keyframe(const TerrainState& state) {
  const Snapshot& s = *state.snapshot;
  if (!held_.empty() && !holds(state)) replaced_ = Clock::now();
  hold(state);
  with_recent({0, 0, s.width, s.height});
  nav_msgs::OccupancyGridPtr message = boost::make_shared<nav_msgs::OccupancyGrid>();
  message->header = header_of(state.moment, frame_);
  message->info.map_load_time = state.moment.stamp;
  message->info.resolution = static_cast<float>(s.cell_size);
  message->info.width = static_cast<std::uint32_t>(s.width);
  message->info.height = static_cast<std::uint32_t>(s.height);
  message->info.origin = origin_of(s);
  message->data = held_;
  keyframes_.publish(message);
}

bool CostmapStream::publish_update(const TerrainState& state) {
  if (!holds(state)) {
    if (keyframes_.getNumSubscribers() == 0) hold(state);  // updates count from here on
    return false;
  }
  std::vector<std::int8_t> now = costs(*state.snapshot);
  const CostRectangle changed = changes(now);
  if (changed.empty()) return false;
  if (Clock::now() - replaced_ < repeat_ && keyframes_.getNumSubscribers() > 0) {
    publish_keyframe(state);
    return true;
  }
  const CostRectangle cells = with_recent(changed);
  held_ = std::move(now);
  map_msgs::OccupancyGridUpdatePtr message = boost::make_shared<map_msgs::OccupancyGridUpdate>();
  message->header = header_of(state.moment, frame_);
  message->x = cells.x0;
  message->y = cells.y0;
  message->width = static_cast<std::uint32_t>(cells.x1 - cells.x0);
  message->height = static_cast<std::uint32_t>(cells.y1 - cells.y0);
  message->data.reserve(static_cast<std::size_t>(message->width) * message->height);
  for (int y = cells.y0; y < cells.y1; ++y) {
    const auto row = held_.begin() + static_cast<std::ptrdiff_t>(y) * width_;
    message->data.insert(message->data.end(), row + cells.x0, row + cells.x1);
  }
  updates_.publish(message);
  return true;
}

}  // namespace desert_sim
