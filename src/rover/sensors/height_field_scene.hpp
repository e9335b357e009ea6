#pragma once
/// The terrain as range sensors see it: a height field with plants and airborne sand in the memory of a
/// backend, which is kept up to date by rectangles of cells that have changed.

#include <memory>
#include <vector>

#include "kernels/backend/buffer.hpp"
#include "kernels/backend/exec.hpp"
#include "kernels/rover/height_field.hpp"
#include "src/rover/sensors/scene_micro_relief.hpp"

namespace desert_sim {

/// What sensors need to know of the terrain, by the names that maps have for it.
enum class SceneLayer { elevation, canopy_height, vegetation, airborne_sand };

struct SceneGeometry {
  int width = 0, height = 0;          ///< [cells]
  double cell_size = 1;               ///< [m]
  double origin_x = 0, origin_y = 0;  ///< south-west corner of cell (0, 0) in the terrain's frame [m]
};
bool operator==(const SceneGeometry& a, const SceneGeometry& b);

/// Not safe to use from several threads at once.
class HeightFieldScene {
 public:
  using Rectangle = height_field::Rectangle;

  /// Ground that is unknown everywhere, without plants, and still air. Keeps a reference to `exec`. Throws
  /// ConfigError for a grid without cells or with too many, and for numbers that are not finite.
  HeightFieldScene(Exec& exec, const SceneGeometry& geometry);

  Exec& exec() const { return exec_; }
  const SceneGeometry& geometry() const { return geometry_; }
  const height_field::View& view() const { return view_; }

  /// Replaces the values of a rectangle of cells, row-major from the south-west [m; vegetation: 1]. An
  /// elevation that is not finite is unknown; of the other layers, what is not above 0 counts as 0. Only
  /// these cells are copied to the device, and only what depends on them is computed anew; memory for plants
  /// and airborne sand is taken when there are any. Throws ConfigError if the rectangle exceeds the grid, or
  /// has another number of values.
  void update(SceneLayer layer, const Rectangle& cells, const std::vector<float>& values);
  /// The same for the whole grid.
  void update(SceneLayer layer, const std::vector<float>& values);

  /// Puts ripples and bumps on the ground until the next call, as far as scans ask for them. The elevation
  /// that beams meet is still that of update(). Throws ConfigError if the source has another grid.
  void set_micro_relief(std::shared_ptr<const MicroReliefSource> source);
  void clear_micro_relief() { has_micro_relief_ = false; }
  /// Null: there are none.
  SceneMicroRelief* micro_relief() const { return has_micro_relief_ ? micro_relief_.get() : nullptr; }

 private:
  void check(const Rectangle& cells, std::size_t values) const;
  Buffer<float>& buffer_of(SceneLayer layer);
  void write(SceneLayer layer, const Rectangle& cells, const std::vector<float>& values);
  void refresh_tops(const Rectangle& cells);
  void refresh_dust(const Rectangle& cells);
  Rectangle whole() const { return {0, 0, geometry_.width, geometry_.height}; }

  Exec& exec_;
  const SceneGeometry geometry_;
  height_field::View view_;
  Buffer<float> elevation_, tops_;
  Buffer<float> canopy_, density_;                    ///< empty while there are no plants
  Buffer<float> airborne_sand_, dust_, dust_ground_;  ///< empty while no sand is in the air
  std::unique_ptr<SceneMicroRelief> micro_relief_;    ///< null before the first
  bool has_micro_relief_ = false;
  Buffer<float> staging_;  ///< values on their way to the device
};

}  // namespace desert_sim
