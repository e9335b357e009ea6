/// A LatchedPublisher and those who subscribe at the worst moment. This program has its own definition of
/// ros::TopicManager::publish(), which libroscpp finds before its own: it holds open the moment between the
/// sending of a message and the noting of it as latched.
#include "src/ros/support/latched_publisher.hpp"

#include <dlfcn.h>
#include <ros/topic_manager.h>
#include <std_msgs/UInt8.h>

#include <algorithm>
#include <functional>
#include <string>
#include <utility>

#include "test/support/ros/child_process.hpp"
#include "test/support/ros/client.hpp"

namespace {

constexpr const char* topic_name = "/latched";

/// Called once, when a message has been handed to roscpp's thread.
std::function<void()>& after_sending() {
  static std::function<void()> action;
  return action;
}

}  // namespace

namespace ros {

void TopicManager::publish(const std::string& topic, const boost::function<SerializedMessage(void)>& bytes,
                           SerializedMessage& message) {
  using Publish = void (*)(TopicManager*, const std::string&, const boost::function<SerializedMessage(void)>&,
                           SerializedMessage&);
  static const auto of_roscpp = reinterpret_cast<Publish>(
      dlsym(RTLD_NEXT,
            "_ZN3ros12TopicManager7publishERKNSt7__cxx1112basic_stringIcSt11char_traitsIcESaIcEEERKN5boost"
            "8functionIFNS_17SerializedMessageEvEEERSB_"));
  of_roscpp(this, topic, bytes, message);
  if (topic != topic_name) return;
  if (const auto action = std::exchange(after_sending(), nullptr)) action();
}

}  // namespace ros

namespace {

using namespace desert_sim;
using namespace node_test;
using Numbers = Listener<std_msgs::UInt8>;

std_msgs::UInt8 number(std::uint8_t n) {
  std_msgs::UInt8 message;
  message.data = n;
  return message;
}

/// A process of this program, which ends with the first number that it hears as its status. It is another
/// one because all subscribers of a process share a connection.
class Latched : public testing::Test {
 protected:
  /// Publishes 7; the process that has connected when another listener has got it, but the latch has not.
  template <class Publisher>
  std::unique_ptr<ChildProcess> process_beside_the_latch(const Publisher& publisher) {
    const Numbers early(topic_name);
    std::unique_ptr<ChildProcess> late;
    after_sending() = [&] {
      EXPECT_TRUE(wait_until([&] { return early.count() > 0; }));
      late = std::make_unique<ChildProcess>(std::vector<std::string>{"/proc/self/exe", "listen"});
      EXPECT_TRUE(
          wait_until([] { return ros::TopicManager::instance()->getNumSubscribers(topic_name) == 2; }));
    };
    publisher.publish(number(7));
    return late;
  }
  ros::NodeHandle node_;
};

TEST_F(Latched, MessagesReachWhoConnectsBesideTheLatch) {
  const LatchedPublisher<std_msgs::UInt8> publisher(node_, topic_name, 10);
  const auto late = process_beside_the_latch(publisher);
  ASSERT_TRUE(late) << "the moment was not held open";
  EXPECT_EQ(late->wait(), 7);
}

/// Or the test above would show nothing.
TEST_F(Latched, MessagesOfRoscppDoNot) {
  const ros::Publisher publisher = node_.advertise<std_msgs::UInt8>(topic_name, 10, true);
  const auto late = process_beside_the_latch(publisher);
  ASSERT_TRUE(late) << "the moment was not held open";
  publisher.publish(number(8));
  EXPECT_EQ(late->wait(), 8);
}

TEST_F(Latched, MessagesReachWhoConnectsLaterAndInTheirOrder) {
  const LatchedPublisher<std_msgs::UInt8> publisher(node_, topic_name, 10);
  publisher.publish(number(1));
  publisher.publish(number(2));
  const Numbers late(topic_name);
  EXPECT_EQ(late.last().data, 2);
  publisher.publish(number(3));
  ASSERT_TRUE(late.wait_for([](const std_msgs::UInt8& m) { return m.data == 3; }));
  const auto all = late.all();
  EXPECT_TRUE(
      std::is_sorted(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.data < b.data; }));
}

TEST_F(Latched, OnlyWhereItIsAskedFor) {
  const LatchedPublisher<std_msgs::UInt8> publisher(node_, topic_name, 10, false), none;
  publisher.publish(number(1));
  none.publish(number(1));
  EXPECT_FALSE(none);
  const Numbers late(topic_name);
  publisher.publish(number(2));
  EXPECT_TRUE(late.wait_for_count(1));
  EXPECT_EQ(late.all().front().data, 2);
}

int first_number_heard(int argc, char** argv) {
  ros::init(argc, argv, "listener", ros::init_options::AnonymousName);
  ros::NodeHandle keep_alive;
  ros::AsyncSpinner spinner(1);
  spinner.start();
  return Numbers(topic_name).last().data;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1 && std::string(argv[1]) == "listen") return first_number_heard(argc, argv);
  return node_test::run_tests(argc, argv, "latched_publisher");
}
