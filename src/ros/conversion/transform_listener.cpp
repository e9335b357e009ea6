#include "src/ros/conversion/transform_listener.hpp"

#include <ros/console.h>
#include <ros/node_handle.h>

#include "src/client/ros_time.hpp"
#include "src/core/quoted.hpp"

namespace desert_sim {

TransformListener::TransformListener(tf2::BufferCore& buffer) : buffer_(buffer) {
  ros::NodeHandle node;
  node.setCallbackQueue(&queue_);
  const auto subscribe = [&](const char* topic, bool is_static) {
    const boost::function<void(const TransformEvent&)> callback =
        [this, is_static](const TransformEvent& event) { receive(event, is_static); };
    return node.subscribe<tf2_msgs::TFMessage>(topic, 100, callback);
  };
  transforms_ = subscribe("/tf", false);
  static_transforms_ = subscribe("/tf_static", true);
  spinner_.start();
}

TransformListener::~TransformListener() { spinner_.stop(); }

void TransformListener::receive(const TransformEvent& event, bool is_static) {
  const ros::Time now = ros::Time::now();
  if (now < last_received_) {
    ROS_WARN("ROS time has jumped back: the transforms that were received before it are forgotten.");
    buffer_.clear();
  }
  last_received_ = now;
  for (const geometry_msgs::TransformStamped& transform : event.getConstMessage()->transforms) {
    std::string fault;
    // tf2 compares stamps by sums that overflow, and a stamp that it keeps would spoil those that come after
    // it.
    if (!is_static && is_near_the_last_time(transform.header.stamp)) {
      fault = "its stamp is " + std::to_string(transform.header.stamp.sec) + " s";
    } else {
      try {
        buffer_.setTransform(transform, event.getPublisherName(), is_static);
      } catch (const std::exception& e) {
        fault = e.what();
      }
    }
    if (!fault.empty())
      ROS_ERROR_THROTTLE(10, "A transform to frame %s is ignored: %s",
                         in_quotes(transform.child_frame_id).c_str(), fault.c_str());
  }
}

}  // namespace desert_sim
