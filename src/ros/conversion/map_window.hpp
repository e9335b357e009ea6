#pragma once
/// Maps of the terrain: which layers they can have, which cells they show, and the values of those cells. The
/// topics ~grid_map and ~local_map, and the services ~get_submap and ~get_grid_map, are made of these.

#include <functional>
#include <string>
#include <vector>

#include "src/ros/simulation/terrain_state.hpp"
#include "src/simulation/views/micro_relief.hpp"
#include "src/terrain/map_layers.hpp"

namespace desert_sim {

class SimulationThread;

// ---- Layers: the table is map_layers.

/// The layers of these names, in their order. Throws ConfigError, naming the parameter or field `key`, for a
/// name that is unknown (with the known ones) or occurs twice.
std::vector<MapLayer> map_layers_named(const std::vector<std::string>& names, const std::string& key);

/// Their names as a list in YAML: [elevation, slope].
std::string yaml_list(const std::vector<MapLayer>& layers);

/// The layers of the terrain that these show.
std::vector<Layer> layers_of(const std::vector<MapLayer>& layers);

// ---- Windows.

/// Columns x0 … x0 + width − 1 and rows y0 … y0 + height − 1 of the terrain. It may reach beyond the terrain.
struct MapWindow {
  int x0 = 0, y0 = 0, width = 0, height = 0;
};

/// A rectangle in the terrain's frame [m].
struct MapRegion {
  double center_x = 0, center_y = 0, length_x = 0, length_y = 0;
};

MapWindow whole_window(const Snapshot& snapshot);

/// The cells of a region: its lengths are rounded to whole cells (half cells up, one at least), and of all
/// windows of that size it is the one whose centre is nearest to the region's. A region along the edges of
/// cells is met exactly. Throws ConfigError, naming the field, for numbers that are not finite, and for
/// lengths not above 0 or beyond 2²⁹ cells.
MapWindow window_of(const MapRegion& region, const Snapshot& snapshot);

/// Throws ConfigError, saying how far the terrain reaches, if a part of the window lies outside it.
void require_inside(const MapWindow& window, const MapRegion& region, const Snapshot& snapshot);

/// Throws ConfigError, naming `what`, if `layers` of this window have more than 67108864 values (256 MiB).
void require_map_size(const MapWindow& window, std::size_t layers, const std::string& what);

/// The values of blocks of `decimation`² cells, row-major from the south-west, ⌈width/decimation⌉ columns.
/// How a block gets its value, MapLayer::merged says; a block over the window's edge takes the cells that it
/// has. Cells outside an open terrain are NaN; a periodic terrain repeats. A layer that is not in use is 0.
std::vector<float> window_values(const Snapshot& snapshot, const MapLayer& layer, const MapWindow& window,
                                 int decimation = 1);

/// The values of the cells in which the points of a finer window lie, in the same order.
std::vector<float> nearest_values(const Snapshot& snapshot, const MapLayer& layer,
                                  const MicroReliefWindow& window);

// ---- Cuts: only the rows of the window are computed and copied.

struct MapCut {
  TerrainState state;  ///< of a band of rows
  MapWindow window;    ///< in the cells of that band
};

/// A part of the present terrain. `choose` gets the terrain's grid (a snapshot without layers) and says which
/// of its cells. Throws what `choose` throws, and what require_map_size() does, naming `what`. Waits for the
/// simulation thread.
MapCut cut_terrain(SimulationThread& simulation, const std::vector<MapLayer>& layers, const std::string& what,
                   const std::function<MapWindow(const Snapshot&)>& choose);

/// A part of the present terrain in squares of `resolution` metres that lie on a lattice from the terrain's
/// origin on. Throws and waits as cut_terrain() does.
struct MicroReliefCut {
  TerrainState state;  ///< of the rows that the window's elevation depends on
  MicroReliefWindow window;
};
MicroReliefCut cut_micro_relief(SimulationThread& simulation, const std::vector<MapLayer>& layers,
                                const std::string& what, const MapRegion& region, double resolution);

}  // namespace desert_sim
