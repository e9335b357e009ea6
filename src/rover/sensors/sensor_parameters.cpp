#include "src/rover/sensors/sensor_parameters.hpp"

#include <sstream>

#include "src/core/parameter_page.hpp"
#include "src/scenario/range_checks.hpp"

namespace desert_sim {

namespace {

std::string conflict(float value, const char* relation, const char* other, float other_value) {
  std::ostringstream text;
  text << value << " " << relation << " " << other << " = " << other_value;
  return text.str();
}

}  // namespace

void check_parameters(const LidarParameters& p) {
  check_ranges(p, "lidar");
  ValidationErrors errors("lidar");
  if (p.lowest_deg > p.highest_deg)
    errors.add("lowest_deg", conflict(p.lowest_deg, "is above", "highest_deg", p.highest_deg));
  if (!(p.first_azimuth_deg < p.last_azimuth_deg))
    errors.add("first_azimuth_deg",
               conflict(p.first_azimuth_deg, "is not below", "last_azimuth_deg", p.last_azimuth_deg));
  if (p.last_azimuth_deg - p.first_azimuth_deg > 360)
    errors.add("last_azimuth_deg", conflict(p.last_azimuth_deg, "is more than a turn of 360 deg from",
                                            "first_azimuth_deg", p.first_azimuth_deg));
  if (!(p.range_min < p.range_max))
    errors.add("range_min", conflict(p.range_min, "is not below", "range_max", p.range_max));
  errors.throw_if_any();
}

void check_parameters(const DepthCameraParameters& p) {
  check_ranges(p, "depth_camera");
  ValidationErrors errors("depth_camera");
  if (!(p.near < p.far)) errors.add("near", conflict(p.near, "is not below", "far", p.far));
  errors.throw_if_any();
}

void check_parameters(const SensorMediaParameters& p) { check_ranges(p, "sensor_media"); }

void read_sensor_parameters(const YAML::Node& root, ValidationErrors& errors, LidarParameters& lidar,
                            DepthCameraParameters& depth_camera, SensorMediaParameters& media,
                            std::set<std::string>& known) {
  const auto read = [&](const char* name, auto& parameters) {
    yaml::read_section(root[name], name, errors, parameters);
    known.insert(name);
  };
  read("lidar", lidar);
  read("depth_camera", depth_camera);
  read("sensor_media", media);
}

std::string describe_sensor_parameters() {
  std::ostringstream page;
  page << "#### lidar\n\n";
  write_parameter_table(page, LidarParameters());
  page << "\n#### depth_camera\n\n";
  write_parameter_table(page, DepthCameraParameters());
  page << "\n#### sensor_media\n\n";
  write_parameter_table(page, SensorMediaParameters());
  return page.str();
}

}  // namespace desert_sim
