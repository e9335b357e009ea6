#pragma once
/// ROS time of a launch with /use_sim_time, which stands still until the test moves it: nodes then have all
/// the time that they need.

#include <ros/node_handle.h>
#include <ros/time.h>
#include <rosgraph_msgs/Clock.h>

namespace node_test {

/// To be made once.
class TestClock {
 public:
  TestClock() : publisher_(ros::NodeHandle().advertise<rosgraph_msgs::Clock>("/clock", 10, true)) {
    advance(0);
  }
  const ros::Time& now() const { return now_; }
  void advance(double seconds) {
    now_ += ros::Duration(seconds);
    rosgraph_msgs::Clock message;
    message.clock = now_;
    publisher_.publish(message);
  }

 private:
  ros::Publisher publisher_;
  ros::Time now_{1000};
};

}  // namespace node_test
