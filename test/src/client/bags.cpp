/// What rosbag has recorded of a node plays as the node did: for clients that follow its clock, that come
/// late, and that see it again and again.
///
/// The recording is of two parts: `short.bag` of one stretch of the run, whose keyframes are all at its
/// beginning, and `long.bag` of a second one, with more of them on the way.
#include <desert_sim/SimulationStatus.h>
#include <desert_sim/Step.h>
#include <desert_sim/WindField.h>
#include <nav_msgs/OccupancyGrid.h>
#include <std_msgs/Empty.h>
#include <std_srvs/Trigger.h>

#include <atomic>
#include <filesystem>

#include "src/client/terrain_client.hpp"
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

constexpr double timeout = 30;

const std::vector<std::string> topics{
    "elevation", "elevation_updates", "grid_map", "costmap", "costmap_updates", "wind", "status"};

/// Maps by step, of a client as they come.
class Maps {
 public:
  void add(const ElevationMap& map) {
    const std::lock_guard<std::mutex> lock(mutex_);
    maps_[map.info().step] = map.elevations();
  }
  /// Empty if there is none.
  Cells at(std::uint64_t step) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = maps_.find(step);
    return found == maps_.end() ? Cells() : found->second;
  }

 private:
  mutable std::mutex mutex_;
  std::map<std::uint64_t, Cells> maps_;
};

struct Recording {
  std::string bag;
  std::uint64_t last_step = 0;
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
  static std::vector<std::string> play(const Recording& recording,
                                       const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"rosrun", "rosbag", "play", "--quiet", "--clock", "--delay=1"};
    words.insert(words.end(), more.begin(), more.end());
    words.push_back(recording.bag);
    return words;
  }
  static void pause(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }
  static void record_both();
  static void record(NodeProcess& node, const TerrainClient& client, Recording& recording,
                     const std::string& name, int keyframes_on_the_way);

  static TerrainClient::Options options(std::function<void(const MapChange&)> on_change = {}) {
    TerrainClient::Options o;
    o.node = "/desert_sim";
    o.on_change = std::move(on_change);
    return o;
  }
  /// The client holds the terrain of the recording's end.
  static void expect_at_the_end(const TerrainClient& client, const Recording& recording) {
    ASSERT_TRUE(
        wait_until([&] { return client.map() && client.map()->info().step == recording.last_step; }, timeout))
        << "not at step " << recording.last_step << "; " << told(client);
    EXPECT_TRUE(client.up_to_date());
    EXPECT_EQ(client.map()->elevations(), live_.at(recording.last_step));
  }
  static void play_in_a_loop_and_expect(const Recording& recording);

  static inline Recording short_, long_;
  static inline Maps live_;  ///< of the node when it ran
};

/// From here until it is paused the node runs.
void Bags::record(NodeProcess& node, const TerrainClient& client, Recording& recording,
                  const std::string& name, int keyframes_on_the_way) {
  recording.bag = folder() + "/" + name;
  const std::uint64_t keyframes = client.statistics().keyframes;
  std::vector<std::string> words{"rosrun", "rosbag", "record", "--quiet", "-O", recording.bag};
  for (const std::string& topic : topics) words.push_back("/desert_sim/" + topic);
  ChildProcess recorder(words);
  ASSERT_TRUE(wait_until([&] { return client.statistics().keyframes > keyframes; }, timeout))
      << "the recorder is a new subscriber";
  pause(0.3);  // it has subscribed to the other topics too
  node.call<std_srvs::Trigger>("resume", {});
  ros::Publisher asks = ros::NodeHandle().advertise<std_msgs::Empty>("/desert_sim/request_keyframe", 1);
  for (int n = 0; n < keyframes_on_the_way; ++n) {
    pause(0.4);
    asks.publish(std_msgs::Empty());
  }
  pause(keyframes_on_the_way > 0 ? 0.4 : 1);
  node.call<std_srvs::Trigger>("pause", {});
  recording.last_step = node.call<Step>("step", {}).step;
  ASSERT_TRUE(client.wait_for_step(recording.last_step, timeout));
  live_.add(*client.map());
  pause(0.3);  // what was published last is on its way
  EXPECT_EQ(recorder.end(SIGINT), 0);
  ASSERT_TRUE(fs::exists(recording.bag));
}

void Bags::record_both() {
  fs::create_directories(folder());
  // Dunes, which move with every step.
  NodeProcess node("/desert_sim", {{"scenario", std::string("barchan")},
                                   {"grid/width", 96},
                                   {"grid/height", 64},
                                   {"step_rate", 20},
                                   {"update_rate", 20},
                                   {"update_threshold", 0.0},
                                   {"grid_map_rate", 5},
                                   {"costmap_update_rate", 5},
                                   {"status_rate", 10}});
  const TerrainClient client(ros::NodeHandle(), options([](const MapChange& c) { live_.add(*c.map); }));
  ASSERT_TRUE(client.wait_for_terrain(timeout));
  record(node, client, short_, "short.bag", 0);
  record(node, client, long_, "long.bag", 5);
  ASSERT_GT(short_.last_step, 5u);
  EXPECT_EQ(node.end(SIGINT), 0);
  ros::param::set("/use_sim_time", true);  // for the players too
}

// ---- played once, and once more ----

TEST_F(Bags, GiveAClientTheTerrainOfTheEnd) {
  const TerrainClient client(ros::NodeHandle(), options());
  for (int turn = 0; turn < 2; ++turn) {
    ChildProcess player(play(long_));
    ASSERT_TRUE(wait_until([&] { return static_cast<int>(client.statistics().restarts) == turn; }, timeout));
    expect_at_the_end(client, long_);
    EXPECT_EQ(player.wait(), 0);
    EXPECT_TRUE(wait_until([&] { return !client.connected(); })) << "nobody is there any more";
  }
  EXPECT_EQ(client.statistics().refused, 0u);
  EXPECT_LT(std::abs(client.statistics().latency), 10) << "in the time of the recording";
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
  ChildProcess player(play(long_));
  const Listener<GridMap> grid_maps("grid_map");
  const Listener<nav_msgs::OccupancyGrid> costmaps("costmap");
  const Listener<WindField> winds("wind");
  const Listener<SimulationStatus> statuses("status");
  ASSERT_TRUE(statuses.wait_for(
      [](const SimulationStatus& s) { return s.step == long_.last_step && s.state == "paused"; }, timeout));
  EXPECT_EQ(player.wait(), 0);
  ASSERT_EQ(grid_maps.last().layers.at(0), "elevation");
  EXPECT_EQ(south_west_first(grid_maps.last()), live_.at(long_.last_step));
  EXPECT_EQ(winds.last().step, long_.last_step);
  EXPECT_EQ(costmaps.last().data.size(), live_.at(long_.last_step).size());
  EXPECT_GE(ros::Time::now(), statuses.last().header.stamp) << "the clock is the recording's";
  EXPECT_LT(ros::Time::now() - statuses.last().header.stamp, ros::Duration(60));
}

// ---- late ----

TEST_F(Bags, GiveAClientThatComesLateTheTerrainFromTheNextKeyframeOn) {
  ChildProcess player(play(long_));
  const TerrainClient first(ros::NodeHandle(), options());
  ASSERT_TRUE(first.wait_for_step(short_.last_step + 5, timeout));
  // The player sends nothing anew to whoever comes, and does not take requests.
  const TerrainClient late(ros::NodeHandle(), options());
  const std::uint64_t begun = first.map()->info().step;
  EXPECT_LT(begun, long_.last_step);
  expect_at_the_end(late, long_);
  expect_at_the_end(first, long_);
  EXPECT_EQ(player.wait(), 0);
}

// ---- again and again, at twice the speed of the recording ----

void Bags::play_in_a_loop_and_expect(const Recording& recording) {
  std::atomic<int> turns{0}, compared{0}, wrong{0};
  const TerrainClient client(ros::NodeHandle(), options([&](const MapChange& change) {
                               const std::uint64_t step = change.map->info().step;
                               const Cells live = live_.at(step);
                               if (step == recording.last_step) ++turns;
                               if (live.empty()) return;
                               ++compared;
                               wrong += change.map->elevations() != live;
                             }));
  ChildProcess player(play(recording, {"--loop", "--rate=2"}));
  ASSERT_TRUE(wait_until([&] { return turns >= 3 && client.statistics().restarts >= 2; }, 60))
      << turns << " turns; " << told(client);
  EXPECT_GT(compared, 20);
  EXPECT_EQ(wrong, 0) << "maps that were not the node's of that step";
  EXPECT_EQ(client.statistics().refused, 0u);
  player.end(SIGINT);
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
