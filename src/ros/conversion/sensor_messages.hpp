#pragma once
/// What sensors measure as messages.

#include <geometry_msgs/Pose.h>
#include <geometry_msgs/TransformStamped.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_msgs/Header.h>

#include <string>
#include <vector>

#include "src/rover/sensors/depth_camera.hpp"
#include "src/rover/sensors/lidar.hpp"

namespace desert_sim {

/// An organised cloud in the lidar's frame: row r (height) is ring r, from the lowest one upwards, and column
/// c (width) the azimuth c, counter-clockwise. Fields: x, y, z [m] and intensity [0 … 1], float32; ring,
/// uint16. Points without a return are NaN (is_dense is false). `header` names the lidar's frame.
sensor_msgs::PointCloud2Ptr lidar_cloud(const std_msgs::Header& header, const RangeImage& scan,
                                        const std::vector<beams::Vec3>& directions);

/// Depths [m] as 32FC1, NaN without a return (REP 118). `header` names the optical frame (x right, y down, z
/// forward).
sensor_msgs::ImagePtr depth_image(const std_msgs::Header& header, const RangeImage& picture);

/// The pinhole camera of that image, without distortion.
sensor_msgs::CameraInfoPtr camera_info(const std_msgs::Header& header, const DepthCamera& camera);

SensorPose to_sensor_pose(const geometry_msgs::Pose& pose);

/// The names of the frames of sensors.
struct SensorFrames {
  std::string base = "base_link";  ///< in which they are mounted
  std::string lidar = "lidar";
  std::string camera = "depth_camera";                  ///< of the camera's body: x forward, y left, z up
  std::string camera_optical = "depth_camera_optical";  ///< x right, y down, z forward
};

/// The static transforms from the base to the lidar, to the camera's body, and from there to its optical
/// frame; none for a sensor whose rate is 0.
std::vector<geometry_msgs::TransformStamped> sensor_transforms(const SensorFrames& frames,
                                                               const LidarParameters& lidar,
                                                               const DepthCameraParameters& camera);

}  // namespace desert_sim
