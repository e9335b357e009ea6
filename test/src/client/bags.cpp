/// What has been recorded of a node plays as the node did: for clients that follow its clock, that come late,
/// and that see it again and again.
///
/// The recording is of two parts: `short.bag` of one stretch of the run, whose keyframes are all at its
/// beginning, and `long.bag` of a second one, with more of them on the way. The test writes them itself, as
/// rosbag does, because it has to know when the last message of the run has been recorded. Players start
/// paused, and go on when they know who listens.
#include <XmlRpc.h>
#include <desert_sim/GetSubmap.h>
#include <desert_sim/SimulationStatus.h>
#include <desert_sim/Step.h>
#include <desert_sim/WindField.h>
#include <map_msgs/OccupancyGridUpdate.h>
#include <nav_msgs/OccupancyGrid.h>
#include <ros/network.h>
#include <rosbag/bag.h>
#include <std_msgs/Empty.h>
#include <std_srvs/SetBool.h>

#include <algorithm>
#include <atomic>
#include <filesystem>

#include "include/desert_sim/client/terrain_client.hpp"
#include "src/grid_map/grid_map_msg.hpp"
#include "test/support/ros/child_process.hpp"

namespace {

namespace fs = std::filesystem;
using namespace desert_sim;
using node_test::ChildProcess;
using node_test::Listener;
using node_test::NodeProcess;
using node_test::wait_until;

using Cells = std::vector<float>;

const double timeout = 60 * node_test::patience();

/// A topic of which the recording has one message, in the middle: there a player can be told to pause.
constexpr const char* marker = "/bags/marker";

struct Recording {
  std::string bag;
  std::uint64_t last_step = 0, marker_step = 0;
  double length = 0;  ///< [s]
};

/// The connections over which a node sends this topic to this process, as the node knows them.
int connections(const std::string& node, const std::string& topic) {
  XmlRpc::XmlRpcValue request, response, uri, caller, answer;
  request[0] = caller[0] = ros::this_node::getName();
  request[1] = node;
  std::string host;
  std::uint32_t port = 0;
  if (!ros::master::execute("lookupNode", request, response, uri, false) ||
      !ros::network::splitURI(static_cast<std::string>(uri), host, port))
    return 0;
  XmlRpc::XmlRpcClient client(host.c_str(), static_cast<int>(port), "/");
  if (!client.execute("getBusInfo", caller, answer) || client.isFault()) return 0;
  int found = 0;
  for (int n = 0; n < answer[2].size(); ++n) {
    XmlRpc::XmlRpcValue& connection = answer[2][n];  // number, other end, direction, transport, topic
    found += static_cast<std::string>(connection[1]) == ros::this_node::getName() &&
             static_cast<std::string>(connection[2]) == "o" &&
             static_cast<std::string>(connection[4]) == topic;
  }
  return found;
}

// ---- recording ----

/// Writes what the node publishes.
class Recorder {
 public:
  explicit Recorder(const std::string& path) : bag_(path, rosbag::bagmode::Write) {
    record<ElevationGrid>("elevation");
    record<ElevationUpdate>("elevation_updates");
    record<GridMap>("grid_map");
    record<nav_msgs::OccupancyGrid>("costmap");
    record<map_msgs::OccupancyGridUpdate>("costmap_updates");
    record<WindField>("wind");
    record<SimulationStatus>("status");
  }
  ~Recorder() { subscribers_.clear(); }

  std::size_t count(const std::string& topic) {
    const std::lock_guard<std::mutex> lock(mutex_);
    return counts_[topic];
  }
  /// Whether all that a step changes has come.
  bool has(std::uint64_t step) {
    const std::lock_guard<std::mutex> lock(mutex_);
    return update_.step == step && wind_.step == step && status_.step == step &&
           grid_map_ == status_.header.stamp;
  }
  ElevationUpdate update() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return update_;
  }
  ElevationGrid keyframe() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return keyframe_;
  }
  void mark() {
    const std::lock_guard<std::mutex> lock(mutex_);
    bag_.write(marker, now(), std_msgs::Empty());
  }
  double length() const { return (end_ - begin_).toSec(); }

 private:
  template <class Message>
  void record(const std::string& topic) {
    using Event = ros::MessageEvent<const Message>;
    const std::string name = "/desert_sim/" + topic;
    subscribers_.push_back(ros::NodeHandle().subscribe<Message, const Event&>(
        name, 0, boost::function<void(const Event&)>([this, name, topic](const Event& event) {
          const std::lock_guard<std::mutex> lock(mutex_);
          bag_.write(name, now(), *event.getConstMessage(), event.getConnectionHeaderPtr());
          ++counts_[topic];
          note(*event.getConstMessage());
        })));
  }
  /// This process follows the clock of what is played; the recording has the computer's time.
  ros::Time now() {
    const ros::WallTime wall = ros::WallTime::now();
    end_ = ros::Time(wall.sec, wall.nsec);
    if (begin_.isZero()) begin_ = end_;
    return end_;
  }
  void note(const ElevationGrid& m) { keyframe_ = m; }
  void note(const ElevationUpdate& m) { update_ = m; }
  void note(const GridMap& m) { grid_map_ = m.info.header.stamp; }
  void note(const WindField& m) { wind_ = m; }
  void note(const SimulationStatus& m) { status_ = m; }
  template <class Message>
  void note(const Message&) {}

  std::mutex mutex_;  ///< guards the rest
  rosbag::Bag bag_;
  std::map<std::string, std::size_t> counts_;
  ros::Time begin_, end_, grid_map_;
  ElevationGrid keyframe_;
  ElevationUpdate update_;
  WindField wind_;
  SimulationStatus status_;
  std::vector<ros::Subscriber> subscribers_;
};

// ---- playing ----

class Player {
 public:
  explicit Player(const Recording& recording, const std::vector<std::string>& more = {"--keep-alive"})
      : name_("/player_" + std::to_string(++number_)), process_(words(recording, more, name_)) {}

  /// Waits until it sends these topics to this process when there is something to send.
  void know_subscribers(const std::vector<std::string>& topics) const {
    for (const std::string& topic : topics)
      ASSERT_TRUE(wait_until([&] { return connections(name_, "/desert_sim/" + topic) > 0; })) << topic;
  }
  /// Goes on, once it has paused.
  void go_on() const {
    const std::string service = name_ + "/pause_playback";
    ASSERT_TRUE(wait_until([&] {
      std_srvs::SetBool exchange;
      exchange.request.data = false;
      return ros::service::exists(service, false) && call_service(service, exchange) &&
             exchange.response.success;
    }));
  }
  int end() { return process_.end(SIGINT); }
  /// Since it was started.
  double seconds() const { return (ros::SteadyTime::now() - begin_).toSec(); }

 private:
  static std::vector<std::string> words(const Recording& recording, const std::vector<std::string>& more,
                                        const std::string& name) {
    std::vector<std::string> all{"rosrun", "rosbag", "play", "--clock", "--delay=0", "--pause"};
    all.insert(all.end(), more.begin(), more.end());
    all.insert(all.end(), {"--quiet", recording.bag, "__name:=" + name.substr(1)});
    return all;
  }

  static inline int number_ = 0;
  const std::string name_;
  const ros::SteadyTime begin_ = ros::SteadyTime::now();
  ChildProcess process_;
};

/// For who reads what failed.
std::string told(const TerrainClient& client) {
  const TerrainClient::Statistics s = client.statistics();
  return "client: connected " + std::to_string(client.connected()) + ", step " +
         std::to_string(client.map() ? client.map()->info().step : 0) + ", keyframes " +
         std::to_string(s.keyframes) + ", updates " + std::to_string(s.updates) + ", late " +
         std::to_string(s.late) + ", unusable " + std::to_string(s.unusable) + ", restarts " +
         std::to_string(s.restarts) + ", requests " + std::to_string(s.requests) + ", gaps " +
         std::to_string(s.gaps) + ": " + s.last_gap;
}

class Bags : public testing::Test {
 protected:
  /// Not for the suite: what fails there only skips its tests.
  void SetUp() override {
    if (long_.last_step == 0) record_both();
    ASSERT_FALSE(HasFailure());
    ASSERT_GT(long_.last_step, short_.last_step + 20);
  }
  static void TearDownTestSuite() { fs::remove_all(folder()); }

  static std::string folder() { return "/tmp/desert_sim_bags_" + std::to_string(getpid()); }
  static void record_both();
  static void record(const NodeProcess& node, Recording& recording, const std::string& name,
                     int keyframes_on_the_way);
  static void step(const NodeProcess& node, Recorder& recorder, Recording& recording);

  static TerrainClient::Options options(std::function<void(const MapChange&)> on_change = {}) {
    TerrainClient::Options o;
    o.node = "/desert_sim";
    o.on_change = std::move(on_change);
    return o;
  }
  /// Of a client that waits for keyframes, as the player takes no requests.
  static TerrainClient::Options patient_options(std::function<void(const MapChange&)> on_change = {}) {
    TerrainClient::Options o = options(std::move(on_change));
    o.shortest_pause = o.longest_pause = 3600;
    return o;
  }
  /// The client holds the terrain of the recording's end.
  static void expect_at_the_end(const TerrainClient& client, const Recording& recording) {
    ASSERT_TRUE(wait_until([&] { return client.map() && client.map()->info().step == recording.last_step; }))
        << "not at step " << recording.last_step << "; " << told(client);
    EXPECT_TRUE(client.up_to_date());
    EXPECT_EQ(client.map()->elevations(), live_.at(recording.last_step));
  }
  static void play_in_a_loop_and_expect(const Recording& recording);

  static inline Recording short_, long_;
  static inline std::map<std::uint64_t, Cells> live_;  ///< by step, as the node itself has answered
};

/// Another step, until all of it has been recorded.
void Bags::step(const NodeProcess& node, Recorder& recorder, Recording& recording) {
  Step::Request one;
  one.steps = 1;
  recording.last_step = node.call<Step>("step", one).step;
  const ElevationGrid keyframe = recorder.keyframe();
  GetSubmap::Request whole;
  whole.length_x = keyframe.width * keyframe.cell_size;
  whole.length_y = keyframe.height * keyframe.cell_size;
  whole.center.x = keyframe.origin.position.x + whole.length_x / 2;
  whole.center.y = keyframe.origin.position.y + whole.length_y / 2;
  whole.layers = {"elevation"};
  live_[recording.last_step] = node.call<GetSubmap>("get_submap", whole).map.layers.at(0).data;
}

void Bags::record(const NodeProcess& node, Recording& recording, const std::string& name,
                  int keyframes_on_the_way) {
  recording.bag = folder() + "/" + name;
  Recorder recorder(recording.bag);
  for (const char* topic : {"elevation", "grid_map", "costmap", "wind", "status"})
    ASSERT_TRUE(wait_until([&] { return recorder.count(topic) > 0; })) << topic;
  // The node has sent what new subscribers are sent, and knows that they learn changes as updates, when two
  // updates build on one keyframe.
  std::uint32_t keyframe = 0;
  ASSERT_TRUE(wait_until([&] {
    step(node, recorder, recording);
    return recorder.count("elevation_updates") > 0;
  }));
  ASSERT_TRUE(wait_until([&] {
    step(node, recorder, recording);
    EXPECT_TRUE(wait_until([&] { return recorder.has(recording.last_step); })) << recording.last_step;
    return std::exchange(keyframe, recorder.update().keyframe) == recorder.update().keyframe;
  }));
  const std::size_t keyframes = recorder.count("elevation");
  ros::Publisher asks = ros::NodeHandle().advertise<std_msgs::Empty>("/desert_sim/request_keyframe", 1);
  ASSERT_TRUE(wait_until([&] { return asks.getNumSubscribers() > 0; }));
  for (int part = 0; part <= keyframes_on_the_way; ++part) {
    for (int n = 0; n < 8; ++n) step(node, recorder, recording);
    ASSERT_TRUE(wait_until([&] { return recorder.has(recording.last_step); })) << recording.last_step;
    ASSERT_EQ(recorder.count("elevation"), keyframes + static_cast<std::size_t>(part));
    if (part == keyframes_on_the_way) break;
    if (part == keyframes_on_the_way / 2) {
      recorder.mark();
      recording.marker_step = recording.last_step;
    }
    asks.publish(std_msgs::Empty());
    ASSERT_TRUE(wait_until([&] { return recorder.count("elevation") > keyframes + part; }));
  }
  recording.length = recorder.length();
}

void Bags::record_both() {
  fs::create_directories(folder());
  // Dunes, which move with every step.
  NodeProcess node("/desert_sim", {{"scenario", std::string("barchan")},
                                   {"grid/width", 96},
                                   {"grid/height", 64},
                                   {"update_rate", 0},
                                   {"update_threshold", 0.0},
                                   {"grid_map_rate", 0},
                                   {"costmap_update_rate", 0},
                                   {"costmap_keyframe_rate", 0},
                                   {"wind_rate", 0},
                                   {"status_rate", 0}});
  record(node, short_, "short.bag", 0);
  record(node, long_, "long.bag", 5);
  ASSERT_GT(short_.last_step, 5u);
  EXPECT_EQ(node.end(SIGINT), 0);
  ros::param::set("/use_sim_time", true);  // for the players too
}

// ---- played once, and once more ----

TEST_F(Bags, GiveAClientTheTerrainOfTheEnd) {
  const TerrainClient client(ros::NodeHandle(), patient_options());
  for (int turn = 0; turn < 2; ++turn) {
    Player player(long_);
    player.know_subscribers({"elevation", "elevation_updates"});
    ASSERT_TRUE(wait_until([] { return ros::Time::isValid(); })) << "the player tells the time";
    player.go_on();
    ASSERT_TRUE(wait_until([&] { return static_cast<int>(client.statistics().restarts) == turn; }));
    expect_at_the_end(client, long_);
    if (turn == 0) {
      EXPECT_LE(client.statistics().latency, player.seconds()) << "in the time of the recording";
      EXPECT_GE(client.statistics().latency, -long_.length);
    }
    EXPECT_EQ(player.end(), 0);
    EXPECT_TRUE(wait_until([&] { return !client.connected(); })) << "nobody is there any more";
  }
  EXPECT_EQ(client.statistics().refused, 0u);
}

/// Elevations as ElevationMap has them: grid_map counts columns and rows of cells from the north-east.
Cells south_west_first(const GridMap& map) {
  const std_msgs::Float32MultiArray& layer = map.data.at(0);
  const std::size_t height = layer.layout.dim.at(0).size, width = layer.layout.dim.at(1).size;
  Cells cells;
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width; ++x)
      cells.push_back(layer.data.at((height - 1 - y) * width + (width - 1 - x)));
  return cells;
}

TEST_F(Bags, GiveReadersOfOtherTopicsWhatTheyGaveLive) {
  Player player(long_);
  const Listener<GridMap> grid_maps("grid_map");
  const Listener<nav_msgs::OccupancyGrid> costmaps("costmap");
  const Listener<WindField> winds("wind");
  const Listener<SimulationStatus> statuses("status");
  player.know_subscribers({"grid_map", "costmap", "wind", "status"});
  player.go_on();
  ASSERT_TRUE(wait_until([&] { return statuses.last().step == long_.last_step; }));
  const SimulationStatus status = statuses.last();
  EXPECT_EQ(status.state, "paused");
  ASSERT_TRUE(wait_until([&] { return grid_maps.last().info.header.stamp == status.header.stamp; }));
  ASSERT_EQ(grid_maps.last().layers.at(0), "elevation");
  EXPECT_EQ(south_west_first(grid_maps.last()), live_.at(long_.last_step));
  EXPECT_TRUE(wait_until([&] { return winds.last().step == long_.last_step; }));
  EXPECT_EQ(costmaps.last().data.size(), live_.at(long_.last_step).size());
  EXPECT_TRUE(wait_until([&] { return ros::Time::now() >= status.header.stamp; }));
  EXPECT_LE((ros::Time::now() - status.header.stamp).toSec(), player.seconds())
      << "the clock is the recording's";
  EXPECT_EQ(player.end(), 0);
}

// ---- late ----

TEST_F(Bags, GiveAClientThatComesLateTheTerrainFromTheNextKeyframeOn) {
  Player player(long_, {"--keep-alive", "--pause-topics", marker});
  const Listener<SimulationStatus> statuses("status");
  player.know_subscribers({"status"});
  player.go_on();
  ASSERT_TRUE(wait_until([&] { return statuses.last().step == long_.marker_step; }));
  std::atomic<std::uint64_t> first{0};
  const TerrainClient late(ros::NodeHandle(), patient_options([&](const MapChange& change) {
                             if (first == 0) first = change.map->info().step;
                           }));
  player.know_subscribers({"elevation", "elevation_updates"});
  EXPECT_FALSE(late.map()) << "the player sends nothing anew to whoever comes";
  player.go_on();
  expect_at_the_end(late, long_);
  EXPECT_GE(first, long_.marker_step);
  EXPECT_LT(first, long_.last_step);
  EXPECT_EQ(player.end(), 0);
}

// ---- again and again, at twice the speed of the recording ----

void Bags::play_in_a_loop_and_expect(const Recording& recording) {
  std::atomic<int> turns{0}, compared{0}, wrong{0};
  const TerrainClient client(ros::NodeHandle(), options([&](const MapChange& change) {
                               const std::uint64_t step = change.map->info().step;
                               if (step == recording.last_step) ++turns;
                               const auto live = live_.find(step);
                               if (live == live_.end()) return;
                               ++compared;
                               wrong += change.map->elevations() != live->second;
                             }));
  Player player(recording, {"--loop", "--rate=2"});
  player.know_subscribers({"elevation", "elevation_updates"});
  player.go_on();
  ASSERT_TRUE(wait_until([&] { return turns >= 3 && client.statistics().restarts >= 2 && compared > 20; }))
      << turns << " turns, " << compared << " maps compared; " << told(client);
  EXPECT_EQ(wrong, 0) << "maps that were not the node's of that step";
  EXPECT_EQ(client.statistics().refused, 0u);
  player.end();
}

TEST_F(Bags, InALoopWithKeyframesOnTheWay) { play_in_a_loop_and_expect(long_); }

TEST_F(Bags, InALoopWithKeyframesAtItsBeginningOnly) { play_in_a_loop_and_expect(short_); }

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "bags");
  // This process follows the clock of what is played; the node and the recorder live in wall time.
  ros::param::set("/use_sim_time", true);
  ros::NodeHandle keep_alive;
  ros::param::set("/use_sim_time", false);
  ros::AsyncSpinner spinner(2);
  spinner.start();
  return RUN_ALL_TESTS();
}
