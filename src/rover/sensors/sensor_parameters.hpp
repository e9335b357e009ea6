#pragma once
/// Parameters of the sensors of a rover, in three sections: `lidar`, `depth_camera`, and `sensor_media` for
/// what beams of both meet. doc/robotics/sensors.md describes the model.

#include <yaml-cpp/yaml.h>

#include <cstdint>
#include <set>
#include <string>

#include "src/core/parameter_table.hpp"
#include "src/scenario/yaml_parameters.hpp"

namespace desert_sim {

/// A lidar whose beams all leave at the same moment. The defaults are those of a lidar with 64 rings.
struct LidarParameters {
  double rate = 10;
  int rings = 64;
  int columns = 1024;
  float lowest_deg = -22.5f;
  float highest_deg = 22.5f;
  float first_azimuth_deg = -180;
  float last_azimuth_deg = 180;
  float range_min = 0.5f;
  float range_max = 100;
  float noise = 0.02f;
  float noise_per_metre = 0;
  float dropout = 0;
  std::uint64_t seed = 1;
  double x = 0;
  double y = 0;
  double z = 0.5;
  double roll_deg = 0;
  double pitch_deg = 0;
  double yaw_deg = 0;
};
constexpr auto parameter_table(const LidarParameters*) {
  using P = LidarParameters;
  return std::make_tuple(
      parameter("rate", &P::rate, 0, 1000, "Hz", "Scans in a second; 0: none."),
      parameter("rings", &P::rings, 1, 256, "1", "Beams above each other."),
      parameter("columns", &P::columns, 1, 8192, "1", "Beams beside each other."),
      parameter("lowest_deg", &P::lowest_deg, -90, 90, "deg", "Elevation of the lowest ring."),
      parameter("highest_deg", &P::highest_deg, -90, 90, "deg",
                "Elevation of the highest ring; rings are evenly spaced, a single one is in the middle."),
      parameter("first_azimuth_deg", &P::first_azimuth_deg, -360, 360, "deg",
                "Right edge of the sector of the columns, from straight ahead counter-clockwise."),
      parameter("last_azimuth_deg", &P::last_azimuth_deg, -360, 360, "deg",
                "Left edge of the sector; columns are in the middle of equal parts of it."),
      parameter("range_min", &P::range_min, 0, 10000, "m", "Nearer targets give no return."),
      parameter("range_max", &P::range_max, 1e-3, 10000, "m", "Farther targets give no return."),
      parameter("noise", &P::noise, 0, 100, "m", "Standard deviation of the range, at any range."),
      parameter("noise_per_metre", &P::noise_per_metre, 0, 1, "1",
                "What is added to the standard deviation for each metre of range."),
      parameter("dropout", &P::dropout, 0, 1, "1", "Probability that a beam gives no return."),
      parameter("seed", &P::seed, 0, highest_uint64, "1",
                "Of noise, dropouts and what beams meet in plants and airborne sand."),
      parameter("x", &P::x, -100, 100, "m", "Where it is mounted, in the rover's frame: forward."),
      parameter("y", &P::y, -100, 100, "m", "Left."), parameter("z", &P::z, -100, 100, "m", "Up."),
      parameter("roll_deg", &P::roll_deg, -360, 360, "deg", "Turn about x, the first of three, as in URDF."),
      parameter("pitch_deg", &P::pitch_deg, -360, 360, "deg", "Turn about y; above 0 it looks down."),
      parameter("yaw_deg", &P::yaw_deg, -360, 360, "deg", "Turn about z; above 0 it looks left."));
}
static_assert(table_is_complete<LidarParameters>());

/// A camera that measures the depth of each pixel, the coordinate along its axis.
struct DepthCameraParameters {
  double rate = 10;
  int width = 320;
  int height = 240;
  float fov_deg = 87;
  float near = 0.3f;
  float far = 10;
  float noise = 0.001f;
  float noise_per_square_metre = 0.002f;
  float dropout = 0;
  std::uint64_t seed = 2;
  double x = 0.3;
  double y = 0;
  double z = 0.3;
  double roll_deg = 0;
  double pitch_deg = 15;
  double yaw_deg = 0;
};
constexpr auto parameter_table(const DepthCameraParameters*) {
  using P = DepthCameraParameters;
  return std::make_tuple(
      parameter("rate", &P::rate, 0, 1000, "Hz", "Pictures in a second; 0: none."),
      parameter("width", &P::width, 1, 4096, "pixels", "Columns."),
      parameter("height", &P::height, 1, 4096, "pixels", "Rows; pixels are square."),
      parameter("fov_deg", &P::fov_deg, 1, 170, "deg",
                "Field of view from the left edge of the picture to the right one."),
      parameter("near", &P::near, 0, 10000, "m", "Depth below which there is no return."),
      parameter("far", &P::far, 1e-3, 10000, "m", "Depth above which there is no return."),
      parameter("noise", &P::noise, 0, 100, "m", "Standard deviation of the depth, at any depth."),
      parameter("noise_per_square_metre", &P::noise_per_square_metre, 0, 1, "1/m",
                "What is added to the standard deviation for the square of the depth, as stereo has it."),
      parameter("dropout", &P::dropout, 0, 1, "1", "Probability that a pixel has no depth."),
      parameter("seed", &P::seed, 0, highest_uint64, "1",
                "Of noise, dropouts and what pixels see of plants and airborne sand."),
      parameter("x", &P::x, -100, 100, "m", "Where it is mounted, in the rover's frame: forward."),
      parameter("y", &P::y, -100, 100, "m", "Left."), parameter("z", &P::z, -100, 100, "m", "Up."),
      parameter("roll_deg", &P::roll_deg, -360, 360, "deg", "Turn about x, the first of three, as in URDF."),
      parameter("pitch_deg", &P::pitch_deg, -360, 360, "deg", "Turn about y; above 0 it looks down."),
      parameter("yaw_deg", &P::yaw_deg, -360, 360, "deg", "Turn about z; above 0 it looks left."));
}
static_assert(table_is_complete<DepthCameraParameters>());

/// What beams meet besides the ground.
struct SensorMediaParameters {
  float canopy_extinction = 2;
  float dust_extinction = 0.02f;
  float dust_height = 2;
  float dust_returns = 0.3f;
  float ground_reflectivity = 0.35f;
  float plant_reflectivity = 0.5f;
  float dust_reflectivity = 0.05f;
};
constexpr auto parameter_table(const SensorMediaParameters*) {
  using P = SensorMediaParameters;
  return std::make_tuple(
      parameter("canopy_extinction", &P::canopy_extinction, 0, 1000, "1/m",
                "Of plants of density 1: the share e^(-extinction * density * length) of the beams gets "
                "through; 0: plants are not seen."),
      parameter("dust_extinction", &P::dust_extinction, 0, 1e6, "1/m^2",
                "Of airborne sand, there and back, for each metre of the layer airborne_sand; 0: the air is "
                "clear."),
      parameter("dust_height", &P::dust_height, 1e-3, 1000, "m",
                "Height above the ground up to which airborne sand fills the air."),
      parameter("dust_returns", &P::dust_returns, 0, 1, "1",
                "Share of the beams that return from airborne sand where they end in it; the others are "
                "lost."),
      parameter("ground_reflectivity", &P::ground_reflectivity, 0, 1, "1",
                "Intensity of ground at perpendicular incidence; it falls with the cosine."),
      parameter("plant_reflectivity", &P::plant_reflectivity, 0, 1, "1", "Intensity of plants."),
      parameter("dust_reflectivity", &P::dust_reflectivity, 0, 1, "1", "Intensity of airborne sand."));
}
static_assert(table_is_complete<SensorMediaParameters>());

/// Throw ConfigError, with all faults, for numbers out of their ranges, and where
/// lidar: lowest_deg > highest_deg, the sector is empty or more than a turn, or range_min >= range_max;
/// depth_camera: near >= far.
void check_parameters(const LidarParameters& parameters);
void check_parameters(const DepthCameraParameters& parameters);
void check_parameters(const SensorMediaParameters& parameters);

/// Reads the sections `lidar`, `depth_camera` and `sensor_media` that `root` has, adds their names to
/// `known`, and what is wrong with single values and keys to `errors`.
void read_sensor_parameters(const YAML::Node& root, ValidationErrors& errors, LidarParameters& lidar,
                            DepthCameraParameters& depth_camera, SensorMediaParameters& media,
                            std::set<std::string>& known);

/// The three sections in markdown, from their tables: config/sensor_parameters.md.
std::string describe_sensor_parameters();

}  // namespace desert_sim
