#include "src/client/elevation_assembler.hpp"

namespace desert_sim {

namespace {

// Limits of the updates that are kept until their keyframe arrives. Beyond them a new keyframe costs less.
constexpr std::size_t max_queued_updates = 256, max_queued_cells = std::size_t{1} << 24;

std::size_t cells_of(const ElevationUpdate& update) {
  std::size_t cells = 0;
  for (const ElevationTile& tile : update.tiles)
    cells += tile.data.size() + tile.changes.size() * (tile.bits == 4 ? 2 : 1);
  return cells;
}

std::string name_of(const std::pair<std::uint32_t, std::uint32_t>& number) {
  return "update " + std::to_string(number.second) + " of keyframe " + std::to_string(number.first);
}

}  // namespace

KeyframeNeed ElevationAssembler::need() const {
  if (!complete_) return KeyframeNeed::lost;
  return map_ && queued_updates_.empty() ? KeyframeNeed::none : KeyframeNeed::expected;
}

void ElevationAssembler::keyframe_overdue() {
  if (map_ && !queued_updates_.empty())
    lose("keyframe " + std::to_string(queued_updates_.back()->keyframe) +
         ", which updates build on, has not arrived");
}

// ---- keyframes ----

/// Whether this is the keyframe of the map once more: a latching publisher repeats its last message on every
/// new connection.
bool ElevationAssembler::is_repeated_keyframe(const ElevationGrid& keyframe) const {
  if (!map_ || sender_restarted_) return false;
  const ElevationMap::Info& held = map_->info();
  return keyframe.keyframe == held.keyframe && keyframe.step <= held.step &&
         !keyframe.header.stamp.isZero() && keyframe.header.stamp == keyframe_stamp_;
}

MapChange ElevationAssembler::take(const ElevationGrid::ConstPtr& keyframe) {
  if (const std::string fault = validation_error(*keyframe); !fault.empty()) return refuse(fault);
  MapChange change;
  change.map = std::make_shared<const ElevationMap>(keyframe, map_.get(), change.cells);
  if (is_repeated_keyframe(*keyframe)) {
    repeated_keyframe_map_ = change.map;
    ++counts_.late;
    return {};
  }
  keyframe_stamp_ = keyframe->header.stamp;
  return hold(change);
}

MapChange ElevationAssembler::hold(MapChange change) {
  if (map_ && change.map->info().keyframe <= map_->info().keyframe) ++counts_.restarts;
  change.replaced = !map_ || !change.map->same_geometry(*map_);
  map_ = change.map;
  repeated_keyframe_map_.reset();
  complete_ = true;
  sender_restarted_ = false;
  ++counts_.keyframes;
  apply_queued(change);
  return change;
}

/// Writes the waiting updates that build on the keyframe just taken. Updates of a later keyframe keep
/// waiting.
void ElevationAssembler::apply_queued(MapChange& change) {
  std::deque<ElevationUpdate::ConstPtr> waiting;
  waiting.swap(queued_updates_);
  queued_cells_ = 0;
  for (const ElevationUpdate::ConstPtr& update : waiting) {
    const bool of_a_node_before = update->header.stamp < keyframe_stamp_;
    if (of_a_node_before || update->keyframe < map_->info().keyframe) {
      ++counts_.unusable;
      continue;
    }
    const MapChange more = place(update);
    if (!more.map) continue;
    change.map = more.map;
    change.cells.include(more.cells);
  }
}

// ---- updates ----

/// Whether an update is older than the map. A restarted node also counts from 1, but its stamps are later.
bool ElevationAssembler::is_late(const ElevationUpdate& update) const {
  const ElevationMap::Info& held = map_->info();
  const bool before = update.keyframe < held.keyframe ||
                      (update.keyframe == held.keyframe && update.sequence <= held.sequence);
  return before && update.header.stamp <= held.stamp;
}

/// Whether an update is the next one in sequence.
bool ElevationAssembler::follows(const ElevationUpdate& update) const {
  const ElevationMap::Info& held = map_->info();
  return complete_ && update.keyframe == held.keyframe && update.sequence == held.sequence + 1 &&
         update.step >= held.step;
}

MapChange ElevationAssembler::take(const ElevationUpdate::ConstPtr& update) {
  if (const std::string fault = validation_error(*update); !fault.empty()) return refuse(fault);
  const Number before = last_received_;
  last_received_ = {update->keyframe, update->sequence};
  if (!map_) {
    keep(update);
    return {};
  }
  const ElevationMap::Info& held = map_->info();
  const bool of_another_run =
      !sender_restarted_ && update->keyframe == held.keyframe && update->step < held.step;
  if (last_received_ > before && !of_another_run) return place(update);
  while (!queued_updates_.empty()) drop_oldest_queued();
  return follows(*update) ? write(*update) : handle_restart(update, before);
}

MapChange ElevationAssembler::place(const ElevationUpdate::ConstPtr& update) {
  if (sender_restarted_) {
    keep(update);
    return {};
  }
  if (is_late(*update)) {
    ++counts_.late;
    return {};
  }
  const ElevationMap::Info& held = map_->info();
  if (update->keyframe > held.keyframe) {
    keep(update);
    return {};
  }
  if (update->keyframe < held.keyframe || update->sequence <= held.sequence)
    return handle_restart(update, {held.keyframe, held.sequence});
  if (update->sequence != held.sequence + 1)
    lose(name_of({held.keyframe, held.sequence + 1}) + " is missing: " + std::to_string(update->sequence) +
         " came next");
  if (!complete_) {
    ++counts_.unusable;
    return {};
  }
  return write(*update);
}

/// Handles an update whose number is not above the previous one. A connection preserves the order of its
/// messages, so the sender has restarted or replays a recording. If its keyframe arrived before this update
/// and was taken for a repetition, the map begins again with that keyframe; otherwise its keyframe is
/// missing.
MapChange ElevationAssembler::handle_restart(const ElevationUpdate::ConstPtr& update, const Number& from) {
  keep(update);
  if (repeated_keyframe_map_ && repeated_keyframe_map_->info().keyframe == update->keyframe) {
    const ElevationMap::Info& info = repeated_keyframe_map_->info();
    return hold({repeated_keyframe_map_, {0, 0, info.width, info.height}, false});
  }
  lose(name_of({update->keyframe, update->sequence}) + " came after " + name_of(from) +
       ": the sender has started anew");
  sender_restarted_ = true;
  return {};
}

MapChange ElevationAssembler::write(const ElevationUpdate& update) {
  if (const std::string fault = validation_error(update, map_->info()); !fault.empty()) return refuse(fault);
  MapChange change;
  change.map = map_ = map_->after(update);
  repeated_keyframe_map_.reset();  // it was only a repetition
  for (const ElevationTile& tile : update.tiles)
    change.cells.include({tile.x, tile.y, tile.width, tile.height});
  ++counts_.updates;
  return change;
}

void ElevationAssembler::keep(const ElevationUpdate::ConstPtr& update) {
  queued_updates_.push_back(update);
  queued_cells_ += cells_of(*update);
  while (queued_updates_.size() > max_queued_updates ||
         (queued_updates_.size() > 1 && queued_cells_ > max_queued_cells))
    drop_oldest_queued();
}

void ElevationAssembler::drop_oldest_queued() {
  queued_cells_ -= cells_of(*queued_updates_.front());
  queued_updates_.pop_front();
  ++counts_.unusable;
}

// ---- faults ----

/// A refused message leaves a gap: the map may lack the changes that it contained.
MapChange ElevationAssembler::refuse(const std::string& why) {
  ++counts_.refused;
  counts_.last_refusal = why;
  lose("refused " + why);
  return {};
}

void ElevationAssembler::lose(const std::string& why) {
  if (!map_ || !complete_) return;
  complete_ = false;
  ++counts_.gaps;
  counts_.last_gap = why;
}

}  // namespace desert_sim
