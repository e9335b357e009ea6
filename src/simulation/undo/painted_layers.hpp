#pragma once
/// Layers as strokes paint them (EditKind::painted): a cell is what the newest stroke says that has painted
/// it and is not undone, so that the order of undos does not matter. What a process has changed since goes
/// with the stroke, and comes back with a redo.

#include <deque>

#include "src/simulation/state/state.hpp"
#include "src/simulation/undo/cell_list.hpp"
#include "src/simulation/undo/stroke.hpp"

namespace desert_sim {

/// Notes that an edit with this order, which grows with each, has painted these cells (in their order) of a
/// layer.
void paint(std::deque<Stroke>& strokes, Stroke& stroke, Layer layer, const std::vector<PaintedCell>& cells);

/// Undoes or redoes what the stroke painted in one of its layers; `stroke.undone` says what it was until now.
/// Returns the change of each of the layer's cells. `list`: these cells on the device.
std::vector<float> turn(std::deque<Stroke>& strokes, const Stroke& stroke, PaintedLayer& layer,
                        const CellList& list, Terrain& terrain);

}  // namespace desert_sim
