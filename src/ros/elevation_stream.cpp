#include "desert_sim/ros/elevation_stream.hpp"

#include <algorithm>
#include <boost/make_shared.hpp>
#include <cmath>

#include "desert_sim/ros/messages.hpp"

namespace desert_sim {

void HeldElevation::hold(const Snapshot& snapshot) {
  width_ = snapshot.width;
  height_ = snapshot.height;
  held_ = snapshot.layers.at(Layer::elevation);
}

void HeldElevation::forget() {
  width_ = height_ = 0;
  held_ = std::vector<float>();
}

bool HeldElevation::holds(const Snapshot& snapshot) const {
  return !held_.empty() && width_ == snapshot.width && height_ == snapshot.height;
}

bool HeldElevation::differs(const std::vector<float>& now, const ElevationTile& tile) const {
  for (std::uint32_t y = tile.y; y < tile.y + tile.height; ++y) {
    const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_);
    for (std::size_t i = row + tile.x; i < row + tile.x + tile.width; ++i) {
      const bool known = !std::isnan(now[i]), was_known = !std::isnan(held_[i]);
      if (known != was_known || (known && std::abs(static_cast<double>(now[i]) - held_[i]) > threshold_))
        return true;
    }
  }
  return false;
}

std::vector<ElevationTile> HeldElevation::take_changes(const Snapshot& snapshot) {
  const std::vector<float>& now = snapshot.layers.at(Layer::elevation);
  std::vector<ElevationTile> changes;
  ElevationTile tile;
  for (int y = 0; y < height_; y += tile_)
    for (int x = 0; x < width_; x += tile_) {
      tile.x = static_cast<std::uint32_t>(x);
      tile.y = static_cast<std::uint32_t>(y);
      tile.width = static_cast<std::uint32_t>(std::min(tile_, width_ - x));
      tile.height = static_cast<std::uint32_t>(std::min(tile_, height_ - y));
      if (!differs(now, tile)) continue;
      changes.push_back(tile);
      for (std::uint32_t row = 0; row < tile.height; ++row) {
        const std::size_t first =
            static_cast<std::size_t>(tile.y + row) * static_cast<std::size_t>(width_) + tile.x;
        const auto begin = now.begin() + static_cast<std::ptrdiff_t>(first);
        changes.back().data.insert(changes.back().data.end(), begin, begin + tile.width);
        std::copy(begin, begin + tile.width, held_.begin() + static_cast<std::ptrdiff_t>(first));
      }
    }
  return changes;
}

ElevationStream::ElevationStream(ros::Publisher keyframes, ros::Publisher updates, std::string frame,
                                 double threshold, int tile)
    : keyframes_(std::move(keyframes)),
      updates_(std::move(updates)),
      frame_(std::move(frame)),
      held_(threshold, tile) {}

void ElevationStream::start_keyframe(const TerrainState& state) {
  ++keyframe_;
  sequence_ = 0;
  terrain_ = state.moment.terrain;
  if (updates_.getNumSubscribers() > 0) {
    held_.hold(*state.snapshot);
  } else {
    held_.forget();
  }
}

void ElevationStream::publish_keyframe(const TerrainState& state) {
  start_keyframe(state);
  keyframes_.publish(elevation_message(state, frame_, keyframe_));
}

bool ElevationStream::publish_update(const TerrainState& state) {
  if (!held_.holds(*state.snapshot) || terrain_ != state.moment.terrain) {
    if (keyframes_.getNumSubscribers() > 0) return false;
    start_keyframe(state);
    if (!held_.holds(*state.snapshot)) return false;  // the last subscriber has just gone
  }
  ElevationUpdatePtr message = boost::make_shared<ElevationUpdate>();
  message->header = header_of(state.moment, frame_);
  message->step = state.snapshot->step;
  message->sim_time = state.snapshot->time;
  message->keyframe = keyframe_;
  message->sequence = ++sequence_;
  message->tiles = held_.take_changes(*state.snapshot);
  updates_.publish(message);
  return true;
}

}  // namespace desert_sim
