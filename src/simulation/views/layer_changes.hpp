#pragma once
/// What others lack of a layer, tile by tile.

#include <cstdint>
#include <map>
#include <vector>

#include "kernels/view/held_layer.hpp"
#include "src/simulation/views/staging.hpp"

namespace desert_sim {

/// What is asked about a layer whose changes somebody subscribes to. The simulation keeps the values that the
/// subscribers hold, so that it can answer with what they lack.
struct HeldQuery {
  /// Which values it is to keep, after its answer, as those that subscribers hold: the same as before (with
  /// the changes of this answer), the present ones, the present ones if it keeps none, or none.
  enum class Hold { as_before, present, present_if_none, none };

  /// Whether the cells are asked for that changed since what subscribers hold.
  bool changes = false;
  held_layer::Tolerance tolerance;
  int tile = 1;  ///< largest width and height of a rectangle of changes [cells]
  Hold hold = Hold::as_before;
};
using HeldQueries = std::map<Layer, HeldQuery>;

/// Cells x … x + width − 1, y … y + height − 1, row-major, of which some changed.
struct TileChange {
  int x = 0, y = 0, width = 0, height = 0;
  int bits = 0;          ///< of a step: 4 or 8; 0 if there are none
  float resolution = 0;  ///< of a step, in the layer's unit
  /// One of both, with held_layer::unchanged_step or unchanged_elevation in the place of a cell that did
  /// not change.
  std::vector<std::int8_t> steps;
  std::vector<float> values;

  bool changed(std::size_t cell) const {
    return bits ? steps[cell] != held_layer::unchanged_step : values[cell] != held_layer::unchanged_value;
  }
};

/// Tiles in which a cell changed, row-major.
struct LayerChanges {
  std::vector<TileChange> tiles;
};

using PendingChanges = std::map<Layer, Pending<LayerChanges>>;

/// Reads what held_layer::pack_changes() has packed in `slot`; only that is copied.
std::vector<TileChange> unpacked_changes(Staging::Slot& slot, const packed_tiles::Tiling& tiles);

}  // namespace desert_sim
