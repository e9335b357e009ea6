#pragma once
/// Calls of ROS services.

#include <ros/node_handle.h>

#include <string>

namespace desert_sim {

/// Calls a service once; whether it answered. The connection is of this call alone and is asked to persist:
/// the node then leaves it to the caller to close it. roscpp loses an answer now and then where the node
/// closes it (ros_comm issue 1976: the end of the connection may be seen before the answer that was sent
/// ahead of it).
template <class Service>
bool call_service(const std::string& name, Service& exchange) {
  constexpr bool persistent = true;
  return ros::NodeHandle().serviceClient<Service>(name, persistent).call(exchange);
}

}  // namespace desert_sim
