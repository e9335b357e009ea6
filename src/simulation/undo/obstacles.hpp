#pragma once
/// Obstacles as strokes paint them. No process changes them, so a cell is always what the newest stroke says
/// that has painted it and is not undone; the order of undos does not matter.

#include <deque>

#include "src/simulation/state/state.hpp"
#include "src/simulation/undo/cell_list.hpp"
#include "src/simulation/undo/stroke.hpp"

namespace desert_sim {

/// Notes that an edit with this order, which grows with each, has painted these cells (in their order).
void paint_obstacles(std::deque<Stroke>& strokes, Stroke& stroke, const std::vector<ObstacleCell>& cells);

/// Undoes or redoes what the stroke painted; `stroke.undone` says what it was until now. Returns the change
/// of each of its cells. `list`: these cells on the device.
std::vector<float> turn_obstacles(std::deque<Stroke>& strokes, const Stroke& stroke,
                                  std::vector<ObstacleCell>& cells, const CellList& list, Terrain& terrain);

}  // namespace desert_sim
