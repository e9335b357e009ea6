#include "src/ros/topics/publisher_parameters.hpp"

#include "src/ros/node/frame_name.hpp"

namespace desert_sim {

void read_publisher_setup(const YAML::Node& root, Faults& faults, PublisherSetup& setup,
                          std::set<std::string>& known) {
  yaml::read_parameters(root, "", faults, setup.topics, known);
  read_map_setup(root, faults, setup.maps, known);
  check_frame(setup.maps.parameters.robot_frame, "robot_frame", faults);
}

}  // namespace desert_sim
