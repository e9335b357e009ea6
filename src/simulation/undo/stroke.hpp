#pragma once
/// A stroke: what the edits of one name changed, cell by cell, as undo and redo need it. It holds the changes
/// that were really made: by painting, or by the undo or redo that came last.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kernels/field/layers.hpp"
#include "kernels/field/ledger.hpp"
#include "kernels/plants/population.hpp"
#include "src/simulation/commands/edited_layers.hpp"

namespace desert_sim {

struct CellAmount {
  int cell;
  Quanta amount;  ///< not 0 [quanta]
};

/// The change of one layer of material.
struct MaterialChange {
  Layer layer;
  std::vector<CellAmount> cells;  ///< in the order of cells
  long long in = 0, out = 0;      ///< what was booked as entered and left [quanta]; their difference is the
                                  ///< sum of the amounts
  bool conserving = true;         ///< all edits moved the material within the layer
};

/// Material::… of a layer that brushes edit.
Material material_of(Layer layer);

/// A cell of a painted layer. Of all strokes that are not undone, the one with the greatest `order` says what
/// the cell is, and its `before` is what it would be without that stroke.
struct PaintedCell {
  int cell;
  std::uint32_t before, after;  ///< as the layer stores them
  std::uint64_t order;          ///< grows with each edit
};

struct PaintedLayer {
  Layer layer;
  std::vector<PaintedCell> cells;  ///< in the order of cells
};

/// What one edit changed in its layer.
struct LayerEdit {
  Layer layer = Layer::sand;
  bool conserve = false;
  std::vector<CellAmount> cells;     ///< of a layer of material, in the order of cells
  std::vector<PaintedCell> painted;  ///< of a painted layer, in the order of cells; without `order`
};

using PlantWords = std::array<std::uint32_t, plants::column_count>;

/// A plant that was put or taken away. See Population for its rank and mark.
struct ChangedPlant {
  PlantWords words;
  std::uint64_t rank, mark;
};

struct PlantChange {
  std::vector<ChangedPlant> added, removed;
  std::vector<ChangedPlant> passed;  ///< came and went within the stroke; both of its changes
  bool empty() const { return added.empty() && removed.empty() && passed.empty(); }
};

/// What ground the stroke has made loose; see LooseGround.
struct LooseMark {
  std::uint64_t epoch = 0;
  std::array<std::uint64_t, 2> marks{};  ///< of bedrock, of soil
  bool older = false;                    ///< it also changed ground before that epoch
};

/// A setting (see settings.hpp) that a command has changed; none: it is not there. `before` and `order` as in
/// PaintedCell.
struct ChangedSetting {
  std::string key;
  std::optional<std::string> before, after;
  std::uint64_t order = 0;
};

struct Stroke {
  std::string name;  ///< empty: one call
  bool undone = false;
  std::uint64_t last_action = 0;  ///< grows with each edit, undo and redo
  std::vector<MaterialChange> materials;
  std::vector<PaintedLayer> painted;
  PlantChange plants;
  std::vector<std::string> species;  ///< of the scenario when plants were painted last
  LooseMark loose;
  std::vector<ChangedSetting> settings;
  std::vector<Layer> new_layers;  ///< that settings have brought into use

  /// Adds what an edit changed in a layer of material.
  void add(Layer layer, const std::vector<CellAmount>& cells, bool conserve);
  /// Whether they can be added: what a cell got or lost in all stays within the range of its integer.
  bool has_room(Layer layer, const std::vector<CellAmount>& cells) const;
  bool changed(Layer layer) const;
  /// The cells of a painted layer; an empty list to begin with.
  std::vector<PaintedCell>& painted_in(Layer layer);
  /// What it counts for in the memory of the history. It depends on nothing but what it holds, because a
  /// replay has to forget the same strokes.
  std::size_t bytes() const;
};

}  // namespace desert_sim
