#include "src/rover/sensors/range_sensor.hpp"

#include <algorithm>
#include <cmath>

#include "src/core/elementary.hpp"
#include "src/core/error.hpp"

namespace desert_sim {

namespace {

/// The patch in which a coordinate lies, and how far from where it begins [cells]. Outside the grid it is the
/// outermost patch.
struct PatchPlace {
  int patch;
  float rest;

  PatchPlace(double metres, double cell_size, int cells) {
    const double patches = metres / cell_size + 0.5;
    const double whole = std::clamp(std::floor(patches), 0.0, static_cast<double>(cells));
    patch = static_cast<int>(whole);
    rest = static_cast<float>(patches - whole);
  }
};

ray_march::Ray origin_of(const SceneGeometry& g, const SensorPose& pose) {
  const Eigen::Vector3d& p = pose.position;
  const PatchPlace x(p.x() - g.origin_x, g.cell_size, g.width), y(p.y() - g.origin_y, g.cell_size, g.height);
  ray_march::Ray ray{};
  ray.u = x.rest, ray.v = y.rest;
  ray.patch_x = x.patch, ray.patch_y = y.patch;
  ray.z = static_cast<float>(p.z());
  ray.z_rest = static_cast<float>(p.z() - static_cast<double>(ray.z));
  return ray;
}

}  // namespace

RangeSensor::RangeSensor(Exec& exec, int columns, int rows, std::vector<beams::Vec3> directions,
                         const Settings& settings)
    : exec_(exec),
      settings_(settings),
      directions_(std::move(directions)),
      device_directions_(exec, directions_.size()),
      distances_(exec, directions_.size()),
      intensities_(exec, directions_.size()) {
  device_directions_.upload(directions_);
  for (const beams::Vec3& d : directions_)
    reach_ = std::max(reach_, double{settings_.farthest} * elementary::hypot(d.x, d.y, d.z));
  image_.columns = columns;
  image_.rows = rows;
  image_.distances.resize(directions_.size());
  image_.intensities.resize(directions_.size());
}

const RangeImage& RangeSensor::scan(const HeightFieldScene& scene, const SensorPose& pose,
                                    std::uint64_t number) {
  if (&scene.exec() != &exec_) throw Error("a sensor and the terrain that it scans have different backends");
  const Eigen::Matrix3d turn = rotation_of(pose);
  const SensorMediaParameters& media = settings_.media;
  beams::Scan scan{scene.view(),
                   origin_of(scene.geometry(), pose),
                   static_cast<float>(scene.geometry().cell_size),
                   {},
                   settings_.nearest,
                   settings_.farthest,
                   settings_.noise,
                   {media.canopy_extinction, {media.dust_extinction, media.dust_height}, media.dust_returns},
                   {media.ground_reflectivity, media.plant_reflectivity, media.dust_reflectivity},
                   settings_.seed,
                   number};
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) scan.turn[row][column] = static_cast<float>(turn(row, column));
  with_backend(exec_, [&](auto& exec) {
    const auto cast = [&](const auto& surface) {
      beams::cast(exec, scan, surface, image_.columns, image_.rows, device_directions_.data(),
                  distances_.data(), intensities_.data());
    };
    if (SceneMicroRelief* const micro_relief = scene.micro_relief())
      cast(micro_relief->within(pose.position.x(), pose.position.y(), reach_, directions_.size()));
    else
      cast(ray_march::PlainGround());
  });
  distances_.download(0, image_.distances.size(), image_.distances.data());
  intensities_.download(0, image_.intensities.size(), image_.intensities.data());
  return image_;
}

}  // namespace desert_sim
