#pragma once
/// A lidar with rings of beams: kernels/rover/beams.hpp says what it measures.

#include <vector>

#include "src/rover/sensors/range_sensor.hpp"

namespace desert_sim {

/// The lidar's place in the rover's frame.
SensorPose mounting_of(const LidarParameters& parameters);

/// Row r of a scan is ring r, from the lowest one upwards; column c is the azimuth c, counter-clockwise from
/// the right edge of the sector. A point is at distance · direction in the lidar's frame (x forward, y left,
/// z up), in which directions have length 1.
class Lidar {
 public:
  /// `ring_angles_deg`: the elevations of the rings, for a lidar whose rings are not evenly spaced; they then
  /// count instead of the parameters rings, lowest_deg and highest_deg. Throws ConfigError for parameters
  /// that check_parameters() refuses, and for an angle beyond ±90°.
  Lidar(Exec& exec, const LidarParameters& parameters, const SensorMediaParameters& media = {},
        const std::vector<double>& ring_angles_deg = {});

  const LidarParameters& parameters() const { return parameters_; }
  const std::vector<beams::Vec3>& directions() const { return sensor_.directions(); }
  /// A scan from the lidar's pose in the scene's frame: see RangeSensor::scan().
  const RangeImage& scan(const HeightFieldScene& scene, const SensorPose& pose, std::uint64_t number) {
    return sensor_.scan(scene, pose, number);
  }

 private:
  LidarParameters parameters_;
  RangeSensor sensor_;
};

}  // namespace desert_sim
