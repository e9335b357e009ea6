#pragma once
/// Builds maps from keyframes and updates, and detects missing messages. Keyframes and updates arrive over
/// separate connections, so an update can arrive before its keyframe, and the last update of a keyframe after
/// the next keyframe. The class uses no threads, no clock and no ROS graph, and is not thread-safe.

#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <utility>

#include "desert_sim/client/layer_map.hpp"

namespace desert_sim {

/// The effect of a message on the map.
struct MapChange {
  std::shared_ptr<const LayerMap> map;  ///< the new map; null if the message changed nothing
  /// The cells that may differ from the previous map; empty if only the map's time changed.
  LayerMap::Rectangle cells;
  bool replaced = false;  ///< the previous map had another frame, size or place, or none existed
};

/// Counts of the messages since the start.
struct StreamCounts {
  std::uint64_t keyframes = 0;  ///< keyframes that became the map
  std::uint64_t updates = 0;    ///< updates that were written into the map
  std::uint64_t late = 0;       ///< messages older than the map, which were ignored without loss
  std::uint64_t unusable = 0;   ///< ignored updates: after a gap, or without their keyframe
  std::uint64_t refused = 0;    ///< malformed messages, which were ignored
  std::uint64_t gaps = 0;       ///< how often messages were missing, so that a keyframe was needed
  std::uint64_t restarts = 0;   ///< how often the numbers of keyframes began again
  std::string last_refusal;     ///< reason for the last refusal; empty if there was none
  std::string last_gap;         ///< reason for the last gap; empty if there was none
};

/// Whether a keyframe is needed to continue.
enum class KeyframeNeed {
  none,
  expected,   ///< the first keyframe, or that of waiting updates, should arrive soon
  restarted,  ///< the sender has begun anew with the first update of a keyframe, which should arrive soon
  lost        ///< messages are missing: the map cannot be continued without a keyframe
};

class LayerAssembler {
 public:
  /// Takes a keyframe. The map keeps the message, which must not be modified afterwards.
  MapChange process(const ElevationGrid::ConstPtr& keyframe);
  MapChange process(const LayerGrid::ConstPtr& keyframe);
  /// Takes an update. It is kept until its keyframe arrives if that is not here yet.
  MapChange process(const ElevationUpdate::ConstPtr& update);
  MapChange process(const LayerUpdate::ConstPtr& update);
  /// Reports that the expected keyframe did not arrive in time. If there is a map, that counts as a gap.
  void keyframe_overdue();

  /// The last valid map, which stays after a gap; null before the first keyframe.
  const std::shared_ptr<const LayerMap>& map() const { return map_; }
  KeyframeNeed need() const;
  const StreamCounts& counts() const { return counts_; }

 private:
  using UpdateId = std::pair<std::uint32_t, std::uint32_t>;  ///< an update's keyframe number and sequence

  MapChange take_keyframe(MapKeyframe keyframe);
  MapChange take_update(const MapUpdate& update);
  bool is_repeated_keyframe(const MapInfo& keyframe) const;
  MapChange replace_map(MapChange change);
  bool is_late(const MapUpdate& update) const;
  bool is_next_update(const MapUpdate& update) const;
  MapChange apply_in_order(const MapUpdate& update);
  MapChange handle_restart(const MapUpdate& update, const UpdateId& from);
  MapChange refuse(const std::string& why);
  void record_gap(const std::string& why);
  void enqueue(const MapUpdate& update);
  void drop_oldest_queued();
  MapChange apply_update(const MapUpdate& update);
  void apply_queued(MapChange& change);

  std::shared_ptr<const LayerMap> map_;
  ros::Time keyframe_stamp_;       ///< stamp of the keyframe on which map_ is built
  bool complete_ = true;           ///< no update is missing after those in map_
  bool sender_restarted_ = false;  ///< the sender restarted; its keyframe is missing
  UpdateId last_received_{0, 0};   ///< number of the last update, whether used or not
  ros::Time last_stamp_;           ///< and its stamp
  bool time_went_back_ = false;    ///< the last update is older than the one before
  /// A map of the repeated keyframe, if the one on which map_ is built was sent again.
  std::shared_ptr<const LayerMap> repeated_keyframe_map_;
  /// A map of the keyframe on which map_ is built, if updates had waited for it.
  std::shared_ptr<const LayerMap> base_map_;
  std::deque<MapUpdate> queued_updates_;  ///< updates without their keyframe, in order of arrival
  std::size_t queued_cells_ = 0;          ///< cells of all tiles in queued_updates_
  StreamCounts counts_;
};

/// That of the elevation.
using ElevationAssembler = LayerAssembler;

}  // namespace desert_sim
