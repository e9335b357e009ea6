#include "src/client/elevation_assembler.hpp"

namespace desert_sim {

namespace {

// What may wait for a keyframe. Whoever loses more than this would be better off with the keyframe anyway.
constexpr std::size_t most_waiting = 256, most_waiting_cells = std::size_t{1} << 24;

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
  return map_ && waiting_.empty() ? KeyframeNeed::none : KeyframeNeed::expected;
}

void ElevationAssembler::keyframe_overdue() {
  if (map_ && !waiting_.empty())
    lose("keyframe " + std::to_string(waiting_.back()->keyframe) + ", which updates build on, has not come");
}

// ---- keyframes ----

/// A sender that latches its last message sends it again to whoever connects anew.
bool ElevationAssembler::is_held(const ElevationGrid& keyframe) const {
  if (!map_ || went_back_) return false;
  const ElevationMap::Info& held = map_->info();
  return keyframe.keyframe == held.keyframe && keyframe.step <= held.step &&
         !keyframe.header.stamp.isZero() && keyframe.header.stamp == keyframe_stamp_;
}

MapChange ElevationAssembler::take(const ElevationGrid::ConstPtr& keyframe) {
  if (const std::string fault = fault_of(*keyframe); !fault.empty()) return refuse(fault);
  MapChange change;
  change.map = std::make_shared<const ElevationMap>(keyframe, map_.get(), change.cells);
  if (is_held(*keyframe)) {
    sent_again_ = change.map;
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
  sent_again_.reset();
  complete_ = true;
  went_back_ = false;
  ++counts_.keyframes;
  write_waiting(change);
  return change;
}

/// Those that build on the keyframe that has just been taken; those of a later one wait on.
void ElevationAssembler::write_waiting(MapChange& change) {
  std::deque<ElevationUpdate::ConstPtr> waiting;
  waiting.swap(waiting_);
  waiting_cells_ = 0;
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

/// Older than what is held. A node that has started anew counts from the beginning too, but at a later time.
bool ElevationAssembler::is_late(const ElevationUpdate& update) const {
  const ElevationMap::Info& held = map_->info();
  const bool before = update.keyframe < held.keyframe ||
                      (update.keyframe == held.keyframe && update.sequence <= held.sequence);
  return before && update.header.stamp <= held.stamp;
}

/// Whether it is the one that what is held waits for.
bool ElevationAssembler::follows(const ElevationUpdate& update) const {
  const ElevationMap::Info& held = map_->info();
  return complete_ && update.keyframe == held.keyframe && update.sequence == held.sequence + 1 &&
         update.step >= held.step;
}

MapChange ElevationAssembler::take(const ElevationUpdate::ConstPtr& update) {
  if (const std::string fault = fault_of(*update); !fault.empty()) return refuse(fault);
  const Number before = newest_;
  newest_ = {update->keyframe, update->sequence};
  if (!map_) {
    keep(update);
    return {};
  }
  const ElevationMap::Info& held = map_->info();
  const bool of_another_run = !went_back_ && update->keyframe == held.keyframe && update->step < held.step;
  if (newest_ > before && !of_another_run) return place(update);
  while (!waiting_.empty()) drop_first_waiting();
  return follows(*update) ? write(*update) : go_back(update, before);
}

MapChange ElevationAssembler::place(const ElevationUpdate::ConstPtr& update) {
  if (went_back_) {
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
    return go_back(update, {held.keyframe, held.sequence});
  if (update->sequence != held.sequence + 1)
    lose(name_of({held.keyframe, held.sequence + 1}) + " is missing: " + std::to_string(update->sequence) +
         " came next");
  if (!complete_) {
    ++counts_.unusable;
    return {};
  }
  return write(*update);
}

/// Updates keep their order on their way: the sender has started anew, or plays its recording again. If its
/// keyframe was here first, and was taken for what was held already, that is where to begin.
MapChange ElevationAssembler::go_back(const ElevationUpdate::ConstPtr& update, const Number& from) {
  keep(update);
  if (sent_again_ && sent_again_->info().keyframe == update->keyframe) {
    const ElevationMap::Info& info = sent_again_->info();
    return hold({sent_again_, {0, 0, info.width, info.height}, false});
  }
  lose(name_of({update->keyframe, update->sequence}) + " came after " + name_of(from) +
       ": the sender has started anew");
  went_back_ = true;
  return {};
}

MapChange ElevationAssembler::write(const ElevationUpdate& update) {
  if (const std::string fault = fault_of(update, map_->info()); !fault.empty()) return refuse(fault);
  MapChange change;
  change.map = map_ = map_->after(update);
  sent_again_.reset();  // that was all it was
  for (const ElevationTile& tile : update.tiles)
    change.cells.include({tile.x, tile.y, tile.width, tile.height});
  ++counts_.updates;
  return change;
}

void ElevationAssembler::keep(const ElevationUpdate::ConstPtr& update) {
  waiting_.push_back(update);
  waiting_cells_ += cells_of(*update);
  while (waiting_.size() > most_waiting || (waiting_.size() > 1 && waiting_cells_ > most_waiting_cells))
    drop_first_waiting();
}

void ElevationAssembler::drop_first_waiting() {
  waiting_cells_ -= cells_of(*waiting_.front());
  waiting_.pop_front();
  ++counts_.unusable;
}

// ---- what goes wrong ----

/// A refused message leaves a hole: whatever it was, what is held is no longer known to be up to date.
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
