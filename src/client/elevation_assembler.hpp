#pragma once
/// Puts keyframes and updates together to maps, and notices what is missing between them. The two kinds come
/// over connections of their own, so that an update may be here before its keyframe, and the last update of a
/// keyframe after the next one. No threads, no clock, no ROS graph: one caller at a time.

#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <utility>

#include "src/client/elevation_map.hpp"

namespace desert_sim {

/// What a message changed.
struct MapChange {
  std::shared_ptr<const ElevationMap> map;  ///< the new map; null if there is none
  ElevationMap::Rectangle cells;  ///< those that may differ from the map before; empty: only its time
  bool replaced = false;          ///< no map before, or of another frame, size or place
};

/// What has come in since the beginning.
struct StreamCounts {
  std::uint64_t keyframes = 0;  ///< that were taken
  std::uint64_t updates = 0;    ///< that were written into a map
  std::uint64_t late = 0;       ///< of something older than what was held: left out, and nothing is lost
  std::uint64_t unusable = 0;   ///< updates that came after a gap, or whose keyframe never came: left out
  std::uint64_t refused = 0;    ///< broken messages: left out
  std::uint64_t gaps = 0;       ///< times that something was missing and a new keyframe was needed
  std::uint64_t restarts = 0;   ///< times that the numbers of keyframes began anew
  std::string last_refusal;     ///< why; empty if nothing was refused
  std::string last_gap;         ///< why; empty without gaps
};

/// Whether a new keyframe is needed to go on.
enum class KeyframeNeed {
  none,
  expected,  ///< one should be on its way
  lost       ///< what is held cannot be continued
};

class ElevationAssembler {
 public:
  /// Keeps the message, which must not change any more.
  MapChange take(const ElevationGrid::ConstPtr& keyframe);
  /// Keeps the message if its keyframe is still to come.
  MapChange take(const ElevationUpdate::ConstPtr& update);
  /// The keyframe that is expected has not come for too long: counts a gap, if a map is held.
  void keyframe_overdue();

  /// The last good one, also after a gap; null before the first keyframe.
  const std::shared_ptr<const ElevationMap>& map() const { return map_; }
  KeyframeNeed need() const;
  const StreamCounts& counts() const { return counts_; }

 private:
  using Number = std::pair<std::uint32_t, std::uint32_t>;  ///< of an update: its keyframe's, and its own

  bool is_held(const ElevationGrid& keyframe) const;
  MapChange hold(MapChange change);
  bool is_late(const ElevationUpdate& update) const;
  bool follows(const ElevationUpdate& update) const;
  MapChange place(const ElevationUpdate::ConstPtr& update);
  MapChange go_back(const ElevationUpdate::ConstPtr& update, const Number& from);
  MapChange refuse(const std::string& why);
  void lose(const std::string& why);
  void keep(const ElevationUpdate::ConstPtr& update);
  void drop_first_waiting();
  MapChange write(const ElevationUpdate& update);
  void write_waiting(MapChange& change);

  std::shared_ptr<const ElevationMap> map_;
  ros::Time keyframe_stamp_;                        ///< of the keyframe that map_ is built on
  bool complete_ = true;                            ///< nothing is missing after what is held
  bool went_back_ = false;                          ///< the sender has begun anew; its keyframe is to come
  Number newest_{0, 0};                             ///< of the last update that came, whatever became of it
  std::shared_ptr<const ElevationMap> sent_again_;  ///< of the keyframe that map_ is built on, come anew
  std::deque<ElevationUpdate::ConstPtr> waiting_;   ///< for their keyframe, in the order of their coming
  std::size_t waiting_cells_ = 0;
  StreamCounts counts_;
};

}  // namespace desert_sim
