#pragma once
/// Measures single dunes, and what lies in front of walls, from their definitions. Winds name where the air
/// moves to.

#include "src/metrics/field.hpp"

namespace desert_sim {

/// One dune: a connected patch (8 neighbours) of sand deeper than a threshold. "Along" and "across" are seen
/// from the wind; positions are metres from the south-west corner, of periodic fields unwrapped around the
/// patch.
struct DuneShape {
  std::size_t cells = 0;
  double volume = 0;                ///< [m³]
  double height = 0;                ///< crest above the lowest ground within the patch's outline [m]
  double width = 0;                 ///< extent across the wind [m]
  double length = 0;                ///< extent along the wind [m]
  double x = 0, y = 0;              ///< centre of volume [m]
  double crest_x = 0, crest_y = 0;  ///< highest point [m]
  double stoss_deg = 0;             ///< windward side through the crest: line from 10 % to 90 % of the height
  double slip_face_deg = 0;  ///< lee side below the crest: line from 75 % to 25 % of the height, the steepest
                             ///< of those within 45 degrees of the wind
  double slip_direction_deg = 0;  ///< mean downslope direction of cells steeper than 28 degrees
  double slip_share = 0;          ///< share of the patch's cells that are steeper than 28 degrees
  /// How far the foremost (most downwind) cells of the outer thirds of the width, the lesser of the two
  /// sides, lie downwind of the foremost cell of the middle third [m]; > 0: both horns point downwind.
  double horn_reach = 0;
  /// From the middle third's windward foot to the mean of the two horn tips.
  double horn_direction_deg = 0;
};

/// Dunes of at least `least_cells`, largest volume first. `elevation` is ground + sand.
std::vector<DuneShape> find_dunes(const Field& elevation, const Field& sand, double wind_deg,
                                  double threshold = 0.3, std::size_t least_cells = 30);

/// What lies upwind of a wall along one row of cells of an eastward wind.
struct WallFront {
  double lane = 0;         ///< from the wall to the first cell upwind with sand deeper than the threshold [m]
  double dune_height = 0;  ///< greatest depth within `reach` upwind [m]
  double dune_distance = 0;  ///< of that depth from the wall [m]
};

/// Means over the rows (of cells) y0 ≤ y < y1, with the wall's windward cell at `wall_x(y)`: the first cell,
/// going east from x = 0, where `wall` > 0.
WallFront wall_front(const Field& sand, const Field& wall, int y0, int y1, double threshold, double reach);

}  // namespace desert_sim
