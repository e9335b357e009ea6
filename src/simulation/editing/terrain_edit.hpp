#pragma once
/// An edit of the terrain: placed on the grid, worked out, checked, and only then made.

#include <vector>

#include "kernels/edit/brush_smooth.hpp"
#include "src/scenario/scenario.hpp"
#include "src/simulation/commands/command.hpp"
#include "src/simulation/commands/edited_layers.hpp"
#include "src/simulation/undo/stroke.hpp"
#include "src/terrain/terrain.hpp"

namespace desert_sim {

class TerrainEdit {
 public:
  /// Works out what the edit changes. Throws ConfigError, and has changed nothing, if it is refused: see
  /// check_edit(); shapes that touch no cell or reach around a periodic terrain; heights out of the terrain's
  /// scale; a ring that cannot give or take what it should.
  TerrainEdit(const command::EditTerrain& command, Terrain& terrain, const GridParameters& grid,
              LedgerView ledger);

  Layer layer() const { return layer_; }
  /// What it changes, as the history keeps it.
  LayerEdit change() const;
  /// Makes the change. `with_change`: the result tells it cell by cell. Throws ConfigError if there is no
  /// memory for a painted layer that was not in use.
  CommandResult commit(bool with_change);
  /// Sand that it has added lies loosely, where the layer looseness is in use; see looseness.hpp.
  void loosen(const LoosenessParameters& p);

 private:
  void set_shape();
  void set_window(double centre_x, double centre_y, double reach_x, double reach_y);
  void choose_layer();
  void merge();
  void smooth();
  void conserve();
  void require_heights() const;
  bool of_material() const { return edit_kind(layer_) == EditKind::material; }
  /// A layer of whole quanta, as of materials and humus, and not of real numbers.
  bool counted() const { return info(layer_).storage == Storage::quanta; }
  double step_size() const;
  std::vector<float> change_of_rectangle() const;

  const command::EditTerrain& command_;
  Terrain& terrain_;
  const GridParameters& grid_;
  Layer layer_;
  brush::Brush brush_{};
  Buffer<Quanta> steps_;  ///< a layer of real numbers as the brush edits it; empty for one of quanta
  Buffer<brush::Point> vertices_;
  Buffer<float> patch_;
  Buffer<Quanta> change_;
  CellRectangle changed_cells_;
  long long total_ = 0;  ///< of the shape, without the ring [quanta]
};

}  // namespace desert_sim
