#pragma once
/// The surface between the centres of cells, with ripples and bumps (kernels/micro_relief/relief.hpp): for
/// maps of a fine resolution, wheels and beams. It is computed of a snapshot, and nothing of it is part of
/// the state. The same place, time, seed and state give the same height to the bit, whatever else is asked
/// for.

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "kernels/micro_relief/relief.hpp"
#include "src/simulation/views/micro_relief_cells.hpp"
#include "src/simulation/views/snapshot.hpp"

namespace desert_sim {

/// The finest resolution of a window [m].
constexpr double finest_detail = 1e-3;

/// Points in rows from the south-west, at the centres of squares of `resolution` metres.
struct MicroReliefWindow {
  double x0 = 0, y0 = 0;  ///< south-west corner in the terrain's frame [m]
  int columns = 1, rows = 1;
  double resolution = 0.05;  ///< [m]

  std::size_t points() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
};

class MicroRelief {
 public:
  /// Width of the crests that wheels have to find [m]: of ripples 5 cm long.
  static constexpr double crest_width = 0.01;

  /// The layers that a snapshot for it has. One that the terrain does not have may be missing.
  static const std::vector<Layer>& layers();
  /// Rows of cells beyond a band of the terrain on which heights in the band depend.
  static int margin(const MicroReliefParameters& parameters, double cell_size);
  /// The rows of a terrain that a snapshot for a window must have. `grid`: any snapshot of it.
  static RowBand band(const MicroReliefWindow& window, const Snapshot& grid);

  /// Of a snapshot of all rows, or of a band with its margin, with feet (Views::begin_snapshot()). Throws
  /// ConfigError if it lacks the elevation, or feet that it needs.
  explicit MicroRelief(const Snapshot& snapshot);
  MicroRelief(const MicroRelief&) = delete;
  MicroRelief& operator=(const MicroRelief&) = delete;

  /// What micro-relief adds at a point of the terrain's frame to the surface that is bilinear between cells
  /// [m]; 0 where the ground is unknown, and beyond open edges.
  double offset(double x, double y) const;
  /// The law, with pointers into this.
  const micro_relief::Relief& relief() const { return relief_; }
  /// Elevations of a window [m]; NaN where the ground is unknown, and beyond open edges.
  std::vector<float> elevations(const MicroReliefWindow& window) const;

 private:
  void take_feet(const Snapshot& snapshot);
  void fill_cells(const Snapshot& snapshot);
  void fill_rows(const Snapshot& snapshot, const MicroReliefCells& law);
  bool contains(double x, double y) const;
  /// Of the bilinear surface, at metres from the south-west corner of the terrain.
  double surface(double x, double y) const;

  const MicroReliefSettings settings_;
  const double cell_size_, origin_x_, origin_y_;  ///< of the whole terrain [m]
  const int width_, height_;                      ///< of the whole terrain [cells]
  const bool periodic_x_, periodic_y_;
  const int first_row_, rows_;
  std::vector<float> elevation_, sand_, mobile_, level_, growth_, stones_, turn_x_, turn_y_;
  std::shared_ptr<const PlantFeet> feet_;  ///< null: it needs none
  micro_relief::Relief relief_;
};

}  // namespace desert_sim
