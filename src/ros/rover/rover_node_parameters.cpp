#include "src/ros/rover/rover_node_parameters.hpp"

#include <set>
#include <sstream>
#include <utility>

#include "src/core/files.hpp"
#include "src/core/parameter_page.hpp"
#include "src/ros/conversion/frames.hpp"
#include "src/ros/support/outer_name.hpp"
#include "src/ros/support/private_parameters.hpp"
#include "src/rover/rover_class.hpp"
#include "src/scenario/scenario_file.hpp"
#include "src/scenario/yaml_document.hpp"
#include "src/scenario/yaml_parameters.hpp"

namespace desert_sim {

namespace {

YAML::Node yaml_of_file(const std::string& path) {
  try {
    return yaml::load_document(read_file(path));
  } catch (const YAML::Exception& e) {
    throw ConfigError(path + ": " + e.what());
  }
}

/// The file that the name of a class stands for.
std::string class_file(const std::string& name) {
  if (name.find('/') != std::string::npos) return name;
  const std::string scenarios = installed_scenario_folder();
  if (scenarios.empty()) throw ConfigError("rover_class: the package desert_sim is not in ROS_PACKAGE_PATH");
  return scenarios.substr(0, scenarios.rfind('/')) + "/rovers/" + name + ".yaml";
}

RoverSetup setup_of(const YAML::Node& root, const std::string& source) {
  ValidationErrors errors(source);
  RoverSetup setup;
  std::set<std::string> known{"rover", "wheel_ground"};
  yaml::read_parameters(root, "", errors, setup.node, known);
  if (root.IsMap())
    read_sensor_parameters(root, errors, setup.lidar, setup.depth_camera, setup.sensor_media, known);
  yaml::reject_unknown_keys(root, "", known, errors);
  if (!setup.node.rover_class.empty()) {
    const std::string file = class_file(setup.node.rover_class);
    setup.rover = rover_of_class(yaml_of_file(file), file);
  }
  if (root.IsMap()) {
    yaml::read_section(root["rover"], "rover", errors, setup.rover);
    yaml::read_section(root["wheel_ground"], "wheel_ground", errors, setup.wheel_ground);
  }
  check_name(setup.node.terrain_node, "terrain_node", errors);
  if (!setup.node.tf_prefix.empty()) check_frame(setup.node.tf_prefix, "tf_prefix", errors);
  if (setup.node.x.has_value() != setup.node.y.has_value())
    errors.add(setup.node.x ? "y" : "x", "is left out, while the other coordinate is given");
  errors.throw_if_any();
  check_rover(setup.rover, source + ": rover");
  check_parameters(setup.lidar);
  check_parameters(setup.depth_camera);
  check_parameters(setup.sensor_media);
  return setup;
}

}  // namespace

RoverSetup read_rover_setup(const ros::NodeHandle& private_node) {
  const std::string name = private_node.getNamespace();
  RoverSetup setup = setup_of(private_parameters(name), "parameters of " + name);
  setup.node.terrain_node = outer_name(private_node, setup.node.terrain_node);
  return setup;
}

RoverSetup read_rover_words(const std::vector<std::string>& words) {
  YAML::Node root(YAML::NodeType::Map);
  std::string source = "command line";
  std::vector<std::pair<std::string, std::string>> values;
  for (const std::string& word : words) {
    const std::size_t at = word.find(":=");
    if (at == std::string::npos)
      root = yaml_of_file(source = word);
    else if (at + 2 < word.size())
      values.emplace_back(word.substr(0, at), word.substr(at + 2));
  }
  if (!root.IsMap()) throw ConfigError(source + ": has no keys and values");
  for (const auto& [key, value] : values) {
    const std::size_t at = key.find('/');
    if (at == std::string::npos) {
      root[key] = value;
      continue;
    }
    YAML::Node section = root[key.substr(0, at)];
    if (section.IsDefined() && !section.IsMap())
      throw ConfigError(source + ": " + key.substr(0, at) + " has no keys and values");
    section[key.substr(at + 1)] = value;
  }
  return setup_of(root, source);
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
  out << "\n## lidar\n\n";
  write_parameter_table(out, LidarParameters());
  out << "\n## depth_camera\n\n";
  write_parameter_table(out, DepthCameraParameters());
  out << "\n## sensor_media\n\n";
  write_parameter_table(out, SensorMediaParameters());
  return out.str();
}

}  // namespace desert_sim
