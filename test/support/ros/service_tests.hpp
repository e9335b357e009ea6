#pragma once
/// What the tests of services share.

#include <desert_sim/Step.h>
#include <geometry_msgs/TransformStamped.h>
#include <std_srvs/Trigger.h>

#include <cmath>
#include <limits>
#include <string>

#include "test/support/ros/client.hpp"

namespace node_test {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN(),
                 infinity = std::numeric_limits<double>::infinity();

inline desert_sim::Step::Response step(std::uint32_t steps) {
  desert_sim::Step::Request request;
  request.steps = steps;
  return call<desert_sim::Step>("step", request);
}

inline std::string hash() { return step(0).state_hash; }

/// Refused, the hash stays, and the message has both texts in it.
template <class Service>
void expect_refused(const std::string& name, const typename Service::Request& request,
                    const std::string& what, const std::string& allowed) {
  const std::string before = hash();
  const auto response = call<Service>(name, request);
  EXPECT_FALSE(response.success) << name << " took " << what;
  EXPECT_NE(response.message.find(what), std::string::npos)
      << "'" << what << "' is not named by: " << response.message;
  EXPECT_NE(response.message.find(allowed), std::string::npos)
      << "'" << allowed << "' is not named by: " << response.message;
  EXPECT_EQ(hash(), before) << name << ": " << response.message;
}

/// "rover" stands at (50, 30) of the terrain and looks north.
inline geometry_msgs::TransformStamped rover_frame() {
  geometry_msgs::TransformStamped rover;
  rover.header.stamp = ros::Time::now();
  rover.header.frame_id = "terrain";
  rover.child_frame_id = "rover";
  rover.transform.translation.x = 50;
  rover.transform.translation.y = 30;
  rover.transform.rotation.z = rover.transform.rotation.w = std::sqrt(0.5);
  return rover;
}

/// Each test begins with the scenario's start.
class Services : public testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(call<std_srvs::Trigger>("reset").success); }
};

}  // namespace node_test
