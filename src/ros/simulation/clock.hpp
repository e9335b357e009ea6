#pragma once
/// /clock: the time of the simulation as the ROS time of all nodes. See SimulationState::paced_time(): a step
/// advances it by run.time_step / run.acceleration, and by run.time_step where the acceleration is 0.

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/time.h>
#include <rosgraph_msgs/Clock.h>

#include <mutex>

namespace desert_sim {

/// Such a time [s] as ROS time. For ROS, 0 means "no time yet": the start becomes one nanosecond.
/// Throws Error beyond what ROS time can hold (136 years).
ros::Time clock_time(double seconds);

class ClockPublisher {
 public:
  /// Throws ConfigError if another node publishes /clock: with two clocks, time would jump back and forth.
  /// `node`: whose callback queue tells of new subscribers.
  explicit ClockPublisher(ros::NodeHandle& node);
  /// The message is latched, so that a node that starts while the simulation is paused has a time.
  void publish(double seconds);

 private:
  void publish_again();

  std::mutex mutex_;
  rosgraph_msgs::Clock::ConstPtr last_;
  ros::Publisher publisher_;  ///< ends first: its callback uses the rest
};

}  // namespace desert_sim
