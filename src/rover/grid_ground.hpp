#pragma once
/// Ground from arrays, for tests and for rovers beside a simulation in the same program.

#include <memory>
#include <vector>

#include "src/rover/ground.hpp"
#include "src/simulation/views/micro_relief.hpp"

namespace desert_sim {

class GridGround : public GroundSource {
 public:
  struct Geometry {
    int width = 1, height = 1;          ///< [cells]
    double cell_size = 1;               ///< [m]
    double origin_x = 0, origin_y = 0;  ///< of the lower-left corner [m]
    bool periodic_x = false, periodic_y = false;
  };
  /// Values of cells, row-major, x fastest, row 0 in the south. Arrays that are empty stand for 0
  /// (looseness: not known); NaN in `elevation` is unknown ground.
  struct Layers {
    std::vector<float> elevation, sand_depth, soil_depth, looseness, moisture, obstacle, water, water_x,
        water_y;
    double moisture_capacity = 0.3;  ///< of a metre of ground [m]
    double moisture_depth = 1;       ///< down to which ground holds it [m]
  };

  /// Throws ConfigError for an array of the wrong size.
  GridGround(const Geometry& geometry, Layers layers);
  /// Of a snapshot, as far as it has the layers. It must have the elevation. Looseness is not known where it
  /// is 0 everywhere.
  GridGround(const Snapshot& snapshot, double moisture_capacity, double moisture_depth = 1);
  /// Likewise, with ripples and bumps on the elevation; the snapshot must be of all rows.
  static std::unique_ptr<GridGround> with_micro_relief(const Snapshot& snapshot, double moisture_capacity,
                                                       double moisture_depth = 1);
  /// The layers that a snapshot for a rover needs, whether its ground has micro_relief or not.
  static std::vector<Layer> layers_of_snapshot(bool micro_relief = false);

  bool contains(double x, double y) const override;
  std::optional<double> elevation(double x, double y) const override;
  GroundPoint at(double x, double y) const override;
  double finest_feature() const override;

 private:
  double value(const std::vector<float>& layer, double x, double y) const;
  /// Of the cell in which the point lies.
  double cell_value(const std::vector<float>& layer, double x, double y) const;

  Geometry g_;
  Layers layers_;
  std::unique_ptr<const MicroRelief> micro_relief_;  ///< null: none
};

}  // namespace desert_sim
