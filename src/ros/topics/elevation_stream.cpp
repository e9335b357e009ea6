#include "src/ros/topics/elevation_stream.hpp"

#include <boost/make_shared.hpp>

#include "src/ros/conversion/messages.hpp"
#include "src/ros/topics/elevation_tiles.hpp"

namespace desert_sim {

ElevationStream::ElevationStream(ros::Publisher keyframes, ros::Publisher updates, std::string frame)
    : keyframes_(std::move(keyframes)), updates_(std::move(updates)), frame_(std::move(frame)) {}

void ElevationStream::configure(double threshold, int tile) {
  threshold_ = threshold;
  tile_ = tile;
}

void ElevationStream::ask_for_update(StateQuery& held) {
  held.changes = true;
  held.threshold = threshold_;
  held.tile = tile_;
  starts_without_ = keyframes_.getNumSubscribers() == 0;
  held.then = starts_without_ ? StateQuery::Then::present_if_none : StateQuery::Then::as_before;
}

void ElevationStream::ask_for_keyframe(StateQuery& held) {
  starts_without_ = false;
  held.then = updates_.getNumSubscribers() > 0 ? StateQuery::Then::present : StateQuery::Then::none;
}

void ElevationStream::start_keyframe() {
  ++keyframe_;
  sequence_ = 0;
}

void ElevationStream::publish_keyframe(const TerrainState& state) {
  start_keyframe();
  keyframes_.publish(elevation_message(state, frame_, keyframe_));
}

bool ElevationStream::publish_update(const TerrainState& state) {
  if (!state.changes) {
    if (!starts_without_) return false;
    start_keyframe();
  }
  ElevationUpdatePtr message = boost::make_shared<ElevationUpdate>();
  message->header = header_of(state.moment, frame_);
  message->step = state.snapshot->step;
  message->sim_time = state.snapshot->time;
  message->keyframe = keyframe_;
  message->sequence = ++sequence_;
  if (state.changes)
    for (const TileChange& change : state.changes->tiles) message->tiles.push_back(tile_message(change));
  updates_.publish(message);
  return true;
}

}  // namespace desert_sim
