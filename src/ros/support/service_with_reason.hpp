#pragma once
/// Services whose answer has no field for a reason (grid_map_msgs/GetGridMap,
/// dynamic_reconfigure/Reconfigure): a call that is refused fails, and the reason reaches the caller all the
/// same.

#include <ros/advertise_service_options.h>
#include <ros/console.h>
#include <ros/serialization.h>
#include <ros/service_callback_helper.h>

#include <boost/make_shared.hpp>
#include <functional>
#include <string>
#include <utility>

#include "src/core/error.hpp"

namespace desert_sim {

/// Serves a request by a function that throws what it refuses. A call that fails has room for a reason, which
/// clients show. call() must return true all the same: roscpp then sends what is in `response`, whose first
/// byte tells the client whether the call failed; to failures of its own it adds no reason.
template <class Service>
class CallbackWithReason : public ros::ServiceCallbackHelper {
 public:
  using Request = typename Service::Request;
  using Response = typename Service::Response;
  using Serve = std::function<void(const Request&, Response&)>;
  explicit CallbackWithReason(Serve serve) : serve_(std::move(serve)) {}

  bool call(ros::ServiceCallbackHelperCallParams& params) override {
    try {
      Request request;
      ros::serialization::deserializeMessage(params.request, request);
      Response response;
      serve_(request, response);
      params.response = ros::serialization::serializeServiceResponse(true, response);
    } catch (const std::exception& e) {
      if (!dynamic_cast<const ConfigError*>(&e)) ROS_ERROR("A service failed: %s", e.what());
      params.response = ros::serialization::serializeServiceResponse(false, limited_message(e.what()));
    }
    return true;
  }

 private:
  Serve serve_;
};

/// The options to advertise `name` with; calls of `serve` come from the queue of the node handle.
template <class Service>
ros::AdvertiseServiceOptions service_with_reason(const std::string& name,
                                                 typename CallbackWithReason<Service>::Serve serve) {
  using Request = typename Service::Request;
  using Response = typename Service::Response;
  ros::AdvertiseServiceOptions options;
  options.init<Service>(name, [](Request&, Response&) { return false; });
  options.helper = boost::make_shared<CallbackWithReason<Service>>(std::move(serve));
  return options;
}

}  // namespace desert_sim
