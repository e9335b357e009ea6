/// How long services take on a machine that has nothing else to do, on a paused node with the scenario
/// corner.yaml.
#include <desert_sim/EditTerrain.h>
#include <desert_sim/QueryTerrain.h>
#include <desert_sim/Undo.h>

#include <cstdio>
#include <functional>

#include "test/support/ros/service_tests.hpp"

namespace {

using namespace desert_sim;
using namespace node_test;

double seconds(const std::function<void()>& work) {
  const ros::SteadyTime begin = ros::SteadyTime::now();
  work();
  return (ros::SteadyTime::now() - begin).toSec();
}

TEST_F(Services, AMissingFrameIsNotWaitedForForLong) {
  QueryTerrain::Request request;
  request.points.resize(1);
  request.header.frame_id = "nowhere";
  EXPECT_LT(seconds([&] { EXPECT_FALSE(call<QueryTerrain>("query_terrain", request).success); }), patience());
}

TEST_F(Services, AStrokeIsUndoneInMilliseconds) {
  constexpr int strokes = 200;
  ros::ServiceClient edit = ros::NodeHandle().serviceClient<EditTerrain>("/desert_sim/edit_terrain", true);
  EditTerrain brush;
  brush.request.layer = "sand";
  brush.request.shape = "circle";
  brush.request.merge = "add";
  brush.request.radius = 8;
  brush.request.inner = 1;
  brush.request.value = 0.01;
  for (int n = 0; n < strokes; ++n) {
    brush.request.center.x = 30 + n % 40;
    brush.request.center.y = 10 + n % 30;
    brush.request.stroke = std::to_string(n);
    for (int part = 0; part < 2; ++part)
      ASSERT_TRUE(edit.call(brush) && brush.response.success) << brush.response.message;
  }
  ros::ServiceClient undo = ros::NodeHandle().serviceClient<Undo>("/desert_sim/undo", true);
  const double milliseconds = 1000.0 / strokes * seconds([&] {
                                Undo exchange;
                                for (int n = 0; n < strokes; ++n)
                                  ASSERT_TRUE(undo.call(exchange) && exchange.response.success)
                                      << exchange.response.message;
                              });
  std::printf("  measured: %.2f ms an undo\n", milliseconds);
  EXPECT_LT(milliseconds, 50 * patience());
}

}  // namespace

int main(int argc, char** argv) { return node_test::run_tests(argc, argv, "services_timing"); }
