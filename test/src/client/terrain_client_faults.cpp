/// TerrainClient on senders that lose, break and die: a sender of this test, and nodes that it starts and
/// kills.
#include <desert_sim/QueryTerrain.h>
#include <desert_sim/Step.h>
#include <ros/master.h>
#include <ros/network.h>
#include <std_msgs/Empty.h>
#include <xmlrpcpp/XmlRpc.h>

#include <atomic>
#include <cmath>
#include <future>
#include <map>
#include <mutex>
#include <string>
#include <thread>

#include "include/desert_sim/client/terrain_client.hpp"
#include "test/support/messages.hpp"
#include "test/support/ros/child_process.hpp"

namespace {

using namespace desert_sim;
using node_test::NodeProcess;
using node_test::wait_until;

const double timeout = 60 * node_test::patience();

// ---- a sender whose messages can be lost ----

/// Publishes as a node does: each new subscriber to keyframes gets a new one. Step n raises cell (0, 0) to n
/// metres.
class Sender {
 public:
  explicit Sender(const std::string& name) {
    ros::NodeHandle node(name);
    updates_ = node.advertise<ElevationUpdate>("elevation_updates", 100);
    keyframes_ =
        node.advertise<ElevationGrid>("elevation", 10, [this](const ros::SingleSubscriberPublisher&) {
          const std::lock_guard<std::mutex> lock(mutex_);
          ++connections_;
          publish_keyframe();
        });
  }
  ~Sender() {
    keyframes_.shutdown();  // no new subscriber finds a sender that is half gone
    updates_.shutdown();
  }
  void keyframe() {
    const std::lock_guard<std::mutex> lock(mutex_);
    publish_keyframe();
  }
  /// `lose`: the update is numbered and goes nowhere.
  void update(bool lose = false) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto message = next_update();
    if (!lose) updates_.publish(message);
  }
  void broken_update() {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto message = next_update();
    message->tiles[0].data.pop_back();
    updates_.publish(message);
  }
  int connections() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return connections_;
  }
  bool heard() const { return keyframes_.getNumSubscribers() > 0 && updates_.getNumSubscribers() > 0; }
  std::uint32_t step() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return step_;
  }

 private:
  ElevationUpdate::Ptr next_update() {
    ++sequence_;
    ++step_;
    return client_test::update(keyframe_, sequence_, step_, static_cast<float>(step_));
  }
  void publish_keyframe() {
    sequence_ = 0;
    ElevationGrid grid = client_test::keyframe(++keyframe_, step_);
    for (std::size_t cell : {0, 1, 130, 131, 260, 261}) grid.elevation[cell] = static_cast<float>(step_);
    keyframes_.publish(grid);
  }

  mutable std::mutex mutex_;
  std::uint32_t keyframe_ = 0, sequence_ = 0, step_ = 1;
  int connections_ = 0;
  ros::Publisher keyframes_, updates_;
};

/// Both ends stand, and the client has what the sender has.
void expect_in_step(const TerrainClient& client, const Sender& sender) {
  ASSERT_TRUE(client.wait_for_step(sender.step(), timeout)) << client.statistics().last_gap;
  EXPECT_TRUE(wait_until([&] { return client.up_to_date(); }));
  EXPECT_EQ(client.map()->at(0, 0), sender.step());
}

/// Of a client that asks once after a gap, and otherwise has patience.
TerrainClient::Options options(const std::string& name) {
  TerrainClient::Options o;
  o.node = name;
  o.shortest_pause = o.longest_pause = 3600;
  return o;
}

TEST(Faults, ALostUpdateIsNoticedAndHealed) {
  Sender sender("/losing");
  const TerrainClient client(ros::NodeHandle(), options("/losing"));
  ASSERT_TRUE(wait_until([&] { return sender.heard() && client.map(); }));
  sender.update();
  expect_in_step(client, sender);
  const std::uint32_t good = sender.step();
  sender.update(true);
  sender.update();
  ASSERT_TRUE(wait_until([&] { return client.statistics().gaps == 1; }));
  EXPECT_NE(client.statistics().last_gap.find("is missing"), std::string::npos)
      << client.statistics().last_gap;
  EXPECT_GE(client.map()->at(0, 0), good) << "the last good map stays until the next keyframe";
  expect_in_step(client, sender);
  EXPECT_EQ(client.statistics().requests, 1u);
  EXPECT_EQ(sender.connections(), 2);
  for (int n = 0; n < 5; ++n) sender.update();
  expect_in_step(client, sender);
  EXPECT_EQ(client.statistics().requests, 1u) << "one was enough";
}

TEST(Faults, ABrokenUpdateIsRefusedAndHealed) {
  Sender sender("/breaking");
  const TerrainClient client(ros::NodeHandle(), options("/breaking"));
  ASSERT_TRUE(wait_until([&] { return sender.heard() && client.map(); }));
  sender.broken_update();
  ASSERT_TRUE(wait_until([&] { return client.statistics().refused == 1; }));
  EXPECT_NE(client.statistics().last_refusal.find("5 values for 2 x 3 cells"), std::string::npos)
      << client.statistics().last_refusal;
  expect_in_step(client, sender);
}

// How the pauses grow, keyframe_requests_test.cpp says.
TEST(Faults, AStreamThatLosesAllTheTimeIsNotAskedAllTheTime) {
  Sender sender("/leaking");
  const TerrainClient client(ros::NodeHandle(), options("/leaking"));
  ASSERT_TRUE(wait_until([&] { return sender.heard() && client.map(); }));
  const auto lose_one = [&] {
    const std::uint64_t gaps = client.statistics().gaps;
    sender.update(true);
    sender.update();
    ASSERT_TRUE(wait_until([&] { return client.statistics().gaps == gaps + 1; }));
  };
  lose_one();
  expect_in_step(client, sender);
  EXPECT_EQ(client.statistics().requests, 1u);
  lose_one();
  // The client looks whether it has to ask after each time that it has taken messages in; so it has looked
  // when it takes in what is sent now.
  const std::uint64_t unusable = client.statistics().unusable;
  sender.update();
  ASSERT_TRUE(wait_until([&] { return client.statistics().unusable > unusable; }));
  EXPECT_EQ(client.statistics().requests, 1u) << "the pause is an hour";
  EXPECT_FALSE(client.up_to_date());
  sender.keyframe();  // by its own rate
  expect_in_step(client, sender);
}

TEST(Faults, AStreamThatLosesAllTheTimeIsAskedAgainAfterAPause) {
  Sender sender("/leaking_on");
  TerrainClient::Options o = options("/leaking_on");
  o.shortest_pause = o.longest_pause = 0.05;
  const TerrainClient client(ros::NodeHandle(), o);
  ASSERT_TRUE(wait_until([&] { return sender.heard() && client.map(); }));
  int n = 0;
  ASSERT_TRUE(wait_until([&] {
    sender.update(++n % 3 == 1);
    return client.statistics().gaps >= 3 && client.statistics().requests >= 3;
  }));
  sender.keyframe();
  expect_in_step(client, sender);
}

TEST(Faults, SlowListenersMissNothingThatTheyAreNotToldOf) {
  Sender sender("/flooding");
  std::promise<void> entered, release;
  std::atomic<bool> slow{false};
  TerrainClient::Options o = options("/flooding");
  o.update_queue = 5;
  o.on_change = [&](const MapChange&) {
    if (!slow.exchange(false)) return;
    entered.set_value();
    release.get_future().wait();
  };
  const TerrainClient client(ros::NodeHandle(), o);
  ASSERT_TRUE(wait_until([&] { return sender.heard() && client.map(); }));
  slow = true;
  sender.update();
  entered.get_future().wait();
  for (int n = 0; n < 20; ++n) sender.update();  // of this process: they are in the queue then
  release.set_value();
  EXPECT_TRUE(wait_until([&] { return client.statistics().gaps > 0; })) << "the queue has overflowed";
  expect_in_step(client, sender);
}

// ---- connections that fail ----

/// A node's interface for connections, which refuses each of them, and counts how often it was asked for.
class RefusingNode {
 public:
  RefusingNode() {
    server_.bindAndListen(0);
    thread_ = std::thread([this] {
      while (!stopping_) server_.work(0.05);
    });
  }
  ~RefusingNode() {
    stopping_ = true;
    thread_.join();
    server_.shutdown();
  }
  void announce(const std::string& node, const std::string& topic, const std::string& type) {
    XmlRpc::XmlRpcValue arguments, result, payload;
    arguments[0] = node;
    arguments[1] = topic;
    arguments[2] = type;
    arguments[3] = "http://" + ros::network::getHost() + ":" + std::to_string(server_.get_port()) + "/";
    ASSERT_TRUE(ros::master::execute("registerPublisher", arguments, result, payload, false));
  }
  int requests(const std::string& topic) {
    const std::lock_guard<std::mutex> lock(mutex_);
    return requests_[topic];
  }

 private:
  struct RequestTopic : XmlRpc::XmlRpcServerMethod {
    RequestTopic(RefusingNode& owner, XmlRpc::XmlRpcServer* server)
        : XmlRpcServerMethod("requestTopic", server), node(owner) {}
    void execute(XmlRpc::XmlRpcValue& arguments, XmlRpc::XmlRpcValue& result) override {
      const std::lock_guard<std::mutex> lock(node.mutex_);
      ++node.requests_[arguments[1]];
      result[0] = 0;
      result[1] = std::string("busy");
      result[2] = 0;
    }
    RefusingNode& node;
  };

  std::mutex mutex_;
  std::map<std::string, int> requests_;
  std::atomic<bool> stopping_{false};
  XmlRpc::XmlRpcServer server_;
  RequestTopic request_topic_{*this, &server_};
  std::thread thread_;
};

TEST(Faults, ARefusedConnectionIsAskedForAgain) {
  const TerrainClient client(ros::NodeHandle(), options("/refusing"));
  RefusingNode node;
  node.announce("/refusing", "/refusing/elevation", ros::message_traits::datatype<ElevationGrid>());
  node.announce("/refusing", "/refusing/elevation_updates", ros::message_traits::datatype<ElevationUpdate>());
  for (const std::string topic : {"/refusing/elevation", "/refusing/elevation_updates"})
    EXPECT_TRUE(wait_until([&] { return node.requests(topic) >= 2; })) << topic;
}

// ---- nodes that come late, and die ----

std::map<std::string, XmlRpc::XmlRpcValue> of_width(int width) { return {{"grid/width", width}}; }

std::uint64_t step(const NodeProcess& node, std::uint32_t steps) {
  Step::Request request;
  request.steps = steps;
  return node.call<Step>("step", request).step;
}

double elevation(const NodeProcess& node, double x, double y) {
  QueryTerrain::Request request;
  request.points.resize(1);
  request.points[0].x = x;
  request.points[0].y = y;
  const QueryTerrain::Response response = node.call<QueryTerrain>("query_terrain", request);
  return response.samples.empty() ? std::nan("") : response.samples[0].elevation;
}

TEST(Lifecycle, AClientMayBeThereBeforeTheNode) {
  const TerrainClient client(ros::NodeHandle(), options("/late"));
  EXPECT_FALSE(client.wait_for_terrain(0.01));
  EXPECT_FALSE(client.up_to_date());
  EXPECT_FALSE(client.connected());
  EXPECT_EQ(client.elevation(20, 0), std::nullopt);
  EXPECT_EQ(client.map(), nullptr);
  const NodeProcess node("/late", of_width(64));
  ASSERT_TRUE(client.wait_for_terrain(timeout));
  EXPECT_EQ(client.map()->info().width, 64u);
  ASSERT_TRUE(client.wait_for_step(step(node, 4), timeout));
}

TEST(Lifecycle, AKilledNodeThatStartsAnewIsFollowed) {
  auto node = std::make_unique<NodeProcess>("/killed", of_width(64));
  const TerrainClient client(ros::NodeHandle(), options("/killed"));
  ASSERT_TRUE(client.wait_for_terrain(timeout));
  for (int n = 0; n < 10; ++n) ASSERT_TRUE(client.wait_for_step(step(*node, 2), timeout));
  // The next node's numbers are seen to begin anew if this one's have come further than its first few.
  ros::Publisher request = ros::NodeHandle().advertise<std_msgs::Empty>("/killed/request_keyframe", 1);
  ASSERT_TRUE(wait_until([&] {
    request.publish(std_msgs::Empty());
    return client.map()->info().keyframe >= 10;
  }));
  node.reset();
  EXPECT_TRUE(client.elevation(30, 10)) << "what it has, it has";

  node = std::make_unique<NodeProcess>("/killed", of_width(40));
  ASSERT_TRUE(wait_until([&] { return client.map()->info().width == 40; }));
  const std::uint64_t reached = step(*node, 7);
  ASSERT_TRUE(client.wait_for_step(reached, timeout));
  EXPECT_TRUE(wait_until([&] { return client.up_to_date() && client.map()->info().step == reached; }));
  EXPECT_NEAR(client.elevation(33.3, 12.1).value(), elevation(*node, 33.3, 12.1), 0.005 + 1e-6);
  EXPECT_EQ(client.map()->elevation(100, 0), std::nullopt) << "east of 40 cells";
  EXPECT_EQ(client.statistics().restarts, 1u);
}

}  // namespace

int main(int argc, char** argv) { return node_test::run_tests(argc, argv, "terrain_client_faults"); }
