/// desert_rover_node: a rover as a ROS node.
#include "src/ros/rover/rover_node.hpp"

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

namespace desert_sim {

namespace {

Options rover_node_options() {
  Options o("desert_rover_node", "A rover as a ROS node, which it is without options.");
  o.positional("WORD", "of --urdf: FILE.yaml and KEY:=VALUE; of --replay: the scenario (a name or a file)", 0,
               1000)
      .flag("describe", "print the page of its parameters")
      .flag("urdf", "print the model of a rover with the parameters of a file and of words after it")
      .option(
          "replay", "JOURNAL",
          "drive again what the journal has, beside a simulation of the scenario, and print where that ends")
      .footer("Exit status: 0 after a shutdown; 2 for input it refuses; 3 for a failure at run\ntime.");
  return o;
}

void print_model(const std::vector<std::string>& words) {
  const RoverSetup setup = read_rover_words(words);
  std::cout << urdf_of(setup.rover, setup.lidar, setup.depth_camera, setup.frame(""));
}

void replay_and_print(const std::string& file, const std::string& scenario) {
  const RoverJournal journal = read_rover_journal(file);
  SimulatedGround ground(load_scenario(scenario_file(scenario)), raster_loader_with_bags({"", false}), "cpu",
                         0, journal.micro_relief);
  const RoverState end =
      replay(journal, [&ground](std::uint64_t step) -> const GroundSource& { return ground.at(step); });
  std::printf("step %lu of the terrain, x %.6f, y %.6f, z %.6f, yaw %.6f, %s, state_hash %s\n",
              static_cast<unsigned long>(end.terrain_step), end.pose.x, end.pose.y, end.pose.z, end.pose.yaw,
              rover_conditions[static_cast<int>(end.condition)], hash_text(hash_of(end)).c_str());
}

int run_rover_options(const Options& o) {
  if (o.has("describe") + o.has("urdf") + o.has("replay") != 1)
    throw ConfigError("one of --describe, --urdf and --replay must be given (--help shows the usage)");
  if (o.has("urdf")) {
    print_model(o.positional());
  } else if (o.has("replay")) {
    if (o.positional().size() != 1)
      throw ConfigError("--replay " + o.text("replay", "") + ": needs one scenario, " +
                        std::to_string(o.positional().size()) + " given");
    replay_and_print(o.text("replay", ""), o.positional()[0]);
  } else {
    if (!o.positional().empty()) throw ConfigError("'" + o.positional()[0] + "': unexpected argument");
    std::cout << describe_rover_parameters();
  }
  return 0;
}

}  // namespace

int run_rover_node(int argc, char** argv) {
  if (has_options(argc, argv)) return run_main(rover_node_options(), argc, argv, run_rover_options);
  return run_node(argc, argv, "desert_rover", [] {
    return std::make_unique<const RoverServer>(ros::NodeHandle(), ros::NodeHandle("~"));
  });
}

}  // namespace desert_sim
