// Ripples and bumps that a rover's node makes of maps and of ~micro_relief are those of the simulation, to
// the bit.

#include "src/ros/rover/map_micro_relief.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "src/ros/conversion/micro_relief_message.hpp"
#include "src/ros/rover/map_ground.hpp"
#include "src/rover/grid_ground.hpp"
#include "src/simulation/views/snapshot_source.hpp"
#include "src/terrain/map_layers.hpp"
#include "test/support/refusal.hpp"
#include "test/support/ros/terrain_maps.hpp"
#include "test/support/scenes.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

using node_test::map_of;
using node_test::maps_of;

constexpr double capacity = 0.3, deepest = 0.5;

const std::string plants_of_a_layer =
    ", column: {layer: vegetation, x: 6, y: 36, size_x: 8, size_y: 8, height: 0.8}]";
const std::string live_plants =
    ", uniform: {layer: sand, value: 2}], run: {timeline: [{time: 1, command: edit_plants, species: bush, "
    "x: 3, y: 26, radius: 14, density: 0.3, size: 0.3}]}, vegetation: {enabled: true}, species: [{preset: "
    "bush, sand: 1, water_use: 0, moisture_lowest: 0, light_lowest: -10, light_highest: 10, root_cover: 0, "
    "stem_cover: 1, slope: 9, spawn: 0}]";

/// Dunes with a pond, a block and plants, after winds of two directions.
TerrainState dunes(const std::string& boundary, const std::string& plants = plants_of_a_layer) {
  const std::unique_ptr<Exec> exec = make_exec("cpu", 1);
  const auto world = test::simulate(
      *exec,
      "{seed: 9, grid: {width: 40, height: 56, cell_size: 0.75, origin_x: -12, origin_y: 5, boundary: " +
          boundary +
          "}, wind: {regime: timeline, segments: [{speed: 9, direction_deg: 20, duration: 3}, {speed: 11, "
          "direction_deg: 70}]}, micro_relief: {response_time: 5, crest_length: 0.7}, repose: "
          "{moisture_depth: 0.5}, "
          "saltation: {moisture_cutoff: 0.25}, terrain: [noise: "
          "{layer: "
          "sand, low: 0.2, high: 1.5, "
          "scale: 6}, column: {layer: obstacle, x: 2, y: 20, size_x: 2, size_y: 2, height: 1}, column: "
          "{layer: moisture, x: -6, y: 30, size_x: 6, size_y: 6, height: 0.05}" +
          plants + "}");
  test::run(*world, 8);
  TerrainState state;
  state.snapshot = world->views().snapshot(GridGround::layers_of_snapshot(true), {}, true);
  state.plants = world->views().begin_plants().get();
  return state;
}

TEST(MapMicroRelief, TheLayersAreThoseOfMicroRelief) {
  std::vector<Layer> layers;
  for (const std::string& name : TerrainMaps::names(MapUse::micro_relief))
    layers.push_back(find_map_layer(name)->layer);
  std::vector<Layer> expected = MicroRelief::layers();
  std::sort(layers.begin(), layers.end());
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(layers, expected);
}

void expect_the_surface_to_the_bit(const std::string& plants) {
  for (const char* boundary : {"open", "periodic"}) {
    const TerrainState state = dunes(boundary, plants);
    const Snapshot& s = *state.snapshot;
    const MapGround ground(maps_of(state), capacity, deepest, false);
    const auto expected = GridGround::with_micro_relief(s, capacity);
    const MicroRelief micro_relief(s);
    ASSERT_TRUE(ground.micro_relief());
    EXPECT_EQ(ground.finest_feature(), expected->finest_feature());
    std::mt19937 random(3);
    std::uniform_real_distribution<double> east(-12, -12 + 30), north(5, 5 + 42);
    double largest = 0;
    int smooth = 0;
    for (int n = 0; n < 3000; ++n) {
      const double x = east(random), y = north(random);
      ASSERT_EQ(ground.micro_relief()->offset(x, y), micro_relief.offset(x, y))
          << boundary << " " << x << " " << y;
      largest = std::max(largest, std::abs(micro_relief.offset(x, y)));
      smooth += micro_relief.offset(x, y) == 0;
      // Maps do not know that a terrain goes on over its edges.
      if (x > -11 && x < 17 && y > 6 && y < 46) {
        ASSERT_EQ(ground.elevation(x, y), expected->elevation(x, y)) << boundary << " " << x << " " << y;
      }
    }
    EXPECT_GT(largest, 0.004) << "there are ripples";
    EXPECT_GT(smooth, 10) << "there are none on the block";
  }
}

TEST(MapMicroRelief, WheelsHaveTheSimulationsSurfaceToTheBit) {
  expect_the_surface_to_the_bit(plants_of_a_layer);
}

TEST(MapMicroRelief, WheelsHaveTheSimulationsHeapsAtLivePlantsToTheBit) {
  const TerrainState state = dunes("open", live_plants);
  Snapshot elsewhere = *state.snapshot;
  elsewhere.micro_relief.plants_live = false;
  const MicroRelief with(*state.snapshot), without(elsewhere);
  ASSERT_GT(state.plants->plants.size(), 100u);
  int other = 0;
  for (const plants::PlantRecord& plant : state.plants->plants) {
    const double x = -12 + double{plant.x}, y = 5 + double{plant.y};
    other += std::abs(with.offset(x, y) - without.offset(x, y)) > 0.005;
  }
  EXPECT_GT(other, 50) << "heaps are elsewhere if the layer places them";
  expect_the_surface_to_the_bit(live_plants);
}

TEST(MapMicroRelief, PlantsThatAreMissingAreTold) {
  const TerrainState state = dunes("open", live_plants);
  const auto message = node_test::plants_message_of(*state.plants);
  EXPECT_EQ(MapPlants(message).shortage(), "");
  const std::size_t all = message->x.size();
  const auto few = boost::make_shared<Plants>(*message);
  for (auto* column : {&few->x, &few->y, &few->radius}) column->resize(7);
  const std::string shortage = MapPlants(few).shortage();
  EXPECT_NE(shortage.find("only the widest 7 of " + std::to_string(all) + " plants"), std::string::npos)
      << shortage;
  EXPECT_NE(shortage.find("Set plants_count of the terrain's node to at least " + std::to_string(all)),
            std::string::npos)
      << shortage;
  few->radius.resize(6);
  EXPECT_NE(test::refusal([&] { MapPlants{few}; }).find("7, 7 and 6 values"), std::string::npos);
}

TEST(MapMicroRelief, FeetOfATerrainAreFoundOnceAndForOtherSquaresAnew) {
  const TerrainState state = dunes("open", live_plants);
  const MapPlants plants(node_test::plants_message_of(*state.plants));
  const MicroReliefSettings& settings = state.snapshot->micro_relief;
  const auto feet = plants.feet(settings.bump_squares(40, 0.75, false));
  EXPECT_EQ(feet->widest, state.snapshot->feet->widest);
  EXPECT_EQ(plants.feet(settings.bump_squares(40, 0.75, false)), feet);
  MicroReliefSettings finer = settings;
  finer.parameters.bump_radius = 0.2f;
  EXPECT_EQ(plants.feet(finer.bump_squares(40, 0.75, false))->widest.size(), 60u * 84u);
}

// Without lockstep, maps may be off by their thresholds. In thin sand and water that can be all of a ripple.
TEST(MapMicroRelief, MapsWithinTheirThresholdsGiveNearlyTheSameRipples) {
  const TerrainState state = dunes("open");
  Snapshot near = *state.snapshot;
  std::mt19937 random(7);
  std::uniform_real_distribution<float> off(-1, 1);
  for (const char* name : {"elevation", "wind_x", "wind_y", "wind_shadow"}) {
    const MapLayer& layer = *find_map_layer(name);
    for (float& v : near.layers.at(layer.layer)) v += static_cast<float>(layer.threshold) * off(random);
  }
  const MicroRelief exact(*state.snapshot), about(near);
  double largest = 0;
  for (double x = -12; x < 18; x += 0.13)
    for (double y = 5; y < 47; y += 0.17)
      largest = std::max(largest, std::abs(about.offset(x, y) - exact.offset(x, y)));
  EXPECT_GT(largest, 1e-5);
  EXPECT_LT(largest, 1.5e-3);
}

TEST(MapMicroRelief, BeamsHaveThem) {
  const std::unique_ptr<Exec> exec = make_exec("cpu", 1);
  Lidar lidar(*exec, test::exact_lidar(12, 200, -40, -2), {});
  for (const std::string& plants : {plants_of_a_layer, live_plants}) {
    const TerrainState state = dunes("periodic", plants);
    const Snapshot& s = *state.snapshot;
    HeightFieldScene of_snapshot(*exec, {s.width, s.height, s.cell_size, s.origin_x, s.origin_y}),
        of_maps(*exec, of_snapshot.geometry());
    of_snapshot.set_micro_relief(source_of(s));
    of_maps.set_micro_relief(MapGround(maps_of(state), capacity, deepest, false).micro_relief());
    for (HeightFieldScene* const scene : {&of_snapshot, &of_maps})
      scene->update(SceneLayer::elevation, s.layers.at(Layer::elevation));
    for (const double x : {-11.5, 3.0, 17.5}) {
      const SensorPose pose{{x, 26, 4}};
      const std::vector<float> expected = lidar.scan(of_snapshot, pose, 0).distances;
      EXPECT_TRUE(test::same_bits(lidar.scan(of_maps, pose, 0).distances, expected));
      of_snapshot.clear_micro_relief();
      EXPECT_FALSE(test::same_bits(lidar.scan(of_snapshot, pose, 0).distances, expected));
      of_snapshot.set_micro_relief(source_of(s));
    }
  }
}

TEST(MapMicroRelief, WithoutAllThatItNeedsTheGroundIsBilinear) {
  const TerrainState state = dunes("open");
  const GridGround bilinear(*state.snapshot, capacity, deepest);
  std::vector<TerrainMaps> lacking(4, maps_of(state));
  lacking[0].micro_relief_settings = nullptr;
  lacking[1].forget(MapUse::micro_relief, MapUse::ground);
  Snapshot smaller = *state.snapshot;
  smaller.height -= 1;
  smaller.layers.clear();
  lacking[2].maps[TerrainMaps::wind_x] = map_of(smaller, "wind_x");
  Snapshot live = *lacking[3].micro_relief_settings;
  live.micro_relief.plants_live = true;
  lacking[3].micro_relief_settings = std::make_shared<const Snapshot>(live);
  lacking[3].plants = nullptr;
  EXPECT_FALSE(lacking[3].complete(MapUse::micro_relief));
  EXPECT_TRUE(maps_of(state).complete(MapUse::ground | MapUse::micro_relief));
  EXPECT_FALSE(lacking[0].complete(MapUse::micro_relief) || lacking[1].complete(MapUse::micro_relief));
  for (const TerrainMaps& maps : lacking) {
    EXPECT_TRUE(maps.complete(MapUse::ground));
    const MapGround ground(maps, capacity, deepest, false);
    EXPECT_FALSE(ground.micro_relief());
    EXPECT_EQ(ground.finest_feature(), bilinear.finest_feature());
    EXPECT_EQ(ground.elevation(3.1, 8.2), bilinear.elevation(3.1, 8.2));
  }
}

TEST(MapMicroRelief, ABrokenMessageIsRefusedWithAllThatIsWrong) {
  const MicroReliefStatePtr good = micro_relief_message(dunes("open"), "map");
  EXPECT_NO_THROW(snapshot_of(*good));
  MicroReliefState m = *good;
  m.parameters = "{longest: 7, colour: red}";
  m.mean_speed = std::nan("");
  m.ripples_passed = -1;
  m.repose_tangent = 0;
  m.moisture_depth = -2;
  m.wind_above.y = 1e30;
  const std::string why = test::refusal([&] { snapshot_of(m); });
  for (const char* part : {"parameters.longest: 7 is not in [0.1, 1] m", "parameters.colour: unknown key",
                           "speed: nan is not in [0, 101]", "passed: -1.0", "repose_tangent: 0.0",
                           "moisture_depth: -2", "wind_above.y"})
    EXPECT_NE(why.find(part), std::string::npos) << part << " in " << why;
  m = *good;
  m.parameters = "{longest: [";
  EXPECT_NE(test::refusal([&] { snapshot_of(m); }).find("parameters: yaml-cpp"), std::string::npos);
}

}  // namespace
}  // namespace desert_sim
