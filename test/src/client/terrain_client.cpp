/// TerrainClient on a node that runs: what it holds is what the node says when it is asked.
#include "include/desert_sim/client/terrain_client.hpp"

#include <XmlRpcClient.h>
#include <desert_sim/QueryTerrain.h>
#include <ros/master.h>
#include <ros/network.h>
#include <std_msgs/Empty.h>

#include <atomic>
#include <cmath>

#include "src/core/error.hpp"
#include "test/support/ros/service_tests.hpp"

namespace {

using namespace desert_sim;
using node_test::call;
using node_test::step;
using node_test::wait_until;

constexpr double threshold = 0.01;  // ~update_threshold
const double timeout = 60 * node_test::patience();

bool trigger(const std::string& name) { return call<std_srvs::Trigger>(name).success; }

std::vector<TerrainSample> ask(const std::vector<geometry_msgs::Point>& points) {
  QueryTerrain::Request request;
  request.points = points;
  const QueryTerrain::Response response = call<QueryTerrain>("query_terrain", request);
  EXPECT_TRUE(response.success) << response.message;
  EXPECT_EQ(response.samples.size(), points.size());
  return response.samples;
}

/// The node's own answer for the centre of each cell; `step` becomes that of the answer.
std::vector<double> ask_for_all_cells(const ElevationMap::Info& info, std::uint64_t& step) {
  QueryTerrain::Request request;
  for (std::uint32_t y = 0; y < info.height; ++y)
    for (std::uint32_t x = 0; x < info.width; ++x) {
      request.points.emplace_back();
      request.points.back().x = info.origin_x + (x + 0.5) * info.cell_size;
      request.points.back().y = info.origin_y + (y + 0.5) * info.cell_size;
    }
  const QueryTerrain::Response response = call<QueryTerrain>("query_terrain", request);
  EXPECT_TRUE(response.success) << response.message;
  step = response.step;
  std::vector<double> elevations;
  for (const TerrainSample& sample : response.samples) elevations.push_back(sample.elevation);
  return elevations;
}

double largest_difference(const ElevationMap& map, const std::vector<double>& elevations) {
  const std::vector<float> held = map.elevations();
  EXPECT_EQ(held.size(), elevations.size());
  double largest = 0;
  for (std::size_t i = 0; i < std::min(held.size(), elevations.size()); ++i)
    largest = std::max(largest, std::abs(elevations[i] - static_cast<double>(held[i])));
  return largest;
}

/// From what the node holds now.
double largest_difference(const ElevationMap& map) {
  std::uint64_t any_step;
  return largest_difference(map, ask_for_all_cells(map.info(), any_step));
}

class Client : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(trigger("pause"));
    ASSERT_TRUE(trigger("reset"));
  }
  /// Of a client that asks once after a gap, and otherwise has patience.
  static TerrainClient::Options options() {
    TerrainClient::Options o;
    o.node = "/desert_sim";
    o.shortest_pause = o.longest_pause = 3600;
    return o;
  }
  /// Steps until the client holds a map of which it has been sent some updates.
  static void step_until_updated(const TerrainClient& client) {
    ASSERT_TRUE(wait_until([&] {
      EXPECT_TRUE(client.wait_for_step(step(1).step, timeout));
      return client.map()->info().sequence > 10;
    }));
  }
  const ros::NodeHandle node_;
  const ros::Time begin_ = ros::Time::now();
};

// ---- what it holds ----

TEST_F(Client, GetsTheTerrainOfAPausedNodeAtOnce) {
  const TerrainClient client(node_);
  ASSERT_TRUE(client.wait_for_terrain(timeout));
  EXPECT_TRUE(client.elevation(20, 0));
  EXPECT_EQ(client.elevation(20, 0), client.map()->elevation(20, 0));
  EXPECT_TRUE(client.up_to_date());
  EXPECT_TRUE(client.connected());
  const ElevationMap::Info info = client.map()->info();
  EXPECT_EQ(info.frame, "terrain");
  EXPECT_EQ(info.step, 0u);
  EXPECT_EQ(info.width, 64u);
  EXPECT_EQ(info.height, 48u);
  EXPECT_GE(info.stamp, begin_) << "the time of the reset";
  EXPECT_LE(info.stamp, ros::Time::now());
  // The marker on cells 56…59, 4…6 is in the south-east.
  EXPECT_NEAR(client.elevation(10 + 2 * 57.5, -20 + 2 * 5.5).value(), 7.5, 1e-5);
  EXPECT_NEAR(client.elevation(10 + 2 * 5.5, -20 + 2 * 42.5).value(), 1.5, 1e-5);
  EXPECT_EQ(client.slope(20, 0), 0);
  EXPECT_EQ(client.normal(20, 0)->z, 1);
  EXPECT_FALSE(client.elevation(0, 0));
}

TEST_F(Client, AnswersAsTheNodeDoes) {
  ASSERT_TRUE(step(20).success);
  const TerrainClient client(node_);
  ASSERT_TRUE(client.wait_for_terrain(timeout));
  ASSERT_EQ(client.map()->info().step, 20u);
  std::vector<geometry_msgs::Point> points;
  for (double x = 8; x < 142; x += 1.37)
    for (double y = -21; y < 78; y += 3.11) {
      points.emplace_back();
      points.back().x = x;
      points.back().y = y;
    }
  int outside = 0;
  for (const TerrainSample& sample : ask(points)) {
    const double x = sample.position.x, y = sample.position.y;
    const std::optional<double> z = client.elevation(x, y);
    ASSERT_EQ(z.has_value(), sample.in_bounds) << x << ", " << y;
    if (!z && ++outside) continue;
    ASSERT_NEAR(*z, sample.elevation, 1e-6) << x << ", " << y;
    ASSERT_NEAR(client.slope(x, y).value(), sample.slope, 1e-6) << x << ", " << y;
    const geometry_msgs::Vector3 normal = client.normal(x, y).value();
    ASSERT_NEAR(normal.x, sample.normal.x, 1e-6) << x << ", " << y;
    ASSERT_NEAR(normal.y, sample.normal.y, 1e-6) << x << ", " << y;
    ASSERT_NEAR(normal.z, sample.normal.z, 1e-6) << x << ", " << y;
  }
  EXPECT_GT(outside, 0);
}

TEST_F(Client, StaysWithinTheThresholdOverManySteps) {
  const TerrainClient client(node_, options());
  ASSERT_TRUE(client.wait_for_terrain(timeout));
  const auto start = client.map();
  std::uint64_t reached = 0;
  for (int round = 0; round < 20; ++round) {
    reached = step(5).step;
    ASSERT_TRUE(client.wait_for_step(reached, timeout)) << reached;
  }
  EXPECT_LE(largest_difference(*client.map()), threshold + 1e-6);
  EXPECT_GT(largest_difference(*start), 10 * threshold) << "the terrain has moved meanwhile";
  const TerrainClient::Statistics statistics = client.statistics();
  EXPECT_GE(statistics.keyframes + statistics.updates, 20u);  // `step` publishes both
  EXPECT_EQ(statistics.gaps + statistics.refused + statistics.requests + statistics.restarts, 0u);
  EXPECT_GE(statistics.latency, 0);
  EXPECT_LE(statistics.mean_latency, statistics.largest_latency);
  EXPECT_LE(statistics.largest_latency, (ros::Time::now() - begin_).toSec());
}

TEST_F(Client, FollowsAReset) {
  const TerrainClient client(node_, options());
  ASSERT_TRUE(client.wait_for_terrain(timeout));
  ASSERT_TRUE(client.wait_for_step(step(30).step, timeout));
  ASSERT_TRUE(trigger("reset"));
  ASSERT_TRUE(wait_until([&] { return client.map()->info().step == 0; }));
  EXPECT_LE(largest_difference(*client.map()), threshold + 1e-6);
  EXPECT_EQ(client.statistics().gaps, 0u);
}

// ---- changes ----

TEST_F(Client, TellsOfEveryCellThatChanges) {
  std::mutex mutex;
  std::vector<float> copy;  // written only where the client says that something changed
  std::uint64_t last = 0;
  int calls = 0;
  TerrainClient::Options o = options();
  o.on_change = [&](const MapChange& change) {
    const std::lock_guard<std::mutex> lock(mutex);
    ++calls;
    const ElevationMap::Rectangle& r = change.cells;
    if (change.replaced) copy.assign(change.map->elevations().size(), 0);
    const std::vector<float> cells = change.map->elevations(r);
    for (std::uint32_t y = 0; y < r.height; ++y)
      std::copy_n(cells.begin() + y * r.width, r.width,
                  copy.begin() + (r.y + y) * change.map->info().width + r.x);
    EXPECT_GE(change.map->info().step, last) << "in order";
    last = change.map->info().step;
  };
  const TerrainClient client(node_, o);
  ASSERT_TRUE(client.wait_for_terrain(timeout));
  for (int round = 0; round < 10; ++round) ASSERT_TRUE(client.wait_for_step(step(3).step, timeout));
  ASSERT_TRUE(wait_until([&] {
    const std::lock_guard<std::mutex> lock(mutex);
    return last == 30;
  }));
  const std::lock_guard<std::mutex> lock(mutex);
  EXPECT_EQ(copy, client.map()->elevations());
  EXPECT_GT(calls, 5);
}

// ---- threads ----

TEST_F(Client, ReadersOfManyThreadsSeeWholeMaps) {
  const TerrainClient client(node_, options());
  ASSERT_TRUE(client.wait_for_terrain(timeout));
  std::atomic<bool> stop{false};
  std::atomic<int> backwards{0}, changed{0}, unknown{0}, compared{0};
  std::vector<std::thread> readers;
  for (int n = 0; n < 4; ++n)
    readers.emplace_back([&, n] {
      std::uint64_t last = 0;
      while (!stop) {
        const auto map = client.map();
        const std::vector<float> first = map->elevations();
        backwards += map->info().step < last;
        last = map->info().step;
        unknown += !client.elevation(20 + n, 10) || !client.slope(20, 10 + n) || !client.normal(30, 30);
        client.statistics();
        EXPECT_TRUE(wait_until([&] { return stop || client.map() != map; }));
        changed += map->elevations() != first;
        ++compared;
      }
    });
  EXPECT_TRUE(wait_until([&] {
    return client.wait_for_step(step(1).step, timeout) && client.statistics().updates > 25 && compared > 25;
  }));
  stop = true;
  for (std::thread& reader : readers) reader.join();
  EXPECT_EQ(backwards, 0);
  EXPECT_EQ(changed, 0) << "a map that someone holds never changes";
  EXPECT_EQ(unknown, 0);
  EXPECT_EQ(client.statistics().gaps, 0u);
}

TEST_F(Client, UpdatesAloneKeepItWithinTheThreshold) {
  const TerrainClient client(node_, options());
  ASSERT_TRUE(client.wait_for_terrain(timeout));
  step_until_updated(client);
  const auto first = client.map();
  std::vector<double> elevations;
  for (int n = 0; n < 20; ++n) {
    const std::uint64_t reached = step(1).step;
    ASSERT_TRUE(client.wait_for_step(reached, timeout));
    std::uint64_t asked = 0;
    const auto map = client.map();
    elevations = ask_for_all_cells(map->info(), asked);
    EXPECT_EQ(asked, reached);
    EXPECT_EQ(map->info().step, reached);
    EXPECT_GT(map->info().sequence, 10u);
    EXPECT_LE(largest_difference(*map, elevations), threshold + 1e-6) << "step " << reached;
  }
  EXPECT_GT(largest_difference(*first, elevations), threshold) << "it moves";
  EXPECT_EQ(client.statistics().gaps + client.statistics().refused + client.statistics().requests, 0u);
}

TEST_F(Client, AQueueOfTheCallersTakesMessagesInWhenItIsServed) {
  ros::CallbackQueue queue;
  ros::NodeHandle node;
  node.setCallbackQueue(&queue);
  TerrainClient::Options o = options();
  o.own_thread = false;
  o.shortest_pause = o.longest_pause = 1e-3;
  const TerrainClient client(node, o);
  ASSERT_TRUE(wait_until([&] { return !queue.isEmpty(); }));
  // Its thread goes on meanwhile, and asks for what nobody takes in.
  const std::uint64_t requests = client.statistics().requests;
  ASSERT_TRUE(wait_until([&] { return client.statistics().requests >= requests + 2; }));
  EXPECT_FALSE(client.wait_for_terrain(0)) << "nobody serves the queue";
  ASSERT_TRUE(wait_until([&] {
    queue.callAvailable();
    return client.map() != nullptr;
  }));
  EXPECT_TRUE(client.wait_for_terrain(0));
}

// roscpp gives both one connection, so that the node does not see that the second has come: it has to ask,
// unless a keyframe for the first comes just then (the node learns late that it listens to updates, too).
TEST_F(Client, TwoInOneProcessBothGetThePausedTerrain) {
  const TerrainClient first(node_, options());
  ASSERT_TRUE(first.wait_for_terrain(timeout));
  ASSERT_TRUE(first.wait_for_step(step(6).step, timeout));
  TerrainClient::Options o = options();
  o.shortest_pause = o.longest_pause = 0.05;
  const TerrainClient second(node_, o);
  ASSERT_TRUE(second.wait_for_terrain(timeout));
  EXPECT_EQ(second.map()->info().step, 6u);
  ASSERT_TRUE(first.wait_for_step(step(5).step, timeout) && second.wait_for_step(11, timeout));
  EXPECT_LE(largest_difference(*first.map()), threshold + 1e-6);
  EXPECT_LE(largest_difference(*second.map()), threshold + 1e-6);
}

/// Tells the node that nobody publishes requests any more: as where it is refused by a publisher that had
/// just gone and come again, it does not connect by itself after that.
void make_the_node_deaf_to_requests() {
  XmlRpc::XmlRpcValue arguments, result, uri;
  arguments[0] = ros::this_node::getName();
  arguments[1] = "/desert_sim";
  ASSERT_TRUE(ros::master::execute("lookupNode", arguments, result, uri, false));
  std::string host;
  std::uint32_t port = 0;
  ASSERT_TRUE(ros::network::splitURI(uri, host, port));
  XmlRpc::XmlRpcClient node(host.c_str(), static_cast<int>(port));
  XmlRpc::XmlRpcValue nobody, told;
  nobody[0] = "/master";
  nobody[1] = "/desert_sim/request_keyframe";
  nobody[2].setSize(0);
  ASSERT_TRUE(node.execute("publisherUpdate", nobody, told) && !node.isFault());
}

TEST_F(Client, ANodeThatDoesNotListenToRequestsIsToldOfThemAgain) {
  const TerrainClient first(node_, options());
  ASSERT_TRUE(first.wait_for_terrain(timeout));
  const ros::Publisher requests =
      ros::NodeHandle().advertise<std_msgs::Empty>("/desert_sim/request_keyframe", 1);
  ASSERT_TRUE(wait_until([&] { return requests.getNumSubscribers() > 0; }));
  make_the_node_deaf_to_requests();
  ASSERT_TRUE(wait_until([&] { return requests.getNumSubscribers() == 0; }));
  TerrainClient::Options o = options();
  o.shortest_pause = o.longest_pause = 0.05;
  const TerrainClient second(node_, o);  // needs a keyframe, and shares the connection of the first
  EXPECT_TRUE(second.wait_for_terrain(timeout));
}

TEST_F(Client, EndsWhileMessagesCome) {
  // Over a connection that is there before: roscpp loses a call now and then when threads of one process open
  // new ones at once.
  ros::ServiceClient steps = ros::NodeHandle().serviceClient<Step>("/desert_sim/step", true);
  ASSERT_TRUE(steps.isValid());
  std::atomic<bool> stop{false};
  std::thread stepper([&] {
    while (!stop) {
      Step exchange;
      exchange.request.steps = 1;
      EXPECT_TRUE(steps.call(exchange) && exchange.response.success) << exchange.response.message;
    }
  });
  for (int n = 0; n < 12; ++n) {
    TerrainClient::Options o = options();
    o.own_thread = n % 2 == 0;  // else the spinner of main()
    const TerrainClient client(node_, o);
    EXPECT_TRUE(n % 4 > 1 || client.wait_for_terrain(timeout));
  }
  stop = true;
  stepper.join();
}

TEST_F(Client, RefusesOptionsThatCannotBe) {
  const auto refused = [&](const char* names, const std::function<void(TerrainClient::Options&)>& spoil) {
    TerrainClient::Options o;
    o.node = "/desert_sim";
    spoil(o);
    try {
      const TerrainClient client(node_, o);
      FAIL() << names;
    } catch (const ConfigError& e) {
      EXPECT_NE(std::string(e.what()).find(names), std::string::npos) << e.what();
    }
  };
  refused("'a b/elevation'", [](auto& o) { o.node = "a b"; });
  refused("'1/2'", [](auto& o) { o.updates_topic = "1/2"; });
  refused("update_queue is 0", [](auto& o) { o.update_queue = 0; });
  refused("0 < shortest_pause", [](auto& o) { o.shortest_pause = 0; });
  refused("0 < shortest_pause", [](auto& o) { o.shortest_pause = 20; });
  refused("nan", [](auto& o) { o.longest_pause = std::nan(""); });
}

}  // namespace

int main(int argc, char** argv) { return node_test::run_tests(argc, argv, "terrain_client"); }
