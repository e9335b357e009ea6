#pragma once
/// The cells that an undo or redo changed, for its answer.

#include <string>
#include <utility>
#include <vector>

#include "src/simulation/commands/command.hpp"
#include "src/simulation/state/state.hpp"
#include "src/simulation/undo/stroke.hpp"

namespace desert_sim {

class ChangedCells {
 public:
  explicit ChangedCells(const SimulationState& state) : state_(state) {}

  void add(const MaterialChange& change);
  /// `by`: the change of each of these cells.
  void add(const PaintedLayer& layer, const std::vector<float>& by);
  /// The cells that the plants stand in.
  void add(const PlantChange& plants);

  /// The rectangle that has all of them.
  CellRectangle rectangle() const { return rectangle_; }
  /// What changed in each layer of which cells were added, in that rectangle.
  std::vector<LayerChange> changes() const;

 private:
  struct OfLayer {
    Layer layer;
    std::vector<std::pair<int, float>> cells;
  };
  void extend(int cell);

  const SimulationState& state_;
  CellRectangle rectangle_;
  std::vector<OfLayer> layers_;
};

}  // namespace desert_sim
