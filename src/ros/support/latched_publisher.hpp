#pragma once
/// Topics whose last message is sent to whoever subscribes later.

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <boost/make_shared.hpp>
#include <boost/shared_ptr.hpp>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

namespace desert_sim {

/// Like a latching ros::Publisher, which loses a message now and then: roscpp notes what is latched only once
/// it has handed the message to its own thread, and who connects between the two gets it neither way. Where
/// no other message follows, as in a paused simulation, that is for ever. So a message is published twice if
/// there are more subscribers after it than before.
///
/// As ros::Publisher, a handle: copies publish the same topic, which ends with the last of them.
template <class Message>
class LatchedPublisher {
 public:
  using Pointer = boost::shared_ptr<const Message>;

  LatchedPublisher() = default;
  /// Without `latched` it is a ros::Publisher.
  LatchedPublisher(ros::NodeHandle node, const std::string& topic, std::uint32_t queue, bool latched = true)
      : mutex_(std::make_shared<std::mutex>()), publisher_(node.advertise<Message>(topic, queue, latched)) {}

  /// False before it has a topic, and where ROS was shutting down and gave it none.
  explicit operator bool() const { return publisher_; }

  /// Does nothing where this is false.
  void publish(const Pointer& message) const {
    if (!publisher_) return;
    const std::lock_guard<std::mutex> lock(*mutex_);  // so that none comes before the second time
    const std::uint32_t before = publisher_.getNumSubscribers();
    publisher_.publish(message);
    if (publisher_.isLatched() && publisher_.getNumSubscribers() > before) publisher_.publish(message);
  }
  void publish(const Message& message) const { publish(boost::make_shared<const Message>(message)); }

 private:
  std::shared_ptr<std::mutex> mutex_;
  ros::Publisher publisher_;
};

}  // namespace desert_sim
