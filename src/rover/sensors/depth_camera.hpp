#pragma once
/// A camera that measures depth: kernels/rover/beams.hpp says what it measures.

#include <vector>

#include "src/rover/sensors/range_sensor.hpp"

namespace desert_sim {

/// The place of the camera's body in the rover's frame.
SensorPose mounting_of(const DepthCameraParameters& parameters);

/// Row 0 of a picture is the upper one, column 0 the left one. A distance is the depth [m], the coordinate
/// along the camera's axis: pixel (u, v) with the depth d is at ((u − cx) d/f, (v − cy) d/f, d) in the
/// optical frame (x right, y down, z forward). Poses are those of the camera's body (x forward, y left, z
/// up).
class DepthCamera {
 public:
  /// Throws ConfigError for parameters that check_parameters() refuses.
  DepthCamera(Exec& exec, const DepthCameraParameters& parameters, const SensorMediaParameters& media = {});

  const DepthCameraParameters& parameters() const { return parameters_; }
  /// The orientation of the optical frame in that of the body.
  static SensorPose optical_frame() { return {{0, 0, 0}, {0.5, -0.5, 0.5, -0.5}}; }
  double focal_length() const;                                       ///< [pixels]
  double centre_x() const { return 0.5 * (parameters_.width - 1); }  ///< [pixels], 0 in the middle of pixel 0
  double centre_y() const { return 0.5 * (parameters_.height - 1); }
  const std::vector<beams::Vec3>& directions() const { return sensor_.directions(); }
  /// A picture from the body's pose in the scene's frame: see RangeSensor::scan().
  const RangeImage& scan(const HeightFieldScene& scene, const SensorPose& pose, std::uint64_t number) {
    return sensor_.scan(scene, pose, number);
  }

 private:
  DepthCameraParameters parameters_;
  RangeSensor sensor_;
};

}  // namespace desert_sim
