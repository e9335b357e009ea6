/// ~layers/<name> of a node that runs, and what TerrainClient makes of them.
#include <desert_sim/EditTerrain.h>
#include <desert_sim/GetSubmap.h>
#include <desert_sim/LayerGrid.h>
#include <desert_sim/LayerUpdate.h>
#include <desert_sim/LoadScenario.h>
#include <desert_sim/SetWind.h>
#include <desert_sim/SimulationStatus.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/String.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "include/desert_sim/client/terrain_client.hpp"
#include "src/core/error.hpp"
#include "src/ros/node/desert_sim_server.hpp"
#include "src/terrain/map_layers.hpp"
#include "test/support/manual_clock.hpp"
#include "test/support/ros/service_tests.hpp"

namespace {

using namespace desert_sim;
using node_test::call;
using node_test::Listener;
using node_test::step;
using node_test::wait_until;

const double timeout = 60 * node_test::patience();

/// What ~layer_thresholds and ~update_threshold say in layers.test.
double threshold_of(const std::string& layer) {
  if (layer == "wind_x") return 0.02;
  return find_map_layer(layer)->threshold;
}

/// The node's own answer, of all cells.
std::vector<float> ask(const std::string& layer, const MapInfo& info) {
  GetSubmap::Request request;
  request.length_x = info.width * info.cell_size;
  request.length_y = info.height * info.cell_size;
  request.center.x = info.origin_x + request.length_x / 2;
  request.center.y = info.origin_y + request.length_y / 2;
  request.layers = {layer};
  const GetSubmap::Response response = call<GetSubmap>("get_submap", request);
  EXPECT_TRUE(response.success) << response.message;
  return response.success ? response.map.layers[0].data : std::vector<float>();
}

double largest_difference(const std::vector<float>& a, const std::vector<float>& b) {
  EXPECT_EQ(a.size(), b.size());
  double largest = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    largest = std::max(largest, std::abs(static_cast<double>(a[i]) - static_cast<double>(b[i])));
  return largest;
}

void expect_as_asked(const TerrainClient& client, const std::string& layer) {
  const std::shared_ptr<const LayerMap> map = client.layer_map(layer);
  ASSERT_TRUE(map) << layer;
  EXPECT_EQ(map->info().layer, layer);
  EXPECT_LE(largest_difference(map->values(), ask(layer, map->info())), threshold_of(layer) + 1e-6) << layer;
}

/// Steps until changes of all layers of the client come as updates alone: the node sends keyframes until it
/// has noticed that somebody takes updates.
void step_until_updated(const TerrainClient& client) {
  const auto numbers = [&] {
    EXPECT_TRUE(client.wait_for_step(step(1).step, timeout));
    std::vector<std::uint32_t> keyframes;
    for (const std::string& layer : client.layers())
      keyframes.push_back(client.layer_map(layer)->info().keyframe);
    return keyframes;
  };
  std::vector<std::uint32_t> last = numbers();
  ASSERT_TRUE(wait_until([&] {
    const std::vector<std::uint32_t> now = numbers();
    if (now != std::exchange(last, now)) return false;
    for (const std::string& layer : client.layers())
      if (client.statistics(layer).updates == 0) return false;
    return true;
  }));
}

/// Raises sand on a disc of 3 m around (40, 20) [m].
void add_sand(double height) {
  EditTerrain::Request brush;
  brush.layer = "sand";
  brush.shape = "circle";
  brush.merge = "add";
  brush.radius = 3;
  brush.value = height;
  brush.center.x = 40;
  brush.center.y = 20;
  const EditTerrain::Response answer = call<EditTerrain>("edit_terrain", brush);
  ASSERT_TRUE(answer.success) << answer.message;
}

void load(const std::string& scenario) {
  LoadScenario::Request request;
  request.name = scenario;
  const LoadScenario::Response answer = call<LoadScenario>("load_scenario", request);
  ASSERT_TRUE(answer.success) << answer.message;
}

class Layers : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(call<std_srvs::Trigger>("pause").success);
    load("corner.yaml");
  }
  /// A client that asks once after a gap, and otherwise has patience.
  static TerrainClient::Options with(const std::vector<std::string>& layers) {
    TerrainClient::Options options;
    options.node = "/desert_sim";
    options.layers = layers;
    options.shortest_pause = options.longest_pause = 3600;
    return options;
  }
  const ros::NodeHandle node_;
};

// ---- what a client holds ----

TEST_F(Layers, AllStayWithinTheirThresholdsOverManyUpdates) {
  const TerrainClient client(node_, with(TerrainClient::known_layers()));
  ASSERT_TRUE(client.wait_for_terrain(timeout));
  ASSERT_EQ(client.layers().size(), map_layers.size());
  // Before the steps that it takes until updates come, in which the marker of sand may come to rest.
  std::map<std::string, std::vector<float>> start;
  for (const std::string& layer : client.layers()) start[layer] = client.layer_map(layer)->values();
  step_until_updated(client);
  for (int round = 0; round < 20; ++round) {
    if (round % 5 == 4) add_sand(round % 2 ? 0.3 : 4);
    ASSERT_TRUE(client.wait_for_step(step(4).step, timeout)) << round;
  }
  EXPECT_TRUE(client.up_to_date());
  for (const std::string& layer : client.layers()) {
    SCOPED_TRACE(layer);
    expect_as_asked(client, layer);
    EXPECT_STREQ(client.layer_map(layer)->info().unit.c_str(), info(find_map_layer(layer)->layer).unit);
    const TerrainClient::Statistics counts = client.statistics(layer);
    EXPECT_GT(counts.updates + counts.late, 20u)
        << "the keyframe of a late subscription may overtake an update";
    EXPECT_EQ(counts.gaps + counts.refused + counts.restarts, 0u) << counts.last_gap << counts.last_refusal;
  }
  for (const char* layer : {"sand_depth", "water_surface", "wind_x", "wind_shadow", "slope", "roughness",
                            "step_height", "traversability", "normal_x", "normal_z"})
    EXPECT_GT(largest_difference(client.layer_map(layer)->values(), start[layer]), 2 * threshold_of(layer))
        << layer << " has changed meanwhile";
  for (const char* layer : {"water_depth", "soil_depth", "plants", "vegetation", "moisture"})
    EXPECT_EQ(largest_difference(client.layer_map(layer)->values(), std::vector<float>(64 * 48)), 0)
        << "the terrain has no " << layer;
}

TEST_F(Layers, AZeroOfTraversabilityIsExact) {
  const TerrainClient client(node_, with({"traversability"}));
  ASSERT_TRUE(client.wait_for_terrain(timeout));
  EXPECT_FALSE(client.map()) << "the elevation was not subscribed to";
  add_sand(5);
  ASSERT_TRUE(client.wait_for_step(step(3).step, timeout));
  const std::shared_ptr<const LayerMap> map = client.layer_map("traversability");
  const std::vector<float> held = map->values(), now = ask("traversability", map->info());
  const MapInfo& info = map->info();
  std::size_t closed = 0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (now[i] != 0) continue;
    ++closed;
    ASSERT_EQ(held[i], 0) << i;
    const std::size_t x = i % info.width, y = i / info.width;
    ASSERT_EQ(map->cell_value(info.origin_x + (static_cast<double>(x) + 0.3) * info.cell_size,
                              info.origin_y + (static_cast<double>(y) + 0.7) * info.cell_size),
              0);
  }
  EXPECT_GT(closed, 10u);
  EXPECT_GT(client.value("traversability", 80, 50).value(), 0.5);
}

TEST_F(Layers, FollowAResetAndALoadOfAnotherSize) {
  const TerrainClient client(node_, with({"elevation", "sand_depth", "slope"}));
  ASSERT_TRUE(client.wait_for_terrain(timeout));
  ASSERT_TRUE(client.wait_for_step(step(10).step, timeout));
  ASSERT_TRUE(call<std_srvs::Trigger>("reset").success);
  const auto all_are = [&](std::uint32_t width) {
    for (const std::string& layer : client.layers()) {
      const MapInfo& info = client.layer_map(layer)->info();
      if (info.step != 0 || info.width != width || info.sequence != 0) return false;
    }
    return true;
  };
  ASSERT_TRUE(wait_until([&] { return all_are(64); })) << "keyframes alone";
  for (const std::string& layer : client.layers()) expect_as_asked(client, layer);
  load("other.yaml");
  ASSERT_TRUE(wait_until([&] { return all_are(40); }));
  ASSERT_TRUE(client.wait_for_step(step(2).step, timeout));
  for (const std::string& layer : client.layers()) {
    expect_as_asked(client, layer);
    EXPECT_EQ(client.statistics(layer).gaps + client.statistics(layer).refused, 0u) << layer;
  }
}

TEST_F(Layers, ALossIsNoticedAndHealed) {
  const TerrainClient client(node_, with({"sand_depth", "wind_x"}));
  ASSERT_TRUE(client.wait_for_terrain(timeout));
  step_until_updated(client);
  ros::NodeHandle node;
  ros::Publisher wrong = node.advertise<LayerUpdate>("/desert_sim/layers/sand_depth_updates", 1);
  ASSERT_TRUE(wait_until([&] { return wrong.getNumSubscribers() > 0; }));
  LayerUpdate late;  // as if those before it had been lost
  const MapInfo before = client.layer_map("sand_depth")->info();
  late.header.frame_id = before.frame;
  late.header.stamp = ros::Time::now();
  late.layer = "sand_depth";
  late.step = before.step;
  late.keyframe = before.keyframe;
  late.sequence = before.sequence + 7;
  wrong.publish(late);
  ASSERT_TRUE(wait_until([&] { return client.statistics("sand_depth").gaps == 1; }));
  ASSERT_TRUE(wait_until([&] { return client.up_to_date("sand_depth"); }));
  EXPECT_GT(client.layer_map("sand_depth")->info().keyframe, before.keyframe);
  EXPECT_EQ(client.statistics("sand_depth").requests, 1u);
  EXPECT_EQ(client.statistics("wind_x").gaps, 0u) << "another layer";
  wrong.shutdown();
  ASSERT_TRUE(client.wait_for_step(step(5).step, timeout));
  expect_as_asked(client, "sand_depth");
  expect_as_asked(client, "wind_x");
}

// roscpp gives both one connection, so that the node does not see that the second has come: it has to ask,
// unless a keyframe for the first comes just then (the node learns late that it listens to updates, too).
TEST_F(Layers, TwoClientsInOneProcessBothHaveThem) {
  const TerrainClient first(node_, with({"sand_depth", "traversability"}));
  ASSERT_TRUE(first.wait_for_terrain(timeout));
  ASSERT_TRUE(first.wait_for_step(step(6).step, timeout));
  TerrainClient::Options options = with({"traversability"});
  options.shortest_pause = options.longest_pause = 0.05;
  const TerrainClient second(node_, options);
  ASSERT_TRUE(second.wait_for_terrain(timeout));
  ASSERT_TRUE(first.wait_for_step(step(5).step, timeout) && second.wait_for_step(11, timeout));
  for (const TerrainClient* client : {&first, &second})
    for (const std::string& layer : client->layers()) expect_as_asked(*client, layer);
}

// ---- subscribing at run time ----

TEST_F(Layers, ComeAndGoWhileTheClientRuns) {
  TerrainClient client(node_, with({"elevation"}));
  ASSERT_TRUE(client.wait_for_terrain(timeout));
  EXPECT_FALSE(client.layer_map("slope"));
  EXPECT_FALSE(client.up_to_date("slope"));
  std::thread other([&] { client.subscribe_layer("slope"); });
  client.subscribe_layer("slope");
  other.join();
  EXPECT_EQ(client.layers(), (std::vector<std::string>{"elevation", "slope"}));
  ASSERT_TRUE(client.wait_for_terrain(timeout));
  const std::shared_ptr<const LayerMap> kept = client.layer_map("slope");
  const std::vector<float> values = kept->values();
  ASSERT_TRUE(client.wait_for_step(step(5).step, timeout));
  expect_as_asked(client, "slope");
  client.unsubscribe_layer("slope");
  client.unsubscribe_layer("slope");
  EXPECT_FALSE(client.layer_map("slope"));
  EXPECT_EQ(kept->values(), values);
  client.subscribe_layer("slope");
  ASSERT_TRUE(client.wait_for_terrain(timeout));
  expect_as_asked(client, "slope");
  EXPECT_EQ(client.statistics().gaps, 0u) << "the elevation went on";
}

TEST_F(Layers, CallbacksMaySubscribeAndUnsubscribe) {
  std::mutex mutex;
  std::vector<std::string> seen;
  TerrainClient* told = nullptr;
  TerrainClient::Options options = with({"elevation"});
  options.on_change = [&](const MapChange& change) {
    const std::lock_guard<std::mutex> lock(mutex);
    const std::string layer = change.map->info().layer;
    EXPECT_FALSE(change.cells.empty());
    if (std::find(seen.begin(), seen.end(), layer) != seen.end() || !told) return;
    seen.push_back(layer);
    if (layer == "elevation") told->subscribe_layer("sand_depth");
    if (layer == "sand_depth") told->unsubscribe_layer("sand_depth");
  };
  TerrainClient client(node_, options);
  {
    const std::lock_guard<std::mutex> lock(mutex);
    told = &client;
  }
  ASSERT_TRUE(client.wait_for_terrain(timeout));
  ASSERT_TRUE(wait_until([&] {
    add_sand(0.1);
    step(0);
    const std::lock_guard<std::mutex> lock(mutex);
    return seen.size() == 2;
  }));
  EXPECT_TRUE(wait_until([&] { return client.layers() == std::vector<std::string>{"elevation"}; }));
  ASSERT_TRUE(client.wait_for_step(step(2).step, timeout));
}

TEST_F(Layers, AnUnknownOneIsRefusedWithThoseThatAre) {
  const auto refused = [](const std::function<void()>& call) {
    try {
      call();
      FAIL() << "it was taken";
    } catch (const ConfigError& e) {
      EXPECT_NE(std::string(e.what()).find("'lava' is not one of: elevation, bedrock, "), std::string::npos)
          << e.what();
    }
  };
  refused([&] { const TerrainClient client(node_, with({"elevation", "lava"})); });
  TerrainClient client(node_, with({}));
  refused([&] { client.subscribe_layer("lava"); });
  refused([&] { client.unsubscribe_layer("lava"); });
  refused([&] { client.layer_map("lava"); });
  refused([&] { client.value("lava", 0, 0); });
  EXPECT_TRUE(client.layers().empty());
}

// ---- what is sent ----

TEST_F(Layers, ASmallEditIsASmallMessage) {
  const Listener<LayerGrid> keyframes("layers/sand_depth");
  const Listener<LayerUpdate> updates("layers/sand_depth_updates");
  const LayerGrid whole = keyframes.last();
  EXPECT_EQ(whole.layer, "sand_depth");
  EXPECT_EQ(whole.unit, "m");
  EXPECT_GT(ros::serialization::serializationLength(whole), 4u * 64 * 48);
  ASSERT_TRUE(wait_until([&] {
    step(1);
    return updates.count() > 0;
  })) << "the node knows both";
  const std::uint64_t last = step(1).step;
  ASSERT_TRUE(updates.wait_for([&](const LayerUpdate& u) { return u.step == last; }));
  const std::size_t first = updates.count();
  add_sand(0.05);
  step(0);
  ASSERT_TRUE(updates.wait_for_count(first + 1));
  const LayerUpdate update = updates.all().at(first);
  EXPECT_EQ(update.step, last);
  EXPECT_FALSE(update.tiles.empty());
  EXPECT_LT(ros::serialization::serializationLength(update), 400u) << "9 cells";
}

TEST_F(Layers, AKeyframeIsSentToWhoNamesTheLayer) {
  const Listener<LayerGrid> sand("layers/sand_depth"), wind("layers/wind_x");
  // Without subscribers to updates, each step sends a keyframe. Those are numbered.
  const auto keyframe_of_step = [](const Listener<LayerGrid>& keyframes, std::uint64_t step) {
    EXPECT_TRUE(wait_until([&] { return keyframes.last().step == step; })) << step;
    return keyframes.last().keyframe;
  };
  ASSERT_TRUE(wait_until([&] {
    const std::uint64_t before = std::max(sand.last().step, wind.last().step);
    step(1);
    return sand.last().step > before && wind.last().step > before;
  })) << "the node knows that nobody listens to updates any more";
  ros::NodeHandle node;
  ros::Publisher asks = node.advertise<std_msgs::String>("/desert_sim/layers/request_keyframe", 10);
  ASSERT_TRUE(wait_until([&] { return asks.getNumSubscribers() > 0; }));
  const std::uint64_t reached = step(1).step;
  const std::uint32_t sands = keyframe_of_step(sand, reached), winds = keyframe_of_step(wind, reached);
  std_msgs::String name;
  name.data = "lava";
  asks.publish(name);
  name.data = "sand_depth";
  asks.publish(name);
  EXPECT_TRUE(wait_until([&] { return sand.last().keyframe == sands + 1; }));
  const std::uint64_t later = step(1).step;
  EXPECT_EQ(keyframe_of_step(wind, later), winds + 1) << "only that of the step";
  EXPECT_EQ(keyframe_of_step(sand, later), sands + 2) << "that which was asked for, and that of the step";
}

/// Copies of the terrain until now, as the status after another step has it.
std::uint64_t copies_after_a_step(const Listener<SimulationStatus>& statuses) {
  const std::uint64_t reached = step(1).step;
  EXPECT_TRUE(wait_until([&] { return statuses.last().step == reached; })) << reached;
  return statuses.last().snapshots;
}
std::uint64_t copied_for_a_step(const Listener<SimulationStatus>& statuses) {
  const std::uint64_t before = copies_after_a_step(statuses);
  return copies_after_a_step(statuses) - before;
}

TEST_F(Layers, WithoutSubscribersNothingIsCopied) {
  const Listener<SimulationStatus> statuses("status");
  EXPECT_TRUE(wait_until([&] { return copied_for_a_step(statuses) == 0; }));
  const std::uint64_t before = copies_after_a_step(statuses);
  EXPECT_TRUE(call<std_srvs::Trigger>("resume").success);
  const std::uint64_t begun = step(0).step;
  EXPECT_TRUE(wait_until([&] { return step(0).step > begun + 20; }));
  EXPECT_TRUE(call<std_srvs::Trigger>("pause").success);
  EXPECT_EQ(copies_after_a_step(statuses), before) << "while it ran";
  std::uint32_t keyframe = 0;
  {
    const Listener<LayerUpdate> updates("layers/slope_updates");
    EXPECT_TRUE(wait_until([&] {
      step(1);
      return updates.count() >= 3;
    })) << "updates flow without a subscriber to keyframes";
    EXPECT_GT(copied_for_a_step(statuses), 0u);
    keyframe = updates.last().keyframe;
    EXPECT_EQ(updates.all().front().keyframe, keyframe);
  }
  // The node forgets what subscribers held when it looks after topics and finds none; if somebody has come
  // before that, it goes on with the keyframe.
  EXPECT_TRUE(wait_until([&] {
    EXPECT_TRUE(wait_until([&] { return copied_for_a_step(statuses) == 0; }));
    const Listener<LayerUpdate> anew("layers/slope_updates");
    EXPECT_TRUE(wait_until([&] {
      step(1);
      return anew.count() > 0;
    }));
    EXPECT_LE(anew.last().keyframe, keyframe + 1);
    return anew.last().keyframe == keyframe + 1;
  })) << "what subscribers held is forgotten";
}

// ---- how often: by a clock that the test moves, in a node of this process ----

class LayerSchedule : public testing::Test {
 protected:
  static constexpr double period = 0.05;
  static constexpr const char* name = "/scheduled";

  void SetUp() override {
    XmlRpc::XmlRpcValue p;
    p["scenario"] = std::string(DESERT_SOURCE_DIR "/test/support/ros/scenarios/corner.yaml");
    p["backend"] = "cpu";
    p["threads"] = 1;
    p["paused"] = true;
    p["answer_timeout"] = 600.0;
    p["center_frame"] = "";
    p["image_rate"] = 1 / period;
    p["layer_keyframe_rate"] = 0.25 / period;
    p["layer_update_rate"] = 1 / period;
    ros::param::set(name, p);
    server_ = std::make_unique<DesertSimServer>(ros::NodeHandle(name), clock_);
    images_ = std::make_unique<Listener<sensor_msgs::Image>>(std::string(name) + "/image");
    images_->last();
    asks_ = ros::NodeHandle().advertise<std_msgs::String>(std::string(name) + "/layers/request_keyframe", 1);
    ASSERT_TRUE(wait_until([&] { return asks_.getNumSubscribers() > 0; }));
  }
  void TearDown() override {
    asks_.shutdown();
    images_.reset();
    server_.reset();
    ros::param::del(name);
  }
  /// Time goes on by a period, and something changes. ~image is the last of the topics that are due at one
  /// time: when it comes, the others have been published.
  void tick() {
    const std::size_t before = images_->count();
    clock_.advance(1.0001 * period);  // so that rounding does not put a due time behind it
    SetWind wind;
    wind.request.speed = 5;
    ASSERT_TRUE(call_service(std::string(name) + "/set_wind", wind) && wind.response.success);
    ASSERT_TRUE(images_->wait_for_count(before + 1));
  }
  /// The number of a keyframe that is asked for now.
  std::uint32_t next_keyframe(const Listener<LayerGrid>& keyframes) {
    const std::size_t before = keyframes.count();
    std_msgs::String layer;
    layer.data = "sand_depth";
    asks_.publish(layer);
    EXPECT_TRUE(keyframes.wait_for_count(before + 1));
    return keyframes.last().keyframe;
  }

  desert_sim::test::ManualClock clock_;
  std::unique_ptr<DesertSimServer> server_;
  std::unique_ptr<Listener<sensor_msgs::Image>> images_;
  ros::Publisher asks_;
};

TEST_F(LayerSchedule, KeyframesAloneComeAtTheirRate) {
  const Listener<LayerGrid> keyframes(std::string(name) + "/layers/sand_depth");
  const std::uint32_t begin = keyframes.last().keyframe;
  for (int n = 0; n < 40; ++n) tick();
  EXPECT_NEAR(next_keyframe(keyframes) - begin, 1 + 10, 1);
}

TEST_F(LayerSchedule, NoKeyframeComesAtItsRateForANodeThatTakesUpdates) {
  const Listener<LayerGrid> keyframes(std::string(name) + "/layers/sand_depth");
  const Listener<LayerUpdate> updates(std::string(name) + "/layers/sand_depth_updates");
  keyframes.last();
  ASSERT_TRUE(wait_until([&] {
    for (int n = 0; n < 5; ++n) tick();
    return updates.count() > 0;
  })) << "the node knows both";
  for (int n = 0; n < 5; ++n) tick();
  const std::uint32_t begin = next_keyframe(keyframes);
  for (int n = 0; n < 40; ++n) tick();
  EXPECT_EQ(next_keyframe(keyframes) - begin, 1u);
}

}  // namespace

int main(int argc, char** argv) { return node_test::run_tests(argc, argv, "layers"); }
