#pragma once
/// The newest message of a topic, received on rviz's threads for slow work and handed over to its frames.

#include <ros/node_handle.h>

#include <mutex>
#include <string>

namespace desert_sim {

template <class Message>
class TopicInbox {
 public:
  using ConstPtr = typename Message::ConstPtr;

  /// An empty topic unsubscribes. `node` has the callback queue; see rviz::Display::threaded_nh_.
  void subscribe(ros::NodeHandle& node, const std::string& topic) {
    subscriber_.shutdown();  // waits for a callback that runs
    newest_.reset();
    if (topic.empty()) return;
    subscriber_ = node.subscribe<Message>(topic, 1, [this](const ConstPtr& message) {
      const std::lock_guard<std::mutex> lock(mutex_);
      newest_ = message;
    });
  }
  ~TopicInbox() { subscriber_.shutdown(); }
  TopicInbox() = default;
  TopicInbox(const TopicInbox&) = delete;
  TopicInbox& operator=(const TopicInbox&) = delete;

  bool subscribed() const { return static_cast<bool>(subscriber_); }
  bool connected() const { return subscriber_.getNumPublishers() > 0; }
  /// The newest message since the last call; null if there is none.
  ConstPtr take() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return std::exchange(newest_, nullptr);
  }

 private:
  ros::Subscriber subscriber_;
  std::mutex mutex_;
  ConstPtr newest_;
};

}  // namespace desert_sim
