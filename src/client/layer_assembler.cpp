#include "include/desert_sim/client/layer_assembler.hpp"

namespace desert_sim {

namespace {

// Limits of the updates that are kept until their keyframe arrives. Beyond them a new keyframe costs less.
constexpr std::size_t max_queued_updates = 256, max_queued_cells = std::size_t{1} << 24;

std::size_t cells_of(const MapUpdate& update) {
  std::size_t cells = 0;
  for (const LayerTile& tile : *update.tiles)
    cells += tile.data.size() + tile.changes.size() * (tile.bits == 4 ? 2 : 1);
  return cells;
}

std::string name_of(const std::pair<std::uint32_t, std::uint32_t>& number) {
  return "update " + std::to_string(number.second) + " of keyframe " + std::to_string(number.first);
}

}  // namespace

KeyframeNeed LayerAssembler::need() const {
  const bool at_first_update = !queued_updates_.empty() && queued_updates_.front().sequence == 1;
  if (sender_restarted_ && at_first_update) return KeyframeNeed::restarted;
  if (!complete_) return KeyframeNeed::lost;
  return map_ && queued_updates_.empty() ? KeyframeNeed::none : KeyframeNeed::expected;
}

void LayerAssembler::keyframe_overdue() {
  if (map_ && !queued_updates_.empty())
    record_gap("keyframe " + std::to_string(queued_updates_.back().keyframe) +
               ", on which received updates are based, has not arrived");
}

// ---- keyframes ----

/// Whether this is the keyframe of the map once more: a latching publisher repeats its last message on every
/// new connection.
bool LayerAssembler::is_repeated_keyframe(const MapInfo& keyframe) const {
  if (!map_ || sender_restarted_) return false;
  const MapInfo& held = map_->info();
  return keyframe.keyframe == held.keyframe && keyframe.step <= held.step && !keyframe.stamp.isZero() &&
         keyframe.stamp == keyframe_stamp_;
}

MapChange LayerAssembler::process(const ElevationGrid::ConstPtr& keyframe) {
  const std::string error = validation_error(*keyframe);
  return error.empty() ? take_keyframe(MapKeyframe(keyframe)) : refuse(error);
}

MapChange LayerAssembler::process(const LayerGrid::ConstPtr& keyframe) {
  const std::string error = validation_error(*keyframe);
  return error.empty() ? take_keyframe(MapKeyframe(keyframe)) : refuse(error);
}

MapChange LayerAssembler::take_keyframe(MapKeyframe keyframe) {
  const ros::Time stamp = keyframe.info.stamp;
  const bool repeated = is_repeated_keyframe(keyframe.info);
  MapChange change;
  change.map = std::make_shared<const LayerMap>(std::move(keyframe), map_.get(), change.cells);
  if (repeated) {
    repeated_keyframe_map_ = change.map;
    ++counts_.late;
    return {};
  }
  keyframe_stamp_ = stamp;
  return replace_map(change);
}

MapChange LayerAssembler::replace_map(MapChange change) {
  if (map_ && change.map->info().keyframe <= map_->info().keyframe) ++counts_.restarts;
  change.replaced = !map_ || !change.map->same_geometry(*map_);
  map_ = change.map;
  repeated_keyframe_map_.reset();
  complete_ = true;
  sender_restarted_ = false;
  ++counts_.keyframes;
  const std::shared_ptr<const LayerMap> base = queued_updates_.empty() ? nullptr : map_;
  apply_queued(change);
  base_map_ = base;
  return change;
}

/// Writes the waiting updates that build on the keyframe just taken. Updates of a later keyframe keep
/// waiting.
void LayerAssembler::apply_queued(MapChange& change) {
  std::deque<MapUpdate> waiting;
  waiting.swap(queued_updates_);
  queued_cells_ = 0;
  for (const MapUpdate& update : waiting) {
    const bool of_a_node_before = update.stamp < keyframe_stamp_;
    if (of_a_node_before || update.keyframe < map_->info().keyframe) {
      ++counts_.unusable;
      continue;
    }
    const MapChange more = apply_in_order(update);
    if (!more.map) continue;
    change.map = more.map;
    change.cells.include(more.cells);
  }
}

// ---- updates ----

/// Whether an update is older than the map. A restarted node also counts from 1, but its stamps are later.
bool LayerAssembler::is_late(const MapUpdate& update) const {
  const MapInfo& held = map_->info();
  const bool before = update.keyframe < held.keyframe ||
                      (update.keyframe == held.keyframe && update.sequence <= held.sequence);
  return before && update.stamp <= held.stamp;
}

/// Whether an update is the next one in sequence.
bool LayerAssembler::is_next_update(const MapUpdate& update) const {
  const MapInfo& held = map_->info();
  return complete_ && update.keyframe == held.keyframe && update.sequence == held.sequence + 1 &&
         update.step >= held.step;
}

MapChange LayerAssembler::process(const ElevationUpdate::ConstPtr& update) {
  const std::string error = validation_error(*update);
  return error.empty() ? take_update(MapUpdate(update)) : refuse(error);
}

MapChange LayerAssembler::process(const LayerUpdate::ConstPtr& update) {
  const std::string error = validation_error(*update);
  return error.empty() ? take_update(MapUpdate(update)) : refuse(error);
}

MapChange LayerAssembler::take_update(const MapUpdate& update) {
  const UpdateId before = last_received_;
  last_received_ = {update.keyframe, update.sequence};
  time_went_back_ = update.stamp < last_stamp_;
  last_stamp_ = update.stamp;
  if (!map_) {
    enqueue(update);
    return {};
  }
  const MapInfo& held = map_->info();
  const bool of_another_run =
      !sender_restarted_ && update.keyframe == held.keyframe && update.step < held.step;
  if (last_received_ > before && !of_another_run) return apply_in_order(update);
  while (!queued_updates_.empty()) drop_oldest_queued();
  return is_next_update(update) ? apply_update(update) : handle_restart(update, before);
}

MapChange LayerAssembler::apply_in_order(const MapUpdate& update) {
  if (sender_restarted_) {
    enqueue(update);
    return {};
  }
  if (is_late(update)) {
    ++counts_.late;
    return {};
  }
  const MapInfo& held = map_->info();
  if (update.keyframe > held.keyframe) {
    enqueue(update);
    return {};
  }
  if (update.keyframe < held.keyframe || update.sequence <= held.sequence)
    return handle_restart(update, {held.keyframe, held.sequence});
  if (update.sequence != held.sequence + 1)
    record_gap(name_of({held.keyframe, held.sequence + 1}) + " is missing: update " +
               std::to_string(update.sequence) + " arrived instead");
  if (!complete_) {
    ++counts_.unusable;
    return {};
  }
  return apply_update(update);
}

/// Handles an update whose number is not above the previous one. A connection preserves the order of its
/// messages, so the sender has restarted or replays a recording. If its keyframe arrived before this update
/// and was taken for a repetition, the map begins again with that keyframe; so it does if time went back,
/// because updates of the recording's turn before had waited for its keyframe. Otherwise its keyframe is
/// missing.
MapChange LayerAssembler::handle_restart(const MapUpdate& update, const UpdateId& from) {
  enqueue(update);
  const std::shared_ptr<const LayerMap> again =
      repeated_keyframe_map_ || !time_went_back_ ? repeated_keyframe_map_ : base_map_;
  if (again && again->info().keyframe == update.keyframe)
    return replace_map({again, {0, 0, again->info().width, again->info().height}, false});
  record_gap(name_of({update.keyframe, update.sequence}) + " arrived after " + name_of(from) +
             ": the sender has restarted");
  sender_restarted_ = true;
  return {};
}

MapChange LayerAssembler::apply_update(const MapUpdate& update) {
  if (const std::string error = validation_error(update, map_->info()); !error.empty()) return refuse(error);
  MapChange change;
  change.map = map_ = map_->with_update(update);
  repeated_keyframe_map_.reset();  // it was only a repetition
  base_map_.reset();               // what waited belongs to it
  for (const LayerTile& tile : *update.tiles) change.cells.include({tile.x, tile.y, tile.width, tile.height});
  ++counts_.updates;
  return change;
}

void LayerAssembler::enqueue(const MapUpdate& update) {
  queued_updates_.push_back(update);
  queued_cells_ += cells_of(update);
  while (queued_updates_.size() > max_queued_updates ||
         (queued_updates_.size() > 1 && queued_cells_ > max_queued_cells))
    drop_oldest_queued();
}

void LayerAssembler::drop_oldest_queued() {
  queued_cells_ -= cells_of(queued_updates_.front());
  queued_updates_.pop_front();
  ++counts_.unusable;
}

// ---- errors ----

/// A refused message leaves a gap: the map may lack the changes that it contained.
MapChange LayerAssembler::refuse(const std::string& why) {
  ++counts_.refused;
  counts_.last_refusal = why;
  record_gap("a message was rejected: " + why);
  return {};
}

void LayerAssembler::record_gap(const std::string& why) {
  if (!map_ || !complete_) return;
  complete_ = false;
  ++counts_.gaps;
  counts_.last_gap = why;
}

}  // namespace desert_sim
