#pragma once
/// What the tests of rovers share.

#include <desert_sim/DriveRover.h>
#include <desert_sim/LoadRover.h>
#include <desert_sim/RoverStatus.h>
#include <desert_sim/SaveRover.h>
#include <desert_sim/SetRoverPose.h>
#include <nav_msgs/Odometry.h>
#include <std_srvs/Trigger.h>

#include <string>

#include "test/support/ros/service_tests.hpp"

namespace node_test {

/// The answer of a service of any node; a test failure if there is none.
template <class Service>
typename Service::Response ask(const std::string& service, const typename Service::Request& request = {}) {
  EXPECT_TRUE(ros::service::waitForService(service, ros::Duration(60 * desert_sim::test::patience())))
      << service;
  Service exchange;
  exchange.request = request;
  EXPECT_TRUE(desert_sim::call_service(service, exchange)) << service;
  return exchange.response;
}

/// Of the rover's node; 0 seconds: until the next command.
inline desert_sim::DriveRover::Response drive(const std::string& node, double forward, double yaw_rate,
                                              double seconds = 0) {
  desert_sim::DriveRover::Request request;
  request.twist.linear.x = forward;
  request.twist.angular.z = yaw_rate;
  request.seconds = seconds;
  return ask<desert_sim::DriveRover>(node + "/drive", request);
}

inline desert_sim::SetRoverPose::Response set_pose(const std::string& node, double x, double y, double yaw) {
  desert_sim::SetRoverPose::Request request;
  request.pose.x = x;
  request.pose.y = y;
  request.pose.theta = yaw;
  return ask<desert_sim::SetRoverPose>(node + "/set_pose", request);
}

}  // namespace node_test
