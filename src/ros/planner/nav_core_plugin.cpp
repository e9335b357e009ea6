/// The field planner as a global planner of move_base: base_global_planner: desert_sim/FieldGlobalPlanner.
/// Built where nav_core and costmap_2d are found. Costs are those of move_base's costmap, with its inflation;
/// private parameters below the plugin's name:
///
///   buckets (16), cost_weight (8)   as those of desert_planner_node
///   tolerance (0.5)                 how far from the goal a path may end where the goal is lethal [m]
///   escape (1)                      how far from the start it may begin where the start is lethal [m]
///   allow_unknown (false)           whether unknown cells count as the best ground
#include <costmap_2d/cost_values.h>
#include <costmap_2d/costmap_2d.h>
#include <costmap_2d/costmap_2d_ros.h>
#include <nav_core/base_global_planner.h>
#include <nav_msgs/Path.h>
#include <ros/node_handle.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <pluginlib/class_list_macros.hpp>
#include <string>
#include <vector>

#include "src/core/error.hpp"
#include "src/planner/field_planner.hpp"
#include "src/planner/grid_path.hpp"
#include "src/ros/planner/planner_messages.hpp"
#include "src/ros/support/latched_publisher.hpp"

namespace desert_sim {

class FieldGlobalPlanner : public nav_core::BaseGlobalPlanner {
 public:
  void initialize(std::string name, costmap_2d::Costmap2DROS* costmap) override {
    costmap_ = costmap;
    ros::NodeHandle node("~/" + name);
    node.param("buckets", parameters_.buckets, parameters_.buckets);
    node.param("cost_weight", parameters_.weight, parameters_.weight);
    node.param("tolerance", tolerance_, tolerance_);
    node.param("escape", escape_, escape_);
    node.param("allow_unknown", allow_unknown_, allow_unknown_);
    parameters_.radius = 0;  // the costmap is inflated
    path_ = {node, "plan", 1};
    CostGrid({1, 1, 1, 0, 0}, parameters_);  // throws for parameters out of range
  }

  bool makePlan(const geometry_msgs::PoseStamped& start, const geometry_msgs::PoseStamped& goal,
                std::vector<geometry_msgs::PoseStamped>& plan) override {
    plan.clear();
    if (!costmap_) {
      ROS_ERROR("FieldGlobalPlanner: makePlan() before initialize()");
      return false;
    }
    const std::string frame = costmap_->getGlobalFrameID();
    for (const auto* pose : {&start, &goal})
      if (pose->header.frame_id != frame) {
        ROS_ERROR("FieldGlobalPlanner: a pose in the frame '%s' (allowed: '%s')",
                  pose->header.frame_id.c_str(), frame.c_str());
        return false;
      }
    take_costs();
    const auto from = near(start, escape_), to = near(goal, tolerance_);
    if (!from || !to) {
      // move_base asks again and again while it has no plan.
      ROS_WARN_THROTTLE(1, "FieldGlobalPlanner: the %s (%.2f, %.2f) is not passable", from ? "goal" : "start",
                        (from ? goal : start).pose.position.x, (from ? goal : start).pose.position.y);
      return false;
    }
    if (field_->goal() != *to) {
      field_->compute(*to);
    } else {
      field_->note(changed_);
      field_->repair(*from);
    }
    changed_.clear();
    const GridPath points = resampled(shortened(*grid_, field_->path_from(*from)), grid_->frame().cell_size);
    const nav_msgs::Path path = path_message(points, {}, nullptr, frame, ros::Time::now());
    plan = path.poses;
    if (!plan.empty()) plan.back().pose.orientation = goal.pose.orientation;
    path_.publish(path);
    if (plan.empty())
      ROS_WARN_THROTTLE(1, "FieldGlobalPlanner: no passable way leads from (%.2f, %.2f) to (%.2f, %.2f)",
                        start.pose.position.x, start.pose.position.y, goal.pose.position.x,
                        goal.pose.position.y);
    return !plan.empty();
  }

 private:
  std::optional<CellIndex> near(const geometry_msgs::PoseStamped& pose, double distance) const {
    const GridPoint p{pose.pose.position.x, pose.pose.position.y};
    return grid_->nearest_passable(p, std::max(distance, grid_->frame().cell_size / 2));
  }

  /// Brings the grid up to date, row by row where the costmap has changed.
  void take_costs() {
    costmap_2d::Costmap2D& map = *costmap_->getCostmap();
    const boost::unique_lock<costmap_2d::Costmap2D::mutex_t> lock(*map.getMutex());
    const GridFrame frame{static_cast<int>(map.getSizeInCellsX()), static_cast<int>(map.getSizeInCellsY()),
                          map.getResolution(), map.getOriginX(), map.getOriginY()};
    const std::size_t width = map.getSizeInCellsX(), cells = width * map.getSizeInCellsY();
    const bool anew = !grid_ || !(grid_->frame() == frame);
    if (anew) {
      field_.reset();
      grid_ = std::make_unique<CostGrid>(frame, parameters_);
      field_ = std::make_unique<FieldPlanner>(*grid_);
      costs_.assign(cells, costmap_2d::NO_INFORMATION);
      changed_.clear();
    }
    const unsigned char* const now = map.getCharMap();
    std::vector<float> row(width);
    for (int y = 0; y < frame.height; ++y) {
      const std::size_t begin = static_cast<std::size_t>(y) * width;
      if (!anew &&
          std::equal(now + begin, now + begin + width, costs_.begin() + static_cast<std::ptrdiff_t>(begin)))
        continue;
      std::copy(now + begin, now + begin + width, costs_.begin() + static_cast<std::ptrdiff_t>(begin));
      std::transform(now + begin, now + begin + width, row.begin(),
                     [this](unsigned char c) { return value_of(c); });
      grid_->update({0, y, frame.width, 1}, row.data(), changed_);
    }
  }
  float value_of(unsigned char cost) const {
    if (cost == costmap_2d::NO_INFORMATION)
      return allow_unknown_ ? 1.0F : std::numeric_limits<float>::quiet_NaN();
    if (cost >= costmap_2d::INSCRIBED_INFLATED_OBSTACLE) return 0;
    return 1.0F - static_cast<float>(cost) / 253.0F;
  }

  costmap_2d::Costmap2DROS* costmap_ = nullptr;
  CostParameters parameters_;
  double tolerance_ = 0.5, escape_ = 1;
  bool allow_unknown_ = false;
  std::unique_ptr<CostGrid> grid_;
  std::unique_ptr<FieldPlanner> field_;
  std::vector<unsigned char> costs_;
  std::vector<CellIndex> changed_;
  LatchedPublisher<nav_msgs::Path> path_;
};

}  // namespace desert_sim

PLUGINLIB_EXPORT_CLASS(desert_sim::FieldGlobalPlanner, nav_core::BaseGlobalPlanner)
