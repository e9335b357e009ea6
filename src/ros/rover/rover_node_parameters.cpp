#include "src/ros/rover/rover_node_parameters.hpp"

#include <ros/names.h>

#include <set>
#include <sstream>

#include "src/core/files.hpp"
#include "src/core/parameter_page.hpp"
#include "src/ros/node/frames.hpp"
#include "src/ros/node/private_parameters.hpp"
#include "src/scenario/yaml_parameters.hpp"

namespace desert_sim {

namespace {

RoverSetup setup_of(const YAML::Node& root, const std::string& source) {
  ValidationErrors errors(source);
  RoverSetup setup;
  std::set<std::string> known{"rover", "wheel_ground"};
  yaml::read_parameters(root, "", errors, setup.node, known);
  yaml::reject_unknown_keys(root, "", known, errors);
  if (root.IsMap()) {
    yaml::read_section(root["rover"], "rover", errors, setup.rover);
    yaml::read_section(root["wheel_ground"], "wheel_ground", errors, setup.wheel_ground);
  }
  std::string why;
  if (setup.node.terrain_node.empty() || !ros::names::validate(setup.node.terrain_node, why))
    errors.add("terrain_node", "'" + setup.node.terrain_node + "' is not the name of a node: " + why);
  if (!setup.node.tf_prefix.empty()) check_frame(setup.node.tf_prefix, "tf_prefix", errors);
  if (setup.node.x.has_value() != setup.node.y.has_value())
    errors.add(setup.node.x ? "y" : "x", "is left out, while the other coordinate is given");
  errors.throw_if_any();
  check_rover(setup.rover, source + ": rover");
  return setup;
}

}  // namespace

RoverSetup read_rover_setup(const ros::NodeHandle& private_node) {
  const std::string name = private_node.getNamespace();
  return setup_of(private_parameters(name), "parameters of " + name);
}

RoverSetup read_rover_file(const std::string& path) {
  try {
    return setup_of(YAML::Load(read_file(path)), path);
  } catch (const YAML::Exception& e) {
    throw ConfigError(path + ": " + e.what());
  }
}

std::string describe_rover_parameters() {
  std::ostringstream out;
  out << "# Parameters of rovers\n\n"
         "Written by `desert_rover_node --describe`; a test fails when it is stale. All are private to the "
         "node.\n\n"
         "## Node\n\n";
  write_parameter_table(out, RoverNodeParameters());
  out << "\n## rover\n\n";
  write_parameter_table(out, RoverParameters());
  out << "\n## wheel_ground\n\n";
  write_parameter_table(out, WheelGroundParameters());
  return out.str();
}

}  // namespace desert_sim
