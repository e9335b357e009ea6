#pragma once
/// How services answer that have the fields success and message.

#include <ros/console.h>

#include <string>

#include "src/core/error.hpp"

namespace desert_sim {

/// Calls `serve`. What it refuses (ConfigError), or any other failure, becomes the answer success = false
/// with the reason. Always true, which callbacks return so that the answer, with its reason, reaches who
/// asked.
template <class Response, class Serve>
bool answer(const std::string& service, Response& response, const Serve& serve) {
  try {
    serve();
    response.success = true;
  } catch (const ConfigError& e) {
    response.success = false;
    response.message = e.what();
  } catch (const std::exception& e) {
    ROS_ERROR("The service %s failed: %s", service.c_str(), e.what());
    response.success = false;
    response.message = limited_message(e.what());
  }
  return true;
}

}  // namespace desert_sim
