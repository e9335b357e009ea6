#pragma once
/// Keyframes and updates of a layer, whichever messages bring them: those of the elevation or of others.

#include <desert_sim/ElevationGrid.h>
#include <desert_sim/ElevationUpdate.h>
#include <desert_sim/LayerGrid.h>
#include <desert_sim/LayerUpdate.h>
#include <ros/time.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace desert_sim {

/// What a map shows, and of which moment.
struct MapInfo {
  std::string layer;           ///< name of the layer: elevation, sand_depth, ...
  std::string unit;            ///< of the values: m, m/s, rad; 1 for a number without a unit
  std::string frame;           ///< name of the frame: x east, y north, z up
  ros::Time stamp;             ///< when this state was reached
  std::uint64_t step = 0;      ///< steps since the scenario's start
  double sim_time = 0;         ///< simulated time [s]
  std::uint32_t keyframe = 0;  ///< number of the keyframe on which the map is built
  std::uint32_t sequence = 0;  ///< sequence of the last update in the map; 0: none
  std::uint32_t width = 0;     ///< cells from west to east
  std::uint32_t height = 0;    ///< cells from south to north
  double cell_size = 0;        ///< [m]
  double origin_x = 0;         ///< lower-left corner of cell (0, 0) in the frame [m]
  double origin_y = 0;         ///< [m]
};

/// A keyframe, of either kind of message, whose values it shares: the message must not be modified
/// afterwards.
struct MapKeyframe {
  explicit MapKeyframe(const ElevationGrid::ConstPtr& message);
  explicit MapKeyframe(const LayerGrid::ConstPtr& message);

  MapInfo info;
  std::shared_ptr<const std::vector<float>> values;
};

/// An update, of either kind of message, whose tiles it shares.
struct MapUpdate {
  /// The message has to outlive this.
  explicit MapUpdate(const ElevationUpdate& message);
  explicit MapUpdate(const ElevationUpdate::ConstPtr& message);
  explicit MapUpdate(const LayerUpdate::ConstPtr& message);

  std::string layer, frame;
  ros::Time stamp;
  std::uint64_t step;
  double sim_time;
  std::uint32_t keyframe, sequence;
  std::shared_ptr<const std::vector<LayerTile>> tiles;

 private:
  template <class Message>
  MapUpdate(const Message& message, std::shared_ptr<const std::vector<LayerTile>> its_tiles);
};

/// Why a keyframe is invalid, with the offending value; empty if it is valid.
std::string validation_error(const ElevationGrid& keyframe);
std::string validation_error(const LayerGrid& keyframe);
/// Why an update is invalid for any map; empty if it is valid.
std::string validation_error(const ElevationUpdate& update);
std::string validation_error(const LayerUpdate& update);
/// Why an update cannot be applied to this map; empty if it can.
std::string validation_error(const MapUpdate& update, const MapInfo& map);
inline std::string validation_error(const ElevationUpdate& update, const MapInfo& map) {
  return validation_error(MapUpdate(update), map);
}

}  // namespace desert_sim
