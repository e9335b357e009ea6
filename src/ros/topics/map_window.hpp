#pragma once
/// Rectangles of the terrain's cells, and what a layer is in them.

#include <string>
#include <vector>

#include "src/ros/topics/map_layers.hpp"
#include "src/simulation/simulation.hpp"

namespace desert_sim {

/// Columns x0 … x0 + width − 1 and rows y0 … y0 + height − 1 of the terrain; may reach beyond it.
struct MapWindow {
  int x0 = 0, y0 = 0, width = 0, height = 0;
};

/// A rectangle in the terrain's frame [m].
struct MapRegion {
  double center_x = 0, center_y = 0, length_x = 0, length_y = 0;
};

MapWindow whole_window(const Snapshot& snapshot);

/// The cells of a region: its lengths rounded to whole cells (half cells up, one at least), and of all
/// windows of that size the one whose centre is nearest to the region's. A region along the cells' edges is
/// met exactly. Throws ConfigError, naming the field, for numbers that are not finite, lengths not above 0 or
/// beyond 2²⁹ cells.
MapWindow window_of(const MapRegion& region, const Snapshot& snapshot);

/// Throws ConfigError, saying how far the terrain reaches, if some of the window lies off it.
void require_inside(const MapWindow& window, const MapRegion& region, const Snapshot& snapshot);

/// Values by blocks of `decimation`² cells, row-major from the south-west, ⌈width/decimation⌉ columns: means,
/// or the lowest for layers that say so; a block over the window's edge takes what it has. Off an open
/// terrain NaN; a periodic one goes on. A layer that is not in use is 0.
std::vector<float> window_values(const Snapshot& snapshot, const MapLayer& layer, const MapWindow& window,
                                 int decimation = 1);

}  // namespace desert_sim
