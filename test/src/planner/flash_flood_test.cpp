// Rovers whose way leads along a dry channel, down which a flood comes (scenario flash_flood): who plans
// through forecasts is out of it by then, who plans over the present ground is not.

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>

#include "src/core/constants.hpp"
#include "src/planner/navigator.hpp"
#include "src/rover/grid_ground.hpp"
#include "src/rover/rover.hpp"
#include "src/rover/rover_class.hpp"
#include "src/simulation/checkpoint.hpp"
#include "src/simulation/forecast/forecast.hpp"
#include "src/simulation/forecast/passability.hpp"
#include "test/support/running.hpp"

namespace desert_sim {
namespace {

constexpr double step = 0.5;             // of the desert [s]
constexpr double forecast_period = 150;  // [s]

/// The desert, state by state, and what a forecast tells of it.
class Wadi {
 public:
  Wadi() : scene_(shipped("flash_flood")) { look(); }
  void step() {
    scene_.run(1);
    look();
  }
  double time() { return scene_.simulation().time(); }
  GridFrame frame() const { return {snapshot_->width, snapshot_->height, snapshot_->cell_size, 0, 0}; }
  const std::vector<float>& traversability() const { return *snapshot_->find(Layer::traversability); }
  const GridGround& ground() const { return *ground_; }

  /// As the node makes it: a run ahead on a copy of the present state, with the timeline to come.
  ForecastCosts forecast() {
    ForecastOptions options;
    options.horizon = 300;
    options.moments = 15;
    options.stride = 2;
    ForecastRun run(checkpoint_bytes(scene_.simulation()), options, "cpu", 1);
    const auto maps = run.run([](int, double) { return true; });
    ForecastCosts told;
    told.made = time();
    told.frame = frame();
    for (const ForecastMoment& moment : maps->moments) {
      told.times.push_back(moment.time);
      std::vector<float>& values = told.traversability.emplace_back();
      for (const std::int8_t cost : moment.costs)
        values.push_back(is_passable(cost) ? std::max(1.0F - static_cast<float>(cost) / 99.0F, 0.001F)
                                           : 0.0F);
    }
    return told;
  }

 private:
  void look() {
    std::vector<Layer> layers = GridGround::layers_of_snapshot();
    layers.push_back(Layer::traversability);
    snapshot_ = scene_.simulation().views().snapshot(layers);
    ground_ = std::make_unique<GridGround>(*snapshot_, 0.3);
  }
  Running scene_;
  std::shared_ptr<const Snapshot> snapshot_;
  std::unique_ptr<GridGround> ground_;
};

/// A rover and its planner, which drive in lockstep with the desert.
struct Driver {
  Driver(PlannerKind kind, Wadi& wadi) : navigator(parameters(kind)), rover(rover_of_file(), {}) {
    rover.place(236, 51, pi, wadi.ground());
    take(wadi);
    navigator.set_goal({150, 62, 0}, 0);
  }
  static PlannerParameters parameters(PlannerKind kind) {
    PlannerParameters p;
    p.planner = kind;
    p.speed = p.forecast_speed = 0.2;  // its drive_speed
    p.radius = 1.5;
    return p;
  }
  static RoverParameters rover_of_file() {
    const std::string file = source_folder() + "/config/rovers/six_wheel_200kg.yaml";
    return rover_of_class(YAML::LoadFile(file), file);
  }
  void take(const Wadi& wadi) {
    const GridFrame f = wadi.frame();
    navigator.update(f, {0, 0, f.width, f.height}, wadi.traversability().data());
  }
  void drive(Wadi& wadi) {
    take(wadi);
    const RoverState& s = rover.state();
    rover.drive(navigator.act(wadi.time(), {s.pose.x, s.pose.y, s.pose.yaw}, s.condition, s.reason), step);
    rover.advance(step, &wadi.ground());
    const GroundPoint under = wadi.ground().at(s.pose.x, s.pose.y);
    most_flow = std::max(most_flow, under.flow());
    if (s.condition == RoverCondition::blocked && s.reason.find("no hold in water") != std::string::npos &&
        held < 0)
      held = wadi.time();
  }
  void report(const char* name) const {
    const Pose& p = rover.state().pose;
    DESERT_REPORT("%s: at (%.1f, %.1f), held by water at %.1f s, at most %.2f m2/s; %s", name, p.x, p.y, held,
                  most_flow, navigator.status().reason.c_str());
  }
  Navigator navigator;
  Rover rover;
  double most_flow = 0;  ///< depth × speed of the water around it [m²/s]
  double held = -1;      ///< when it first lost its hold [s]
};

TEST(FlashFlood, AForecastGetsARoverOutOfTheChannelInTime) {
  if (!DESERT_WITH_IO) GTEST_SKIP() << "this build reads no rasters";
  Wadi wadi;
  Driver present(PlannerKind::field, wadi), ahead(PlannerKind::forecast, wadi);
  double asked = -forecast_period;
  while (wadi.time() < 280) {  // the flood comes at 210 s
    if (wadi.time() - asked >= forecast_period) {
      ahead.navigator.set_forecast(wadi.forecast());
      asked = wadi.time();
    }
    present.drive(wadi);
    ahead.drive(wadi);
    wadi.step();
  }
  present.report("present ground");
  ahead.report("forecast");
  EXPECT_GT(present.held, 180) << "its way must lead along the channel";
  EXPECT_GT(present.most_flow, 5 * present.rover.parameters().max_flow);
  EXPECT_EQ(present.navigator.status().state, NavigatorState::recovering);
  EXPECT_LT(ahead.held, 0);
  EXPECT_LT(ahead.most_flow, ahead.rover.parameters().max_flow);
  EXPECT_EQ(ahead.navigator.status().state, NavigatorState::driving) << ahead.navigator.status().reason;
  const Pose& dry = ahead.rover.state().pose;
  EXPECT_LT(wadi.ground().at(dry.x, dry.y).water, 0.02);
  EXPECT_EQ(ahead.navigator.status().recoveries, 0);
}

}  // namespace
}  // namespace desert_sim
