#pragma once
/// What micro-relief depends on in cells (micro_relief::Cells), computed of layers: for all rows of a
/// snapshot, or for the cells that somebody asks for.

#include <memory>
#include <vector>

#include "kernels/base/grid.hpp"
#include "kernels/micro_relief/relief.hpp"
#include "kernels/rover/height_field.hpp"
#include "src/simulation/views/snapshot.hpp"

namespace desert_sim {

/// The law of micro-relief on a terrain, without pointers to cells. `grid`: of all its rows or of a band;
/// layers are not looked at.
micro_relief::Relief relief_without_cells(const Snapshot& grid);

/// One state of a whole terrain, of which layers are read as far as they are needed.
class MicroReliefSource {
 public:
  using Rectangle = height_field::Rectangle;

  virtual ~MicroReliefSource() = default;
  /// The whole grid and its settings; layers and feet of it are not looked at.
  virtual const Snapshot& grid() const = 0;
  /// Of all squares; null if the settings need none.
  virtual std::shared_ptr<const PlantFeet> feet() const = 0;
  /// One of MicroRelief::layers() in cells of the grid, row-major; empty if the terrain lacks the layer.
  virtual std::vector<float> values(Layer layer, const Rectangle& cells) const = 0;

  /// Whether a layer is 0 in all cells.
  bool is_zero(Layer layer) const;
  /// Elevations of these cells and of those around them, which are the same or the opposite ones beyond an
  /// edge that is open or periodic.
  std::vector<float> elevations_with_frame(const Rectangle& cells) const;
};

class MicroReliefCells {
 public:
  /// Layers of a row of cells; null: 0. Elevations are read one cell beyond both ends, too.
  struct Row {
    const float *elevation, *south, *north;  ///< [m]; those of the neighbouring rows
    const float *sand, *soil, *water, *moisture, *obstacle, *wind_x, *wind_y, *wind_shadow;
  };
  /// Where the values of a row go (micro_relief::Cells).
  struct Values {
    float *mobile, *level, *turn_x, *turn_y;
  };

  /// `wind_is_known`: whether the terrain has a wind at the surface in any cell. Some models move sand
  /// without a layer of it.
  MicroReliefCells(const Snapshot& grid, bool wind_is_known);
  void fill(const Row& row, int cells, const Values& to) const;
  /// The values of a rectangle, row-major.
  void fill(const MicroReliefSource& source, const MicroReliefSource::Rectangle& cells,
            const Values& to) const;

 private:
  void fill_turns(const Row& row, int cells, const Values& to) const;

  MicroReliefSettings settings_;
  wind::Vector wind_above_;
  float two_cells_;    ///< [m]
  float wind_square_;  ///< of the wind above [m²/s²]
  bool wind_is_known_;
};

}  // namespace desert_sim
