#pragma once
/// A rover as a node, for the program desert_rover_node and for the nodelet: parameters, terrain, clock,
/// topics and services, on threads of its own.

#include <desert_sim/DriveRover.h>
#include <desert_sim/LoadRover.h>
#include <desert_sim/SaveRover.h>
#include <desert_sim/SetRoverPose.h>
#include <diagnostic_updater/diagnostic_updater.h>
#include <geometry_msgs/Twist.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <std_srvs/Trigger.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "src/core/data_folder.hpp"
#include "src/ros/rover/rover_publisher.hpp"
#include "src/ros/rover/rover_terrain.hpp"
#include "src/ros/rover/sensors.hpp"
#include "src/ros/rover/wheel_tracks.hpp"
#include "src/rover/journal.hpp"

namespace desert_sim {

class RoverServer {
 public:
  /// Topics are below `node`, parameters and services below `private_node`. Throws ConfigError for input
  /// that is refused.
  RoverServer(const ros::NodeHandle& node, const ros::NodeHandle& private_node);
  /// Ends after the present advance.
  ~RoverServer();

  /// What failed at run time; empty while all is well.
  std::string failure() const;

 private:
  // ---- the thread that drives
  void run();
  void run_as_ros_time_passes();
  void run_in_lockstep();
  void tell_status();
  /// Lets the rover drive on this ground (null: none is known), and publishes.
  void advance(double seconds, const std::shared_ptr<const MapGround>& ground, const ros::Time& stamp);
  /// Lets the sensors measure from the rover's pose, if they are due; the last advance began at `ticks`. The
  /// caller holds the mutex.
  void measure(const MapGround& ground, const ros::Time& stamp, std::uint64_t ticks);
  /// By how much the rover's time goes on with this state of the terrain.
  double seconds_to(const MapGround& ground);
  void start_where_it_begins(const MapGround& ground);
  /// Applies an event to the rover, and journals it. The caller holds the mutex.
  void apply(const RoverEvent& event);

  // ---- callbacks
  void receive_command(const geometry_msgs::Twist& command);
  template <class Service>
  void advertise(const std::string& name,
                 void (RoverServer::*serve)(const typename Service::Request&, typename Service::Response&));
  void drive(const DriveRoverRequest& request, DriveRoverResponse& response);
  void set_pose(const SetRoverPoseRequest& request, SetRoverPoseResponse& response);
  void reset(const std_srvs::TriggerRequest& request, std_srvs::TriggerResponse& response);
  void save_state(const SaveRoverRequest& request, SaveRoverResponse& response);
  void load_state(const LoadRoverRequest& request, LoadRoverResponse& response);
  /// In lockstep waits until the rover has driven up to the terrain's present step. Throws ConfigError if
  /// it does not.
  void catch_up();
  const MapGround& known_ground() const;
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);
  void diagnose_terrain(diagnostic_updater::DiagnosticStatusWrapper& status);
  RoverStatus status() const;

  ros::CallbackQueue queue_;
  ros::NodeHandle node_, private_node_;
  const RoverSetup setup_;
  DataFolder files_;
  mutable std::mutex mutex_;  ///< guards all up to the next comment
  std::condition_variable advanced_;
  Rover rover_;
  std::unique_ptr<RoverJournalWriter> journal_;
  std::shared_ptr<const MapGround> ground_;  ///< the last one that the rover had
  bool waits_for_loaded_step_ = false;       ///< a state was loaded, and the terrain is not yet at its step
  std::string refusal_, failure_, start_problem_;
  std::uint64_t commands_received_ = 0;
  // By threads of their own, which are ended first:
  std::unique_ptr<SensorPublisher> sensors_;  ///< null without sensors; terrain_ calls it
  RoverTerrain terrain_;
  std::unique_ptr<WheelTracks> tracks_;
  RoverPublisher publisher_;
  tf2_ros::StaticTransformBroadcaster static_broadcaster_;
  diagnostic_updater::Updater updater_;
  ros::WallTimer diagnostic_timer_;
  ros::Subscriber commands_;
  std::vector<ros::ServiceServer> servers_;
  std::atomic<bool> stopping_{false};
  ros::AsyncSpinner spinner_;
  std::thread thread_;
};

}  // namespace desert_sim
