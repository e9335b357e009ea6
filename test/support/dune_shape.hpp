#pragma once
/// Measures dunes, crests and ridges on height fields, from their definitions. Fields are row-major from the
/// south-west; directions are in degrees, counter-clockwise from +x; winds name where the air moves to.

#include <cstddef>
#include <vector>

namespace desert_sim {

/// A scalar field on square cells [m].
struct Field {
  int width = 0, height = 0;
  double cell_size = 1;  ///< [m]
  bool periodic = true;
  std::vector<float> values;

  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y) * width + x; }
  /// Value of a cell, through periodic borders; beyond closed ones the edge goes on.
  float at(int x, int y) const;
  /// Bilinear value at (x, y) in cells, cell centres at whole numbers.
  double sample(double x, double y) const;
};

// ---- angles
// --------------------------------------------------------------------------------------------------------

/// Smallest angle between two directions, 0…180.
double angle_between_deg(double a, double b);
/// Smallest angle between two undirected lines, 0…90.
double line_angle_between_deg(double a, double b);

// ---- separate dunes
// ------------------------------------------------------------------------------------------------

/// One dune: a connected patch (8 neighbours) of sand deeper than a threshold. "Along" and "across" are seen
/// from the wind; positions are metres from the south-west corner, of periodic fields unwrapped around the
/// patch.
struct Dune {
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
std::vector<Dune> find_dunes(const Field& elevation, const Field& sand, double wind_deg,
                             double threshold = 0.3, std::size_t least_cells = 30);

/// The `share`-quantile (0…1) of values; 0 of none.
double quantile(std::vector<double> values, double share);

// ---- patterns of crests
// --------------------------------------------------------------------------------------------

struct Orientation {
  double crest_deg = 0;  ///< direction along crests or ridges, 0…180
  double coherence = 0;  ///< 0: no direction … 1: all gradients parallel
};

/// From the structure tensor Σ ∇h ∇hᵀ of the field smoothed by a Gaussian of `sigma` metres.
Orientation crest_orientation(const Field& elevation, double sigma);

/// Distance of repetition along `direction_deg`: the first maximum of the autocorrelation after its first
/// zero [m]; 0 if there is none within half the grid.
double wavelength(const Field& elevation, double direction_deg);

/// Root mean square of the height about its mean [m].
double roughness(const Field& elevation);

// ---- slopes
// --------------------------------------------------------------------------------------------------------

/// Slope of each cell by central differences [deg], and the direction it falls to [deg].
struct Slopes {
  std::vector<float> slope_deg, direction_deg;
};
Slopes slopes(const Field& elevation);

/// Shares of cells with slopes in [0, width), [width, 2 width)… up to 90 degrees.
std::vector<double> slope_histogram(const Field& elevation, double bin_deg);

/// Directions that slip faces (cells from 28 degrees) fall to: maxima of their distribution within ±15
/// degrees that hold at least `least_share` of the slip faces and lie 45 degrees or more apart; most frequent
/// first.
std::vector<double> slip_face_directions(const Field& elevation, double least_share = 0.08);

// ---- spectra
// -------------------------------------------------------------------------------------------------------

/// Power of mode `mode` (cycles a grid) along x, or along y, over the geometric mean of the four modes beside
/// it; powers are summed over fields of one size and over their rows (columns). About 1 in a smooth spectrum.
/// 2 < mode.
double mode_excess(const std::vector<Field>& fields, bool along_x, int mode);

/// The greatest mode_excess() of the modes of `period` cells and half and a third of it that the grid holds.
double imprint(const std::vector<Field>& fields, int period);

/// The greatest mode_excess() of all other modes in the same range: what chance makes of such fields.
double imprint_by_chance(const std::vector<Field>& fields, int period);

// ---- in front of walls
// ---------------------------------------------------------------------------------------------

/// What lies upwind of a wall along one row of cells of an eastward wind.
struct WallFront {
  double lane = 0;         ///< from the wall to the first cell upwind with sand deeper than the threshold [m]
  double dune_height = 0;  ///< greatest depth within `reach` upwind [m]
  double dune_distance = 0;  ///< of that depth from the wall [m]
};

/// Means over the rows (of cells) y0 ≤ y < y1, with the wall's windward cell at `wall_x(y)`: the first cell,
/// going east from x = 0, where `wall` > 0.
WallFront wall_front(const Field& sand, const Field& wall, int y0, int y1, double threshold, double reach);

/// Gaussian smoothing with `sigma` metres.
Field smoothed(const Field& field, double sigma);

}  // namespace desert_sim
