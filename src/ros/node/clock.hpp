#pragma once
/// /clock from simulated time, for a simulation that is the clock of others.

#include <ros/publisher.h>
#include <ros/time.h>

namespace desert_sim {

/// Simulated time [s] as ROS time. ROS takes 0 for "no time yet": the start is shown as one nanosecond.
/// Throws Error beyond what ROS time can hold (136 years).
ros::Time clock_time(double simulated);

class ClockPublisher {
 public:
  /// Throws ConfigError if another node publishes /clock: between two clocks time would jump to and fro.
  ClockPublisher();
  /// Latched, so that whoever comes while the simulation is paused has a time.
  void publish(double simulated) const;

 private:
  ros::Publisher publisher_;
};

}  // namespace desert_sim
