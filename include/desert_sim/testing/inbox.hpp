#pragma once
/// The messages of a topic, which can be waited for.

#include <ros/node_handle.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <vector>

namespace desert_sim::test {

/// Keeps all messages since it was made. The callback queue of the node handle has to be served by another
/// thread.
template <class Message>
class Inbox {
 public:
  using Pointer = boost::shared_ptr<const Message>;

  Inbox(ros::NodeHandle& node, const std::string& topic) {
    const boost::function<void(const Pointer&)> keep = [this](const Pointer& message) {
      const std::lock_guard<std::mutex> lock(mutex_);
      messages_.push_back(message);
      changed_.notify_all();
    };
    subscriber_ =
        node.subscribe<Message>(topic, 100, keep, ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
  }
  ~Inbox() { subscriber_.shutdown(); }  // waits for a callback that runs
  Inbox(const Inbox&) = delete;
  Inbox& operator=(const Inbox&) = delete;

  std::size_t count() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return messages_.size();
  }
  /// The messages from number `first` on.
  std::vector<Pointer> since(std::size_t first) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return {messages_.begin() + static_cast<std::ptrdiff_t>(first), messages_.end()};
  }
  /// Null before the first one.
  Pointer last() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return messages_.empty() ? nullptr : messages_.back();
  }
  /// Waits, at most so many seconds of wall time, until the last message fits; whether it does.
  template <class Fits>
  bool wait_for(const Fits& fits, double seconds) const {
    std::unique_lock<std::mutex> lock(mutex_);
    return changed_.wait_for(lock, std::chrono::duration<double>(seconds),
                             [&] { return !messages_.empty() && fits(*messages_.back()); });
  }
  bool wait_for_more_than(std::size_t n, double seconds) const {
    std::unique_lock<std::mutex> lock(mutex_);
    return changed_.wait_for(lock, std::chrono::duration<double>(seconds),
                             [&] { return messages_.size() > n; });
  }

 private:
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  std::vector<Pointer> messages_;
  ros::Subscriber subscriber_;
};

}  // namespace desert_sim::test
