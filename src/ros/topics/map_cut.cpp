#include "src/ros/topics/map_cut.hpp"

#include <cmath>

namespace desert_sim {

MapCut cut_terrain(SimulationThread& simulation, const std::vector<MapLayer>& layers,
                   const std::function<MapWindow(const Snapshot&)>& choose) {
  while (true) {
    const TerrainState whole = simulation.terrain({}).get();
    MapCut cut;
    cut.window = choose(*whole.snapshot);
    cut.state = simulation.terrain(terrain_layers(layers), {cut.window.y0, cut.window.height}).get();
    if (cut.state.moment.terrain != whole.moment.terrain) continue;  // it was replaced in between
    const double south = cut.state.snapshot->origin_y - whole.snapshot->origin_y;
    cut.window.y0 -= static_cast<int>(std::lround(south / whole.snapshot->cell_size));
    return cut;
  }
}

}  // namespace desert_sim
