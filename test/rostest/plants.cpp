/// ~edit_plants, on a paused node with the scenario garden.yaml.
#include <desert_sim/EditPlants.h>
#include <desert_sim/QueryTerrain.h>

#include <cmath>

#include "rostest/service_tests.hpp"

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

  EditPlants::Request clear = bushes();
  clear.operation = EditPlants::Request::CLEAR;
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
