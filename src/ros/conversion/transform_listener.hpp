#pragma once
/// Listens to transforms, whatever they say.

#include <ros/callback_queue.h>
#include <ros/message_event.h>
#include <ros/spinner.h>
#include <ros/subscriber.h>
#include <tf2/buffer_core.h>
#include <tf2_msgs/TFMessage.h>

namespace desert_sim {

/// Fills a buffer from /tf and /tf_static on a thread of its own, as tf2_ros::TransformListener does. That
/// one throws out of its thread, and so ends the process, for a transform whose stamp is near 2^32 s, and
/// where the clock goes back by more than 2^31 s; here such a transform is ignored, and it is said.
class TransformListener {
 public:
  /// `buffer` outlives the listener.
  explicit TransformListener(tf2::BufferCore& buffer);
  ~TransformListener();
  TransformListener(const TransformListener&) = delete;
  TransformListener& operator=(const TransformListener&) = delete;

 private:
  using TransformEvent = ros::MessageEvent<const tf2_msgs::TFMessage>;
  void receive(const TransformEvent& event, bool is_static);

  tf2::BufferCore& buffer_;
  ros::Time last_received_;  ///< of receive() alone
  ros::CallbackQueue queue_;
  ros::Subscriber transforms_, static_transforms_;
  ros::AsyncSpinner spinner_{1, &queue_};
};

}  // namespace desert_sim
