/// ~layers/<name> of a node that runs, and what TerrainClient makes of them.
#include <desert_sim/EditTerrain.h>
#include <desert_sim/GetSubmap.h>
#include <desert_sim/LayerGrid.h>
#include <desert_sim/LayerUpdate.h>
#include <desert_sim/LoadScenario.h>
#include <desert_sim/SimulationStatus.h>
#include <std_msgs/String.h>

#include <cmath>

#include "src/client/terrain_client.hpp"
#include "src/core/error.hpp"
#include "src/terrain/map_layers.hpp"
#include "test/support/ros/service_tests.hpp"

namespace {

using namespace desert_sim;
using node_test::call;
using node_test::Listener;
using node_test::step;
using node_test::wait_until;

constexpr double timeout = 10;

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

/// Steps until updates of all layers of the client come: the node sends keyframes alone at first, at their
/// rate, until it has noticed that somebody takes updates.
void step_until_updated(const TerrainClient& client) {
  ASSERT_TRUE(wait_until([&] {
    EXPECT_TRUE(client.wait_for_step(step(1).step, timeout));
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
  static TerrainClient::Options with(const std::vector<std::string>& layers) {
    TerrainClient::Options options;
    options.node = "/desert_sim";
    options.layers = layers;
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
    EXPECT_GT(counts.updates, 20u);
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
  EXPECT_GE(client.statistics("sand_depth").requests, 1u);
  EXPECT_EQ(client.statistics("wind_x").gaps, 0u) << "another layer";
  wrong.shutdown();
  ASSERT_TRUE(client.wait_for_step(step(5).step, timeout));
  expect_as_asked(client, "sand_depth");
  expect_as_asked(client, "wind_x");
}

// roscpp gives both one connection, so that the node does not see that the second has come.
TEST_F(Layers, TwoClientsInOneProcessBothHaveThem) {
  const TerrainClient first(node_, with({"sand_depth", "traversability"}));
  ASSERT_TRUE(first.wait_for_terrain(timeout));
  ASSERT_TRUE(first.wait_for_step(step(6).step, timeout));
  const TerrainClient second(node_, with({"traversability"}));
  ASSERT_TRUE(second.wait_for_terrain(timeout));
  EXPECT_LE(second.statistics("traversability").requests, 2u);
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
  add_sand(1);
  ASSERT_TRUE(wait_until([&] {
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
  step(0);
  const std::size_t first = updates.count(), known = keyframes.count();
  add_sand(0.05);
  ASSERT_TRUE(wait_until([&] {
    for (std::size_t n = first; n < updates.count(); ++n)
      if (!updates.all()[n].tiles.empty()) return true;
    return false;
  }));
  std::size_t bytes = 0;
  for (std::size_t n = first; n < updates.count(); ++n)
    bytes += ros::serialization::serializationLength(updates.all()[n]);
  EXPECT_LT(bytes, 400u) << "9 cells";
  EXPECT_GT(ros::serialization::serializationLength(whole), 4u * 64 * 48);
  for (int n = 0; n < 5; ++n) step(1);
  ros::Duration(1.5).sleep();
  EXPECT_EQ(keyframes.count(), known) << "no keyframe at its rate for a node that takes updates";
}

TEST_F(Layers, KeyframesAloneComeAtTheirRate) {
  const Listener<LayerGrid> keyframes("layers/sand_depth");
  keyframes.last();
  const std::size_t known = keyframes.count();
  EXPECT_TRUE(call<std_srvs::Trigger>("resume").success);
  EXPECT_TRUE(keyframes.wait_for_count(known + 3));
  EXPECT_TRUE(call<std_srvs::Trigger>("pause").success);
}

TEST_F(Layers, AKeyframeIsSentToWhoNamesTheLayer) {
  const Listener<LayerGrid> sand("layers/sand_depth"), wind("layers/wind_x");
  sand.last();
  wind.last();
  step(0);
  ros::NodeHandle node;
  ros::Publisher asks = node.advertise<std_msgs::String>("/desert_sim/layers/request_keyframe", 10);
  ASSERT_TRUE(wait_until([&] { return asks.getNumSubscribers() > 0; }));
  const std::size_t sands = sand.count(), winds = wind.count();
  std_msgs::String name;
  name.data = "lava";
  asks.publish(name);
  name.data = "sand_depth";
  asks.publish(name);
  EXPECT_TRUE(sand.wait_for_count(sands + 1));
  EXPECT_EQ(wind.count(), winds);
}

/// Copies of the terrain between two statuses, several later.
std::uint64_t copied(const Listener<SimulationStatus>& statuses) {
  const std::size_t n = statuses.count();
  EXPECT_TRUE(statuses.wait_for_count(n + 1));
  const std::uint64_t before = statuses.last().snapshots;
  EXPECT_TRUE(statuses.wait_for_count(n + 6));
  return statuses.last().snapshots - before;
}

TEST_F(Layers, WithoutSubscribersNothingIsCopied) {
  const Listener<SimulationStatus> statuses("status");
  EXPECT_TRUE(call<std_srvs::Trigger>("resume").success);
  EXPECT_TRUE(wait_until([&] { return copied(statuses) == 0; }));
  const std::uint64_t before = statuses.last().step;
  EXPECT_EQ(copied(statuses), 0u);
  EXPECT_GT(statuses.last().step, before) << "it runs meanwhile";
  std::uint32_t keyframe = 0;
  {
    const Listener<LayerUpdate> updates("layers/slope_updates");
    EXPECT_TRUE(updates.wait_for_count(3)) << "updates flow without a subscriber to keyframes";
    EXPECT_GT(copied(statuses), 0u);
    keyframe = updates.last().keyframe;
    EXPECT_EQ(updates.all().front().keyframe, keyframe);
  }
  EXPECT_TRUE(wait_until([&] { return copied(statuses) == 0; }));
  ros::Duration(2).sleep();  // the node notices within a second that nobody takes updates any more
  const Listener<LayerUpdate> anew("layers/slope_updates");
  EXPECT_EQ(anew.last().keyframe, keyframe + 1) << "what subscribers held was forgotten";
  EXPECT_TRUE(call<std_srvs::Trigger>("pause").success);
}

}  // namespace

int main(int argc, char** argv) { return node_test::run_tests(argc, argv, "layers"); }
