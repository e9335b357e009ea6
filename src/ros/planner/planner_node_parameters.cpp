#include "src/ros/planner/planner_node_parameters.hpp"

#include <set>
#include <sstream>

#include "src/core/parameter_page.hpp"
#include "src/ros/conversion/frames.hpp"
#include "src/ros/support/outer_name.hpp"
#include "src/ros/support/private_parameters.hpp"
#include "src/scenario/yaml_parameters.hpp"

namespace desert_sim {

PlannerSetup read_planner_setup(const ros::NodeHandle& private_node) {
  const std::string name = private_node.getNamespace();
  const YAML::Node root = private_parameters(name);
  ValidationErrors errors("parameters of " + name);
  PlannerSetup setup;
  std::set<std::string> known;
  yaml::read_parameters(root, "", errors, setup.node, known);
  yaml::read_parameters(root, "", errors, setup.planner, known);
  yaml::reject_unknown_keys(root, "", known, errors);
  check_name(setup.node.terrain_node, "terrain_node", errors);
  check_name(setup.node.rover_node, "rover_node", errors);
  if (!setup.node.goal_topic.empty()) check_name(setup.node.goal_topic, "goal_topic", errors);
  check_frame(setup.node.base_frame, "base_frame", errors);
  if (!setup.node.tf_prefix.empty()) check_frame(setup.node.tf_prefix, "tf_prefix", errors);
  errors.throw_if_any();
  setup.node.terrain_node = outer_name(private_node, setup.node.terrain_node);
  if (!setup.node.goal_topic.empty()) setup.node.goal_topic = outer_name(private_node, setup.node.goal_topic);
  return setup;
}

std::string describe_planner_parameters() {
  std::ostringstream out;
  out << "# Parameters of planners\n\n"
         "Written by `desert_planner_node --describe`; a test fails when it is stale. All are private to the "
         "node.\n\n"
         "## Node\n\n";
  write_parameter_table(out, PlannerNodeParameters());
  out << "\n## Costs, paths and following\n\n";
  write_parameter_table(out, PlannerParameters());
  return out.str();
}

}  // namespace desert_sim
