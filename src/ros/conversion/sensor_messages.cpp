#include "src/ros/conversion/sensor_messages.hpp"

#include <boost/make_shared.hpp>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace desert_sim {

namespace {

/// A point as it lies in the message.
struct LidarPoint {
  float x, y, z, intensity;
  std::uint16_t ring, padding;
};
static_assert(sizeof(LidarPoint) == 20);

bool machine_is_bigendian() {
  const std::uint16_t one = 1;
  std::uint8_t first_byte;
  std::memcpy(&first_byte, &one, 1);
  return first_byte == 0;
}

void add_field(sensor_msgs::PointCloud2& cloud, const char* name, std::size_t offset, std::uint8_t type) {
  sensor_msgs::PointField field;
  field.name = name;
  field.offset = static_cast<std::uint32_t>(offset);
  field.datatype = type;
  field.count = 1;
  cloud.fields.push_back(field);
}

geometry_msgs::TransformStamped transform_of(const std::string& parent, const std::string& child,
                                             const SensorPose& pose) {
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = parent;
  transform.child_frame_id = child;
  transform.transform.translation.x = pose.position.x();
  transform.transform.translation.y = pose.position.y();
  transform.transform.translation.z = pose.position.z();
  transform.transform.rotation.x = pose.orientation.x();
  transform.transform.rotation.y = pose.orientation.y();
  transform.transform.rotation.z = pose.orientation.z();
  transform.transform.rotation.w = pose.orientation.w();
  return transform;
}

}  // namespace

sensor_msgs::PointCloud2Ptr lidar_cloud(const std_msgs::Header& header, const RangeImage& scan,
                                        const std::vector<beams::Vec3>& directions) {
  using Field = sensor_msgs::PointField;
  auto cloud = boost::make_shared<sensor_msgs::PointCloud2>();
  cloud->header = header;
  add_field(*cloud, "x", offsetof(LidarPoint, x), Field::FLOAT32);
  add_field(*cloud, "y", offsetof(LidarPoint, y), Field::FLOAT32);
  add_field(*cloud, "z", offsetof(LidarPoint, z), Field::FLOAT32);
  add_field(*cloud, "intensity", offsetof(LidarPoint, intensity), Field::FLOAT32);
  add_field(*cloud, "ring", offsetof(LidarPoint, ring), Field::UINT16);
  cloud->height = static_cast<std::uint32_t>(scan.rows);
  cloud->width = static_cast<std::uint32_t>(scan.columns);
  cloud->point_step = sizeof(LidarPoint);
  cloud->row_step = cloud->width * cloud->point_step;
  cloud->is_bigendian = machine_is_bigendian();
  cloud->is_dense = false;
  cloud->data.resize(scan.distances.size() * sizeof(LidarPoint));
  std::uint8_t* place = cloud->data.data();
  for (std::size_t n = 0; n < scan.distances.size(); ++n, place += sizeof(LidarPoint)) {
    const float d = scan.distances[n];  // NaN makes all coordinates NaN
    const beams::Vec3& to = directions[n];
    const LidarPoint point{d * to.x,
                           d * to.y,
                           d * to.z,
                           scan.intensities[n],
                           static_cast<std::uint16_t>(n / static_cast<std::size_t>(scan.columns)),
                           0};
    std::memcpy(place, &point, sizeof point);
  }
  return cloud;
}

sensor_msgs::ImagePtr depth_image(const std_msgs::Header& header, const RangeImage& picture) {
  auto image = boost::make_shared<sensor_msgs::Image>();
  image->header = header;
  image->height = static_cast<std::uint32_t>(picture.rows);
  image->width = static_cast<std::uint32_t>(picture.columns);
  image->encoding = "32FC1";
  image->is_bigendian = machine_is_bigendian();
  image->step = image->width * sizeof(float);
  image->data.resize(picture.distances.size() * sizeof(float));
  if (!picture.distances.empty())
    std::memcpy(image->data.data(), picture.distances.data(), image->data.size());
  return image;
}

sensor_msgs::CameraInfoPtr camera_info(const std_msgs::Header& header, const DepthCamera& camera) {
  auto info = boost::make_shared<sensor_msgs::CameraInfo>();
  const double f = camera.focal_length(), cx = camera.centre_x(), cy = camera.centre_y();
  info->header = header;
  info->height = static_cast<std::uint32_t>(camera.parameters().height);
  info->width = static_cast<std::uint32_t>(camera.parameters().width);
  info->distortion_model = "plumb_bob";
  info->D.assign(5, 0.0);
  info->K = {{f, 0, cx, 0, f, cy, 0, 0, 1}};
  info->R = {{1, 0, 0, 0, 1, 0, 0, 0, 1}};
  info->P = {{f, 0, cx, 0, 0, f, cy, 0, 0, 0, 1, 0}};
  return info;
}

SensorPose to_sensor_pose(const geometry_msgs::Pose& pose) {
  const geometry_msgs::Quaternion& q = pose.orientation;
  return {{pose.position.x, pose.position.y, pose.position.z}, {q.w, q.x, q.y, q.z}};
}

std::vector<geometry_msgs::TransformStamped> sensor_transforms(const SensorFrames& frames,
                                                               const LidarParameters& lidar,
                                                               const DepthCameraParameters& camera) {
  std::vector<geometry_msgs::TransformStamped> all;
  if (lidar.rate > 0) all.push_back(transform_of(frames.base, frames.lidar, mounting_of(lidar)));
  if (camera.rate > 0) {
    all.push_back(transform_of(frames.base, frames.camera, mounting_of(camera)));
    all.push_back(transform_of(frames.camera, frames.camera_optical, DepthCamera::optical_frame()));
  }
  return all;
}

}  // namespace desert_sim
