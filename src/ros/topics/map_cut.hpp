#pragma once
/// A piece of the terrain for a map: only its rows are computed and copied.

#include <functional>
#include <vector>

#include "src/ros/node/simulation_thread.hpp"
#include "src/ros/topics/map_window.hpp"

namespace desert_sim {

struct MapCut {
  TerrainState state;  ///< a band of rows
  MapWindow window;    ///< in the band's cells
};

/// `choose` gets the terrain's grid (a snapshot without layers) and says which of its cells; what it throws
/// is passed on. Waits for the simulation thread.
MapCut cut_terrain(SimulationThread& simulation, const std::vector<MapLayer>& layers,
                   const std::function<MapWindow(const Snapshot&)>& choose);

}  // namespace desert_sim
