#include "src/rover/sensors/lidar.hpp"

#include <cmath>
#include <sstream>

#include "src/core/elementary.hpp"
#include "src/core/error.hpp"

namespace desert_sim {

namespace {

std::vector<double> even_angles(const LidarParameters& p) {
  const double lowest = static_cast<double>(p.lowest_deg), highest = static_cast<double>(p.highest_deg);
  std::vector<double> angles;
  angles.reserve(static_cast<std::size_t>(p.rings));
  for (int ring = 0; ring < p.rings; ++ring)
    angles.push_back(p.rings == 1 ? 0.5 * (lowest + highest)
                                  : lowest + (highest - lowest) * ring / (p.rings - 1));
  return angles;
}

LidarParameters checked(LidarParameters p, const SensorMediaParameters& media,
                        const std::vector<double>& ring_angles_deg) {
  if (!ring_angles_deg.empty()) p.rings = static_cast<int>(ring_angles_deg.size());
  check_parameters(p);
  check_parameters(media);
  for (std::size_t n = 0; n < ring_angles_deg.size(); ++n)
    if (!(std::abs(ring_angles_deg[n]) <= 90)) {
      std::ostringstream fault;
      fault << "lidar: ring_angles_deg[" << n << "] = " << ring_angles_deg[n] << " is not in [-90, 90] deg";
      throw ConfigError(fault.str());
    }
  return p;
}

std::vector<beams::Vec3> directions_of(const LidarParameters& p, const std::vector<double>& angles) {
  const double first = static_cast<double>(p.first_azimuth_deg),
               sector = static_cast<double>(p.last_azimuth_deg) - first;
  std::vector<beams::Vec3> directions;
  directions.reserve(angles.size() * static_cast<std::size_t>(p.columns));
  for (const double angle : angles)
    for (int column = 0; column < p.columns; ++column) {
      const elementary::UnitVector up = elementary::direction_deg(angle),
                                   level =
                                       elementary::direction_deg(first + sector * (column + 0.5) / p.columns);
      directions.push_back(
          {static_cast<float>(up.x * level.x), static_cast<float>(up.x * level.y), static_cast<float>(up.y)});
    }
  return directions;
}

}  // namespace

Lidar::Lidar(Exec& exec, const LidarParameters& parameters, const SensorMediaParameters& media,
             const std::vector<double>& ring_angles_deg)
    : parameters_(checked(parameters, media, ring_angles_deg)),
      sensor_(
          exec, parameters_.columns, parameters_.rings,
          directions_of(parameters_, ring_angles_deg.empty() ? even_angles(parameters_) : ring_angles_deg),
          {parameters_.range_min,
           parameters_.range_max,
           {parameters_.noise, parameters_.noise_per_metre, 0, parameters_.dropout},
           media,
           parameters_.seed}) {}

SensorPose mounting_of(const LidarParameters& p) {
  return pose_from_angles(p.x, p.y, p.z, p.roll_deg, p.pitch_deg, p.yaw_deg);
}

}  // namespace desert_sim
