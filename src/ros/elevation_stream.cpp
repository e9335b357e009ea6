#include "desert_sim/ros/elevation_stream.hpp"

#include <boost/make_shared.hpp>

#include "desert_sim/ros/messages.hpp"

namespace desert_sim {

ElevationStream::ElevationStream(ros::Publisher keyframes, ros::Publisher updates, std::string frame)
    : keyframes_(std::move(keyframes)), updates_(std::move(updates)), frame_(std::move(frame)) {}

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
