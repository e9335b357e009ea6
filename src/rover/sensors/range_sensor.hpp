#pragma once
/// What a lidar and a depth camera have in common: beams, the settings of a scan, and its result.

#include <cstdint>
#include <vector>

#include "kernels/rover/beams.hpp"
#include "src/rover/sensors/height_field_scene.hpp"
#include "src/rover/sensors/sensor_parameters.hpp"
#include "src/rover/sensors/sensor_pose.hpp"

namespace desert_sim {

/// Rows × columns of what beams measured, row-major.
struct RangeImage {
  int columns = 0, rows = 0;
  std::vector<float> distances;    ///< [m]; NaN: no return
  std::vector<float> intensities;  ///< [0 … 1]; 0: no return
};

class RangeSensor {
 public:
  struct Settings {
    float nearest, farthest;
    beams::Noise noise;
    SensorMediaParameters media;
    std::uint64_t seed;
  };

  /// `directions` of the beams in the sensor's frame (x forward, y left, z up), row-major.
  RangeSensor(Exec& exec, int columns, int rows, std::vector<beams::Vec3> directions,
              const Settings& settings);

  const std::vector<beams::Vec3>& directions() const { return directions_; }
  /// Measures from a pose in the scene's frame; the same number of a scan has the same noise. The result is
  /// valid until the next scan. Throws ConfigError for a pose that rotation_of() refuses, and Error if the
  /// scene is of another Exec.
  const RangeImage& scan(const HeightFieldScene& scene, const SensorPose& pose, std::uint64_t number);

 private:
  Exec& exec_;
  Settings settings_;
  std::vector<beams::Vec3> directions_;
  double reach_ = 0;  ///< of the longest beam [m]
  Buffer<beams::Vec3> device_directions_;
  Buffer<float> distances_, intensities_;
  RangeImage image_;
};

}  // namespace desert_sim
