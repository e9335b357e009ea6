#pragma once
/// Arithmetic with ROS times that hold for all that a message or /clock can say. Those of ros::Time throw
/// where a result is beyond 32 bits of seconds (a time near 2^32 s and any other), and a thread that catches
/// nothing ends its process.

#include <ros/time.h>

#include <algorithm>
#include <cmath>

namespace desert_sim {

/// `later` - `earlier` [s].
inline double seconds_between(const ros::Time& earlier, const ros::Time& later) {
  return (static_cast<double>(later.sec) - static_cast<double>(earlier.sec)) +
         (static_cast<double>(later.nsec) - static_cast<double>(earlier.nsec)) * 1e-9;
}

/// The time nearest to `seconds` that a ros::Time can be; 0 for NaN.
inline ros::Time nearest_time(double seconds) {
  constexpr double last = 4294967295.0;
  return std::isnan(seconds) ? ros::Time() : ros::Time(std::clamp(seconds, 0.0, last));
}

/// Whether the time is so near to the last one that can be told (within a day) that libraries of ROS, which
/// add durations to it, would throw.
inline bool is_near_the_last_time(const ros::Time& time) { return time.sec >= 4294967295U - 86400U; }

}  // namespace desert_sim
