#include "src/ros/node/node_parameter_page.hpp"

#include <sstream>

#include "src/core/parameter_page.hpp"
#include "src/ros/node/node_parameters.hpp"
#include "src/ros/topics/map_layers.hpp"

namespace desert_sim {

namespace {

void write_map_layers(std::ostream& out) {
  const MapSetup defaults;
  out << "\n## Layers of maps\n\n"
         "`grid_map_layers` (default `"
      << listed(defaults.grid_map_layers) << "`) and `local_map_layers` (default `"
      << listed(defaults.local_map_layers)
      << "`) are lists of these; `~get_submap` and `~get_grid_map` know the same. A layer that nobody asks "
         "for is "
         "not computed; one that the terrain does not have is 0.\n\n| layer | unit | what |\n|---|---|---|\n";
  for (const MapLayer& layer : map_layers) {
    const LayerInfo& about = info(layer.layer);
    out << "| `" << layer.name << "` | " << about.unit << " | " << about.doc << " |\n";
  }
}

}  // namespace

std::string describe_node_parameters() {
  std::ostringstream out;
  out << "# Parameters of the node\n\n"
         "Written by `desert_sim_node --describe`; a test fails when it is stale. All are private to the "
         "node. "
         "Beside them it takes the sections of a scenario ([parameters.md](parameters.md)), and `settings`, "
         "a "
         "list of `path=value` that override keys of the scenario file.\n\n## Node\n\n";
  write_parameter_table(out, NodeParameters());
  out << "\n## Topics\n\n"
         "Rates are of wall time; without subscribers nothing is sent. A rate of 0 leaves what is sent to a "
         "new "
         "subscriber, before the service `~step` answers, and after a reset or load.\n\n";
  write_parameter_table(out, PublisherParameters());
  out << "\n## Maps\n\n";
  write_parameter_table(out, MapParameters());
  write_map_layers(out);
  return out.str();
}

}  // namespace desert_sim
