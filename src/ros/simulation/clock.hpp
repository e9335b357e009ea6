#pragma once
/// /clock: the time of the simulation as the ROS time of all nodes. See SimulationState::paced_time(): a step
/// advances it by run.time_step / run.acceleration, and by run.time_step where the acceleration is 0.

#include <ros/time.h>
#include <rosgraph_msgs/Clock.h>

#include "src/ros/support/latched_publisher.hpp"

namespace desert_sim {

/// Such a time [s] as ROS time. For ROS, 0 means "no time yet": the start becomes one nanosecond.
/// Throws Error beyond what ROS time can hold (136 years).
ros::Time clock_time(double seconds);

class ClockPublisher {
 public:
  /// Throws ConfigError if another node publishes /clock: with two clocks, time would jump back and forth.
  ClockPublisher();
  /// The message is latched, so that a node that starts while the simulation is paused has a time.
  void publish(double seconds) const;

 private:
  LatchedPublisher<rosgraph_msgs::Clock> publisher_;
};

}  // namespace desert_sim
