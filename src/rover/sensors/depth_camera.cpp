#include "src/rover/sensors/depth_camera.hpp"

#include "src/core/elementary.hpp"

namespace desert_sim {

namespace {

DepthCameraParameters checked(const DepthCameraParameters& p, const SensorMediaParameters& media) {
  check_parameters(p);
  check_parameters(media);
  return p;
}

double focal_length_of(const DepthCameraParameters& p) {
  return 0.5 * p.width / elementary::tan_deg(0.5 * static_cast<double>(p.fov_deg));
}

/// In the body's frame, with a length that makes the distance the depth.
std::vector<beams::Vec3> directions_of(const DepthCameraParameters& p) {
  const double f = focal_length_of(p);
  std::vector<beams::Vec3> directions;
  directions.reserve(static_cast<std::size_t>(p.width) * static_cast<std::size_t>(p.height));
  for (int v = 0; v < p.height; ++v)
    for (int u = 0; u < p.width; ++u)
      directions.push_back({1.0f, static_cast<float>((0.5 * (p.width - 1) - u) / f),
                            static_cast<float>((0.5 * (p.height - 1) - v) / f)});
  return directions;
}

}  // namespace

DepthCamera::DepthCamera(Exec& exec, const DepthCameraParameters& parameters,
                         const SensorMediaParameters& media)
    : parameters_(checked(parameters, media)),
      sensor_(exec, parameters_.width, parameters_.height, directions_of(parameters_),
              {parameters_.near,
               parameters_.far,
               {parameters_.noise, 0, parameters_.noise_per_square_metre, parameters_.dropout},
               media,
               parameters_.seed}) {}

double DepthCamera::focal_length() const { return focal_length_of(parameters_); }

SensorPose mounting_of(const DepthCameraParameters& p) {
  return pose_from_angles(p.x, p.y, p.z, p.roll_deg, p.pitch_deg, p.yaw_deg);
}

}  // namespace desert_sim
