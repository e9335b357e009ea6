// Messages that the node of a planner takes, as a sequence from one input: each is refused, or the navigator
// goes on with it, and what it commands and publishes is finite.
#include <console_bridge/console.h>
#include <desert_sim/RoverStatus.h>
#include <move_base_msgs/MoveBaseGoal.h>
#include <nav_msgs/Odometry.h>
#include <tf2_msgs/TFMessage.h>

#include <boost/make_shared.hpp>
#include <cmath>

#include "include/desert_sim/client/layer_assembler.hpp"
#include "src/core/log.hpp"
#include "src/ros/conversion/terrain_transforms.hpp"
#include "src/ros/planner/planner_messages.hpp"
#include "test/fuzz/fuzz.hpp"
#include "test/fuzz/message_source.hpp"

namespace desert_sim {
namespace {

const std::vector<std::string> words{"map",     "map",   "rover",      "",         "/rover", "driving",
                                     "blocked", "stuck", "no_terrain", "off_grid", "buried", "tipped"};
constexpr std::uint32_t side = 24;

PlannerParameters parameters(PlannerKind kind) {
  PlannerParameters p;
  p.planner = kind;
  return p;
}

/// The node of a planner without threads and without ROS.
class Node {
 public:
  explicit Node(PlannerKind kind) : navigator_(parameters(kind)) {
    auto grid = boost::make_shared<LayerGrid>();
    grid->layer = "traversability";
    grid->keyframe = 1;
    grid->header.frame_id = "map";
    grid->width = grid->height = side;
    grid->cell_size = 0.5;
    grid->origin.orientation.w = 1;
    grid->data.assign(std::size_t{side} * side, 1);
    show(LayerGrid::ConstPtr(grid));
  }

  void take(FuzzedDataProvider& data) {
    switch (data.ConsumeIntegralInRange(0, 7)) {
      case 0:
        return set_goal(fuzz::next_message<geometry_msgs::PoseStamped>(data, words));
      case 1:
        return set_goal(fuzz::next_message<move_base_msgs::MoveBaseGoal>(data, words).target_pose);
      case 2: {
        auto goal = geometry_msgs::PoseStamped();
        goal.pose.position.x = data.ConsumeFloatingPointInRange(0.0, 12.0);
        goal.pose.position.y = data.ConsumeFloatingPointInRange(0.0, 12.0);
        goal.pose.orientation.w = 1;
        return set_goal(goal);
      }
      case 3: {
        const auto status = fuzz::next_message<RoverStatus>(data, words);
        condition_ = condition_named(status.state);
        reason_ = status.reason;
        return;
      }
      case 4:
        pose_ = planar_pose(fuzz::next_message<nav_msgs::Odometry>(data, words).pose.pose, "ground_truth");
        return;
      case 5:
        return take_terrain(data);
      case 6:
        return take_forecast(data);
      default:
        return fuzz::hear_transforms(fuzz::next_message<tf2_msgs::TFMessage>(data, words),
                                     [this](const auto& t) { transforms_.setTransform(t, "fuzz", true); });
    }
  }

  void act(double seconds) {
    time_ += seconds;
    const DriveCommand command = navigator_.act(time_, pose_, condition_, reason_);
    for (const double number : {command.forward, command.sideways, command.yaw_rate})
      if (!std::isfinite(number)) std::abort();
    const nav_msgs::Path path =
        path_message(navigator_.path(), navigator_.schedule(), elevation_.get(), "map", ros::Time());
    for (const geometry_msgs::PoseStamped& pose : path.poses) planar_pose(pose.pose, "path");
    planner_status_message(navigator_.status());
  }

 private:
  void set_goal(const geometry_msgs::PoseStamped& goal) {
    const geometry_msgs::PoseStamped in_terrain = goal_in_terrain(goal, "map", transforms_);
    navigator_.set_goal(planar_pose(in_terrain.pose, "the goal"), time_);
  }

  void show(const LayerGrid::ConstPtr& grid) {
    const MapChange change = assembler_.process(grid);
    if (!change.map) return;
    elevation_ = change.map;
    const LayerMap::Rectangle& c = change.cells;
    if (c.empty()) return;
    navigator_.update(
        grid_frame_of(change.map->info()),
        {static_cast<int>(c.x), static_cast<int>(c.y), static_cast<int>(c.width), static_cast<int>(c.height)},
        change.map->values(c).data());
  }
  void take_terrain(FuzzedDataProvider& data) {
    auto grid = boost::make_shared<LayerGrid>(fuzz::next_message<LayerGrid>(data, words));
    if (data.ConsumeBool()) {  // of the same place
      const MapInfo& info = elevation_->info();
      grid->header.frame_id = "map";
      grid->keyframe = info.keyframe + 1;
      grid->width = info.width;
      grid->height = info.height;
      grid->cell_size = info.cell_size;
      grid->origin = geometry_msgs::Pose();
      grid->origin.position.x = info.origin_x;
      grid->origin.position.y = info.origin_y;
      grid->origin.orientation.w = 1;
      grid->data.resize(std::size_t{info.width} * info.height, 1);
    }
    show(grid);
  }

  void take_forecast(FuzzedDataProvider& data) {
    auto forecast = fuzz::next_message<Forecast>(data, words);
    if (data.ConsumeBool()) fit(forecast, data);
    navigator_.set_forecast(forecast_costs(forecast, forecast.sim_time, 1, 0.5));
  }
  /// Gives it maps of the terrain's size and place.
  void fit(Forecast& forecast, FuzzedDataProvider& data) const {
    forecast.costs.resize(data.ConsumeIntegralInRange<std::size_t>(1, 4));
    forecast.times.clear();
    const MapInfo& info = elevation_->info();
    for (nav_msgs::OccupancyGrid& map : forecast.costs) {
      forecast.times.push_back(10.0 * static_cast<double>(forecast.times.size()));
      map.info.width = info.width;
      map.info.height = info.height;
      map.info.resolution = static_cast<float>(info.cell_size);
      map.info.origin.position.x = info.origin_x;
      map.info.origin.position.y = info.origin_y;
      map.data.resize(std::size_t{info.width} * info.height);
    }
    forecast.members = 1;
  }

  Navigator navigator_;
  tf2::BufferCore transforms_;
  LayerAssembler assembler_;
  std::shared_ptr<const LayerMap> elevation_;
  PlanarPose pose_{6, 6, 0};
  RoverCondition condition_ = RoverCondition::driving;
  std::string reason_;
  double time_ = 0;
};

}  // namespace
}  // namespace desert_sim

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace desert_sim;
  console_bridge::noOutputHandler();
  set_log_sink([](Severity, const std::string&) {});
  FuzzedDataProvider data(bytes, size);
  Node node(data.ConsumeBool() ? PlannerKind::field : PlannerKind::forecast);
  for (int n = 0; n < 24 && data.remaining_bytes() > 0; ++n) {
    fuzz::take_messages(data, 1, [&] { node.take(data); });
    node.act(data.ConsumeFloatingPointInRange(0.0, 40.0));
  }
  return 0;
}
