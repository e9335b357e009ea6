#pragma once
/// The sensors of a rover as topics. Measuring has a thread of its own, so that a rover whose pose is
/// computed elsewhere does not wait for it; and nothing is computed or copied for a topic without
/// subscribers.
///
///   lidar/points               sensor_msgs/PointCloud2, see lidar_cloud()
///   depth_camera/image_rect    sensor_msgs/Image, see depth_image()
///   depth_camera/camera_info   sensor_msgs/CameraInfo, with each image
///
/// Times come with the poses only: a sensor of r Hz measures from the first pose in each interval
/// [n/r, (n + 1)/r) of ROS time, or of another time that is given with them, and n is the number of the scan,
/// on which its noise depends. So the same poses over the same terrain give the same messages to the bit, at
/// any speed.

#include <geometry_msgs/Pose.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/time.h>

#include <array>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "include/desert_sim/client/layer_map.hpp"
#include "src/ros/conversion/sensor_messages.hpp"
#include "src/ros/rover/map_micro_relief.hpp"
#include "src/rover/sensors/depth_camera.hpp"
#include "src/rover/sensors/height_field_scene.hpp"
#include "src/rover/sensors/lidar.hpp"

namespace desert_sim {

struct SensorSetup {
  LidarParameters lidar;
  DepthCameraParameters depth_camera;
  SensorMediaParameters media;
  std::string backend = "cpu";  ///< auto, cpu or cuda
  int threads = 1;              ///< of the CPU backend; 0: one a processor
  /// Whether on_pose() itself measures and publishes, and returns when it is done: in lockstep no pose is
  /// then left out.
  bool lockstep = false;
};

class SensorPublisher {
 public:
  /// Advertises the topics of the sensors whose rate is not 0, below `node`. Throws ConfigError for
  /// parameters that the sensors refuse.
  SensorPublisher(ros::NodeHandle node, const SensorSetup& setup, const SensorFrames& frames);
  /// Waits for the scan that is being made.
  ~SensorPublisher();
  SensorPublisher(const SensorPublisher&) = delete;
  SensorPublisher& operator=(const SensorPublisher&) = delete;

  /// The layers whose maps the sensors want, besides others by their names for TerrainClient.
  static std::vector<std::string> layers();

  /// Takes a new map of a layer, and the cells in which it differs from the one before; the arguments of
  /// TerrainClient's on_change. Maps of other layers are ignored. Returns at once, from any thread.
  void on_terrain(std::shared_ptr<const LayerMap> map, const LayerMap::Rectangle& changed);

  /// Takes the ripples and bumps that beams meet from now on; null: none. Returns at once, from any thread.
  void on_micro_relief(std::shared_ptr<const MapMicroRelief> micro_relief);

  /// Whether anybody listens.
  bool has_subscribers() const;

  /// Some time of a clock that is not that of stamps [s], from 0 on.
  struct TimeSpan {
    double begin, end;
  };
  /// Takes the pose of the frame in which the sensors are mounted, in the terrain's frame, and measures if
  /// that is due. A pose that comes while the one before is still waiting takes its place. From one thread at
  /// a time. Throws ConfigError for a pose that is none, and what measuring has thrown. With `passed`, the
  /// time since the pose before, intervals and numbers are those of that time, and depend on nothing else.
  void on_pose(const ros::Time& stamp, const geometry_msgs::Pose& base_in_terrain,
               const std::optional<TimeSpan>& passed = {});

  struct Statistics {
    std::uint64_t scans = 0, pictures = 0;
    std::uint64_t skipped = 0;  ///< measurements that were due and not made, because one before took too long
    std::uint64_t uploads = 0;  ///< rectangles that were copied to the backend
    double last_scan_ms = 0, last_picture_ms = 0;  ///< wall time from a pose to its message
  };
  Statistics statistics() const;

 private:
  static constexpr std::size_t layer_count = 4;
  struct LayerState {
    std::shared_ptr<const LayerMap> map;
    LayerMap::Rectangle changed;  ///< since the scene was brought up to date
  };
  using Layers = std::array<LayerState, layer_count>;
  struct Job {
    ros::Time stamp;
    SensorPose base;
    std::optional<std::uint64_t> scan, picture;  ///< their numbers, if they are due
  };

  Job due(const ros::Time& stamp, const SensorPose& base, const std::optional<TimeSpan>& passed);
  void work();
  void perform(const Job& job);
  bool update_scene();
  void update_micro_relief(const std::shared_ptr<const MapMicroRelief>& micro_relief);
  void publish_scan(const Job& job);
  void publish_picture(const Job& job);

  const SensorSetup setup_;
  const SensorFrames frames_;
  ros::Publisher points_, image_, info_;
  std::optional<std::uint64_t> last_scan_, last_picture_;  ///< numbers of the last ones that were due

  // Of the thread that measures:
  std::unique_ptr<Exec> exec_;
  std::unique_ptr<HeightFieldScene> scene_;
  std::shared_ptr<const MapMicroRelief> scene_micro_relief_;  ///< what the scene has been given
  Lidar lidar_;
  DepthCamera camera_;

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  // Guarded by mutex_:
  Layers layers_;
  std::shared_ptr<const MapMicroRelief> micro_relief_;
  std::optional<Job> job_;
  std::exception_ptr failure_;
  Statistics statistics_;
  bool stopping_ = false;

  std::thread thread_;
};

}  // namespace desert_sim
