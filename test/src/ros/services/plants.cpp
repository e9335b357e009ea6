/// ~edit_plants and what shows plants and water, on a paused node with the scenario garden.yaml.
#include <desert_sim/EditPlants.h>
#include <desert_sim/GetSubmap.h>
#include <desert_sim/Plants.h>
#include <desert_sim/QueryTerrain.h>
#include <desert_sim/SetWeather.h>
#include <sensor_msgs/point_cloud2_iterator.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "test/support/ros/service_tests.hpp"

namespace {

using namespace desert_sim;
using namespace node_test;

EditPlants::Request bushes() {
  EditPlants::Request request;
  request.operation = EditPlants::Request::PLANT;
  request.species = "bush";
  request.shape = "circle";
  request.center.x = 20;
  request.center.y = 20;
  request.radius = 6;
  request.density = 1;
  request.size = 0.5;
  return request;
}

EditPlants::Request cleared_bushes() {
  EditPlants::Request request = bushes();
  request.operation = EditPlants::Request::CLEAR;
  request.density = request.size = 0;
  return request;
}

double vegetation_at(double x, double y) {
  QueryTerrain::Request request;
  request.points.resize(1);
  request.points[0].x = x;
  request.points[0].y = y;
  const auto answer = call<QueryTerrain>("query_terrain", request);
  EXPECT_TRUE(answer.success) << answer.message;
  return answer.samples.at(0).vegetation;
}

TEST_F(Services, EditPlantsPutsPlantsThatGrowAndClearsThem) {
  const auto planted = call<EditPlants>("edit_plants", bushes());
  ASSERT_TRUE(planted.success) << planted.message;
  EXPECT_NEAR(planted.plants, 113, 40);  // one a square metre on a disc of 6 m
  step(2);
  EXPECT_GT(vegetation_at(20, 20), 0.3);
  EXPECT_EQ(vegetation_at(45, 20), 0);

  EditPlants::Request clear = cleared_bushes();
  clear.species = "tree";
  EXPECT_EQ(call<EditPlants>("edit_plants", clear).plants, 0);
  clear.species.clear();
  clear.radius = 20;
  const auto cleared = call<EditPlants>("edit_plants", clear);
  ASSERT_TRUE(cleared.success) << cleared.message;
  EXPECT_EQ(cleared.plants, -planted.plants);
  step(1);
  EXPECT_EQ(vegetation_at(20, 20), 0);
}

void clear_everything() {
  EditPlants::Request clear = cleared_bushes();
  clear.species.clear();
  clear.radius = 1000;
  EXPECT_TRUE(call<EditPlants>("edit_plants", clear).success);
}

TEST_F(Services, PlantsComeOneByOneTheWidestOfTooMany) {
  const auto planted = call<EditPlants>("edit_plants", bushes());
  ASSERT_TRUE(planted.success) << planted.message;
  EditPlants::Request tree = bushes();
  tree.species = "tree";
  tree.center.x = 50;
  tree.density = 0.05;
  tree.size = 1;
  const auto trees = call<EditPlants>("edit_plants", tree);
  ASSERT_GT(trees.plants, 0) << trees.message;
  step(1);
  const Plants list = Listener<Plants>("plants").last();
  EXPECT_EQ(list.header.frame_id, "map");
  EXPECT_GE(list.step, 1u);
  ASSERT_EQ(list.species.size(), 2u);
  EXPECT_EQ(list.species[1].name, "bush");
  EXPECT_EQ(list.species[1].max_radius, 2);
  EXPECT_FLOAT_EQ(list.species[1].mature_radius, 0.4f);
  EXPECT_EQ(list.total, static_cast<std::uint64_t>(planted.plants + trees.plants));
  const std::size_t sent = std::min<std::size_t>(100, list.total);  // plants_count
  ASSERT_EQ(list.x.size(), sent);
  for (const auto size : {list.y.size(), list.z.size(), list.radius.size()}) EXPECT_EQ(size, sent);
  ASSERT_EQ(list.species_index.size(), sent);
  ASSERT_EQ(list.health.size(), sent);
  long long trees_sent = 0;
  for (std::size_t n = 0; n < sent; ++n) {
    const bool is_tree = list.species_index[n] == 0;
    trees_sent += is_tree;
    EXPECT_LE(std::hypot(list.x[n] - (is_tree ? 50 : 20), list.y[n] - 20), 6.1);
    EXPECT_NEAR(list.z[n], 4, 0.1) << "on the ground";
    EXPECT_GT(list.radius[n], 0);
    EXPECT_GT(list.health[n], 200);
  }
  EXPECT_EQ(trees_sent, trees.plants) << "the widest";
  clear_everything();
  step(1);
  const Plants none = Listener<Plants>("plants").last();
  EXPECT_EQ(none.total, 0u);
  EXPECT_TRUE(none.x.empty());
  EXPECT_EQ(none.species.size(), 2u);
}

TEST_F(Services, PlantMarkersAreFewAndStandOnThePlants) {
  using visualization_msgs::Marker;
  const Listener<visualization_msgs::MarkerArray> listener("plant_markers");
  ASSERT_TRUE(call<EditPlants>("edit_plants", bushes()).success);
  step(1);
  const auto has = [](const visualization_msgs::MarkerArray& array, int action) {
    return std::any_of(array.markers.begin(), array.markers.end(),
                       [&](const Marker& m) { return m.ns == "bush" && m.action == action; });
  };
  ASSERT_TRUE(listener.wait_for([&](const auto& array) { return has(array, Marker::ADD); }));
  std::map<int, std::size_t> corners;
  for (const Marker& m : listener.last().markers) {
    if (m.action != Marker::ADD) continue;
    EXPECT_EQ(m.ns, "bush") << "there are no trees";
    EXPECT_EQ(m.type, Marker::TRIANGLE_LIST);
    EXPECT_EQ(m.points.size() % 3, 0u);
    EXPECT_GT(m.color.g, m.color.b);
    corners[m.id] = m.points.size();
    for (const auto& p : m.points) {
      EXPECT_LE(std::hypot(p.x - 20, p.y - 20), 6 + 2.1);
      EXPECT_GT(p.z, 3.9);
      EXPECT_LT(p.z, 8.5);
    }
  }
  // plant_markers_count is 50: five with a trunk of 3 and a crown of 12 sides, the others pyramids of 4.
  EXPECT_EQ(corners[0], 5u * 15 * 3);
  EXPECT_EQ(corners[1], 45u * 4 * 3);
  clear_everything();
  step(1);
  ASSERT_TRUE(listener.wait_for([&](const auto& array) {
    return has(array, Marker::DELETE) && !has(array, Marker::ADD);
  })) << "markers of plants that are gone are taken away";
}

TEST_F(Services, WaterHasASurfaceAndPlantsALayer) {
  const Listener<sensor_msgs::PointCloud2> listener("water_points");
  EXPECT_EQ(listener.last().width, 0u) << "dry";
  SetWeather::Request pour;
  pour.change = {"springs"};
  pour.springs.resize(1);
  pour.springs[0].x = 44;
  pour.springs[0].y = 24;
  pour.springs[0].radius = 3;
  pour.springs[0].discharge = 10;
  const auto answer = call<SetWeather>("set_weather", pour);
  ASSERT_TRUE(answer.success) << answer.message;
  ASSERT_TRUE(call<EditPlants>("edit_plants", bushes()).success);
  step(2);
  ASSERT_TRUE(listener.wait_for([](const auto& wet) { return wet.width > 0; }));
  pour.springs.clear();
  EXPECT_TRUE(call<SetWeather>("set_weather", pour).success);
  const sensor_msgs::PointCloud2 cloud = listener.last();
  EXPECT_EQ(cloud.height, 1u);
  EXPECT_GT(cloud.width, 20u);
  sensor_msgs::PointCloud2ConstIterator<float> x(cloud, "x"), y(cloud, "y"), z(cloud, "z"),
      depth(cloud, "depth");
  for (; x != x.end(); ++x, ++y, ++z, ++depth) {
    EXPECT_LT(std::hypot(*x - 44, *y - 24), 12);
    EXPECT_GT(*depth, 0.01);
    EXPECT_LT(*depth, 1);
    EXPECT_NEAR(*z, 4 + *depth, 1e-4);
  }
  GetSubmap::Request whole;
  whole.center.x = 32;
  whole.center.y = 24;
  whole.length_x = 64;
  whole.length_y = 48;
  whole.layers = {"plants", "water_surface"};
  const auto map = call<GetSubmap>("get_submap", whole);
  ASSERT_TRUE(map.success) << map.message;
  const auto at = [&](std::size_t layer, int mx, int my) {
    return map.map.layers.at(layer).data.at(static_cast<std::size_t>(my * 64 + mx));
  };
  EXPECT_GT(at(1, 44, 24), 4.05);
  EXPECT_NEAR(at(1, 10, 40), 4.0, 1e-3);
  int of_bush = 0;
  for (int my = 14; my < 26; ++my)
    for (int mx = 14; mx < 26; ++mx) of_bush += at(0, mx, my) == 2;
  EXPECT_GT(of_bush, 80) << "second of the list";
  EXPECT_EQ(at(0, 60, 40), 0);
  clear_everything();
}

TEST_F(Services, EditPlantsRefuses) {
  EditPlants::Request request = bushes();
  request.species = "cactus";
  expect_refused<EditPlants>("edit_plants", request, "cactus", "bush");
  request = bushes();
  request.operation = "water";
  expect_refused<EditPlants>("edit_plants", request, "operation: 'water'", "plant, clear");
  request = bushes();
  request.density = std::nan("");
  expect_refused<EditPlants>("edit_plants", request, "density", "[0, 1000] 1/m^2");
  request = bushes();
  request.shape = "patch";
  expect_refused<EditPlants>("edit_plants", request, "shape", "patch");
  request = bushes();
  request.header.frame_id = "nowhere";
  expect_refused<EditPlants>("edit_plants", request, "nowhere", "");
}

}  // namespace

int main(int argc, char** argv) { return node_test::run_tests(argc, argv, "plants"); }
