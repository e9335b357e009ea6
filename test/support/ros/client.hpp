#pragma once
/// What the node tests share: calls, and subscribers that can be waited for. The node is /desert_sim;
/// messages are taken in by a spinner that main() starts.

#include <gtest/gtest.h>
#include <ros/ros.h>

#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "include/desert_sim/client/service_call.hpp"
#include "include/desert_sim/testing/node_process.hpp"

namespace node_test {

using desert_sim::test::patience;

inline bool wait_until(const std::function<bool()>& happened, double seconds = 60) {
  return desert_sim::test::wait_until(happened, seconds);
}

/// The service's answer; a test failure if there is none.
template <class Service>
typename Service::Response call(const std::string& name, const typename Service::Request& request = {}) {
  const std::string service = "/desert_sim/" + name;
  EXPECT_TRUE(ros::service::waitForService(service, ros::Duration(60 * patience()))) << service;
  Service exchange;
  exchange.request = request;
  EXPECT_TRUE(desert_sim::call_service(service, exchange)) << service;
  return exchange.response;
}

/// Keeps all messages of a topic (of the node, unless it begins with /) since it was made; is connected when
/// it is.
template <class Message>
class Listener {
 public:
  explicit Listener(const std::string& name)
      : subscriber_(ros::NodeHandle().subscribe<Message>(
            name.front() == '/' ? name : "/desert_sim/" + name, 100,
            boost::function<void(const boost::shared_ptr<const Message>&)>(
                [this](const boost::shared_ptr<const Message>& m) {
                  const std::lock_guard<std::mutex> lock(mutex_);
                  messages_.push_back(*m);
                }))) {
    EXPECT_TRUE(wait_until([this] { return subscriber_.getNumPublishers() > 0; }))
        << "nobody publishes " << subscriber_.getTopic();
  }
  std::size_t count() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return messages_.size();
  }
  std::vector<Message> all() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return messages_;
  }
  /// The last one; waits for the first.
  Message last() const {
    EXPECT_TRUE(wait_until([this] { return count() > 0; })) << "no message on " << subscriber_.getTopic();
    const std::lock_guard<std::mutex> lock(mutex_);
    return messages_.empty() ? Message() : messages_.back();
  }
  /// The first one that `fits`.
  bool wait_for(const std::function<bool(const Message&)>& fits, double seconds = 60) const {
    return wait_until(
        [&] {
          for (const Message& message : all())
            if (fits(message)) return true;
          return false;
        },
        seconds);
  }
  bool wait_for_count(std::size_t n, double seconds = 60) const {
    return wait_until([&] { return count() >= n; }, seconds);
  }

 private:
  mutable std::mutex mutex_;
  std::vector<Message> messages_;
  ros::Subscriber subscriber_;
};

inline int run_tests(int argc, char** argv, const char* name) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, name);
  ros::NodeHandle keep_alive;
  ros::AsyncSpinner spinner(2);
  spinner.start();
  return RUN_ALL_TESTS();
}

}  // namespace node_test
