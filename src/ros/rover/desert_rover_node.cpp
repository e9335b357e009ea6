/// desert_rover_node: a rover as a ROS node. Without ROS:
///
///   --describe                           prints the page of its parameters
///   --urdf [FILE.yaml] [KEY:=VALUE]...   prints the model of a rover with these parameters
///   --replay JOURNAL SCENARIO            drives again what the journal has, beside a simulation of the
///                                        scenario (a name or a file), and prints where that ends
///
/// Exit status: 0 after a shutdown; 2 for input it refuses; 3 for a failure at run time.
#include <cstdio>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "src/core/error.hpp"
#include "src/core/hash_text.hpp"
#include "src/grid_map/grid_map_bag.hpp"
#include "src/ros/conversion/messages.hpp"
#include "src/ros/rover/rover_server.hpp"
#include "src/ros/support/node_program.hpp"
#include "src/rover/simulated_ground.hpp"
#include "src/rover/urdf.hpp"
#include "src/scenario/scenario_file.hpp"

namespace {

using desert_sim::exit_invalid_input;

int print_model(const std::vector<std::string>& words) {
  try {
    const desert_sim::RoverSetup setup = desert_sim::read_rover_words(words);
    std::cout << desert_sim::urdf_of(setup.rover, setup.lidar, setup.depth_camera, setup.frame(""));
    return 0;
  } catch (const desert_sim::ConfigError& e) {
    std::cerr << e.what() << "\n";
    return exit_invalid_input;
  }
}

int replay(const std::string& file, const std::string& name) {
  try {
    using namespace desert_sim;
    const RoverJournal journal = read_rover_journal(file);
    SimulatedGround ground(load_scenario(scenario_file(name)), raster_loader_with_bags({"", false}), "cpu", 0,
                           journal.micro_relief);
    const RoverState end = desert_sim::replay(
        journal, [&ground](std::uint64_t step) -> const GroundSource& { return ground.at(step); });
    std::printf("step %lu of the terrain, x %.6f, y %.6f, z %.6f, yaw %.6f, %s, state_hash %s\n",
                static_cast<unsigned long>(end.terrain_step), end.pose.x, end.pose.y, end.pose.z,
                end.pose.yaw, rover_conditions[static_cast<int>(end.condition)],
                hash_text(hash_of(end)).c_str());
    return 0;
  } catch (const desert_sim::Error& e) {
    std::cerr << e.what() << "\n";
    return exit_invalid_input;
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::string first = argc > 1 ? argv[1] : "";
  if (first == "--describe" && argc == 2) {
    std::cout << desert_sim::describe_rover_parameters();
    return 0;
  }
  if (first == "--urdf") return print_model({argv + 2, argv + argc});
  if (first == "--replay" && argc == 4) return replay(argv[2], argv[3]);
  if (first.rfind("--", 0) == 0) {
    std::cerr << "desert_rover_node: not one of --describe, --urdf [FILE.yaml] [KEY:=VALUE]..., --replay "
                 "JOURNAL SCENARIO\n";
    return exit_invalid_input;
  }
  return desert_sim::run_node(argc, argv, "desert_rover", [] {
    return std::make_unique<const desert_sim::RoverServer>(ros::NodeHandle(), ros::NodeHandle("~"));
  });
}
