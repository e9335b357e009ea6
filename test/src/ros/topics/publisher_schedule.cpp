/// When topics are published, by a clock that the test moves. The server lives in this process, where a
/// subscriber can be called by the thread that publishes.
#include <desert_sim/EditTerrain.h>
#include <desert_sim/ElevationGrid.h>
#include <desert_sim/ElevationUpdate.h>
#include <desert_sim/LayerGrid.h>
#include <desert_sim/LayerUpdate.h>
#include <desert_sim/SetWind.h>
#include <desert_sim/WindField.h>
#include <map_msgs/OccupancyGridUpdate.h>
#include <nav_msgs/OccupancyGrid.h>
#include <ros/callback_queue_interface.h>
#include <sensor_msgs/Image.h>
#include <std_srvs/Trigger.h>

#include <algorithm>
#include <functional>
#include <map>

#include "src/ros/node/desert_sim_server.hpp"
#include "test/support/manual_clock.hpp"
#include "test/support/ros/service_tests.hpp"

namespace {

using namespace desert_sim;
using namespace node_test;

/// Calls what it is given at once, on the thread that publishes.
class ImmediateQueue : public ros::CallbackQueueInterface {
 public:
  void addCallback(const ros::CallbackInterfacePtr& callback, std::uint64_t) override { callback->call(); }
  void removeByID(std::uint64_t) override {}
};

/// A paused desert, which a command changes 20 times a second of the clock, with as many messages of ~image.
/// That is the last of the topics that are due at one time, so that the others have been published when it
/// comes.
class Schedule : public testing::Test {
 protected:
  static constexpr double period = 0.05;

  void start(const std::map<std::string, double>& rates) {
    XmlRpc::XmlRpcValue p;
    p["scenario"] = std::string(DESERT_SOURCE_DIR "/test/support/ros/scenarios/corner.yaml");
    p["backend"] = "cpu";
    p["threads"] = 1;
    p["paused"] = true;
    p["answer_timeout"] = 600.0;
    p["image_rate"] = 1 / period;
    p["refresh_rate"] = 0.0;
    p["costmap_update_rectangles"] = rectangles_;
    for (const auto& [name, rate] : rates) p[name] = rate;
    ros::param::set("/desert_sim", p);
    server_ = std::make_unique<DesertSimServer>(ros::NodeHandle("/desert_sim"), clock_);
    listen<sensor_msgs::Image>("image");
  }
  void TearDown() override {
    subscribers_.clear();
    server_.reset();
    ros::param::del("/desert_sim");
  }

  /// Subscribes, and waits for what a new subscriber is sent if that is this topic.
  template <class Message>
  void listen(const std::string& topic, bool sent_to_new_subscribers = true) {
    auto options = ros::SubscribeOptions::create<Message>(
        "/desert_sim/" + topic, 1000,
        [this, topic](const boost::shared_ptr<const Message>& m) {
          const std::lock_guard<std::mutex> lock(mutex_);
          published_[topic].push_back(clock_.seconds());
          note(*m);
        },
        ros::VoidConstPtr(), &at_once_);
    subscribers_.push_back(ros::NodeHandle().subscribe(options));
    if (!sent_to_new_subscribers) return;
    ASSERT_TRUE(wait_until([&] { return !times(topic).empty(); })) << topic;
  }
  /// When messages were published, by the clock [s].
  std::vector<double> times(const std::string& topic) {
    const std::lock_guard<std::mutex> lock(mutex_);
    return published_[topic];
  }
  /// How many of them since that time.
  int count_since(double time, const std::string& topic) {
    const std::vector<double> all = times(topic);
    return static_cast<int>(std::count_if(all.begin(), all.end(), [&](double t) { return t >= time; }));
  }

  /// Moves the clock by a period; then `change` changes something, which is shown when this returns.
  void tick(const std::function<void()>& change = set_same_wind) {
    clock_.advance(1.0001 * period);  // so that rounding does not put a due time behind it
    change();
    ASSERT_TRUE(wait_until([&] { return count_since(clock_.seconds(), "image") > 0; }));
  }
  /// After the first of them, which may be due a part of a period after the subscriber has joined, messages
  /// are so many ticks apart.
  void expect_ticks_apart(const std::string& topic, double since, int ticks) {
    std::vector<double> all = times(topic);
    all.erase(std::remove_if(all.begin(), all.end(), [&](double t) { return t < since; }), all.end());
    ASSERT_GE(all.size(), 4u) << topic;
    for (std::size_t n = 1; n < all.size(); ++n)
      EXPECT_NEAR(all[n] - all[n - 1], ticks * period, 0.1 * period) << topic << " " << n;
  }

  static void set_same_wind() {
    SetWind::Request r;
    r.use_vector = true;
    r.vector.x = 5;
    ASSERT_TRUE(call<SetWind>("set_wind", r).success);
  }
  /// Adds sand around a point, whose slopes nobody can drive on.
  static void heap(double x, double y) {
    EditTerrain::Request r;
    r.layer = "sand";
    r.shape = "circle";
    r.merge = "add";
    r.radius = 5;
    r.inner = 1;
    r.value = 3;
    r.center.x = x;
    r.center.y = y;
    ASSERT_TRUE(call<EditTerrain>("edit_terrain", r).success);
  }

  int rectangles_ = 1;  ///< costmap_update_rectangles
  desert_sim::test::ManualClock clock_;
  std::mutex mutex_;  ///< guards the next three
  std::map<std::string, std::vector<double>> published_;
  map_msgs::OccupancyGridUpdate last_rectangle_;
  nav_msgs::OccupancyGrid last_map_;

 private:
  template <class Message>
  void note(const Message&) {}
  void note(const map_msgs::OccupancyGridUpdate& m) { last_rectangle_ = m; }
  void note(const nav_msgs::OccupancyGrid& m) { last_map_ = m; }

  ImmediateQueue at_once_;
  std::unique_ptr<DesertSimServer> server_;
  std::vector<ros::Subscriber> subscribers_;
};

TEST_F(Schedule, EachTopicHasItsRate) {
  start({{"keyframe_rate", 1}, {"wind_rate", 5}});
  listen<ElevationGrid>("elevation");
  listen<WindField>("wind");
  tick();
  const double begin = clock_.seconds();
  for (int n = 0; n < 100; ++n) tick();
  expect_ticks_apart("elevation", begin, 20);
  expect_ticks_apart("wind", begin, 4);
}

TEST_F(Schedule, NothingIsPublishedAgainThatHasNotChanged) {
  start({{"keyframe_rate", 0}, {"wind_rate", 5}});
  listen<WindField>("wind");
  for (int n = 0; n < 8; ++n) tick();
  // ~wind may not have shown the last changes yet, and does now; another ten seconds change nothing.
  clock_.advance(10);
  tick();
  const double begin = clock_.seconds();
  clock_.advance(10);
  tick();
  EXPECT_EQ(count_since(begin + period, "wind"), 1);
}

TEST_F(Schedule, WholesAreShownAgainThoughNothingHasChanged) {
  start({{"refresh_rate", 0.05}, {"keyframe_rate", 0}, {"layer_keyframe_rate", 0}, {"wind_rate", 0}});
  listen<ElevationGrid>("elevation");
  listen<ElevationUpdate>("elevation_updates", false);
  listen<LayerGrid>("layers/sand_depth");
  listen<LayerUpdate>("layers/sand_depth_updates", false);
  listen<WindField>("wind");
  for (int n = 0; n < 3; ++n) {
    const double begin = clock_.seconds();
    clock_.advance(20.1);
    for (const char* topic : {"elevation", "layers/sand_depth", "wind"}) {
      EXPECT_TRUE(wait_until([&] { return count_since(begin + 20, topic) > 0; })) << topic;
      EXPECT_EQ(count_since(begin + period, topic), 1) << topic;
    }
    for (const char* topic : {"elevation_updates", "layers/sand_depth_updates"})
      EXPECT_EQ(count_since(begin + period, topic), 0) << "there is nothing new";
  }
}

// ---- ~costmap_updates: one rectangle in 0.2 s, which repeats what was sent less than 0.3 s before

class CostmapSchedule : public Schedule {
 protected:
  void SetUp() override {
    start({{"costmap_update_rate", 5},
           {"costmap_keyframe_rate", 0},
           {"costmap_update_threshold", 0},
           {"costmap_update_spacing", 0.2}});
    listen<nav_msgs::OccupancyGrid>("costmap");
    listen<map_msgs::OccupancyGridUpdate>("costmap_updates", false);
    for (int n = 0; n < 11; ++n) tick();  // so that the whole map was sent long ago
  }
  /// Makes a heap, and ticks until the rectangle that shows it.
  map_msgs::OccupancyGridUpdate rectangle_of_heap(double x, double y) {
    const double begin = clock_.seconds() + 0.5 * period;
    tick([&] { heap(x, y); });
    for (int n = 0; n < 5 && count_since(begin, "costmap_updates") == 0; ++n) tick();
    const std::lock_guard<std::mutex> lock(mutex_);
    EXPECT_TRUE(contains(last_rectangle_, x, y));
    return last_rectangle_;
  }
  static bool contains(const map_msgs::OccupancyGridUpdate& u, double x, double y) {
    const int column = static_cast<int>((x - 10) / 2), row = static_cast<int>((y + 20) / 2);
    return u.x <= column && column < u.x + static_cast<int>(u.width) && u.y <= row &&
           row < u.y + static_cast<int>(u.height);
  }
};

TEST_F(CostmapSchedule, UpdatesAreAPeriodApartAndNoKeyframeIsBetween) {
  const double begin = clock_.seconds() + 0.5 * period;
  for (int n = 0; n < 40; ++n) tick([n] { heap(20 + 2.5 * n, 10); });
  expect_ticks_apart("costmap_updates", begin, 4);
  EXPECT_EQ(count_since(begin, "costmap"), 0);
}

TEST_F(CostmapSchedule, AnUpdateRepeatsWhatAClientMayNotHaveLookedAt) {
  rectangle_of_heap(30, 0);
  const auto second = rectangle_of_heap(70, 20);  // 0.2 s later
  EXPECT_TRUE(contains(second, 30, 0)) << "the cells of the first, again";
  const auto third = rectangle_of_heap(110, 50);
  EXPECT_TRUE(contains(third, 70, 20)) << "the cells of the second, again";
  EXPECT_FALSE(contains(third, 30, 0)) << "0.4 s later nobody needs the first";
}

TEST_F(CostmapSchedule, SoonAfterTheTerrainWasReplacedChangesComeAsWholeMaps) {
  const double begin = clock_.seconds() + 0.5 * period;
  tick([] { ASSERT_TRUE(call<std_srvs::Trigger>("reset").success); });
  const double replaced = clock_.seconds() + 0.5 * period;
  EXPECT_EQ(count_since(begin, "costmap"), 1);
  tick([] { heap(40, 10); });
  for (int n = 0; n < 4; ++n) tick();
  EXPECT_EQ(count_since(replaced, "costmap"), 1) << "the heap comes with a whole map";
  EXPECT_EQ(count_since(begin, "costmap_updates"), 0);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    EXPECT_EQ(*std::max_element(last_map_.data.begin() + 15 * 64, last_map_.data.begin() + 15 * 64 + 20),
              100);
  }
  for (int n = 0; n < 5; ++n) tick();
  rectangle_of_heap(90, 10);
  EXPECT_EQ(count_since(replaced, "costmap"), 1);
}

// ---- with several rectangles: those that are far apart follow one another, a spacing apart

class RectanglesInTurn : public CostmapSchedule {
 protected:
  void SetUp() override {
    rectangles_ = 4;
    CostmapSchedule::SetUp();
  }
};

TEST_F(RectanglesInTurn, AreOneForEachEditAndASpacingApart) {
  const double begin = clock_.seconds() + 0.5 * period;
  std::vector<map_msgs::OccupancyGridUpdate> sent;
  for (int n = 0; n < 16; ++n) {
    tick([n] {
      if (n > 0) return set_same_wind();
      heap(25, -5);
      heap(125, 65);
    });
    const std::lock_guard<std::mutex> lock(mutex_);
    if (published_["costmap_updates"].size() > sent.size()) sent.push_back(last_rectangle_);
  }
  ASSERT_EQ(sent.size(), 2u);
  EXPECT_NE(contains(sent[0], 25, -5), contains(sent[0], 125, 65));
  EXPECT_EQ(contains(sent[1], 25, -5), contains(sent[0], 125, 65)) << "the other one, and that alone";
  EXPECT_EQ(contains(sent[1], 125, 65), contains(sent[0], 25, -5));
  const std::vector<double> all = times("costmap_updates");
  EXPECT_GE(all[0], begin);
  EXPECT_NEAR(all[1] - all[0], 0.2, 0.1 * period);
}

}  // namespace

int main(int argc, char** argv) { return node_test::run_tests(argc, argv, "publisher_schedule"); }
