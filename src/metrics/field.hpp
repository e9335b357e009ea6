#pragma once
/// Height fields and their elementary measures. Fields are row-major from the south-west; directions are in
/// degrees, counter-clockwise from +x.

#include <cstddef>
#include <vector>

namespace desert_sim {

constexpr double degree = 3.14159265358979323846 / 180.0;  ///< [rad]

/// i brought to 0…n − 1 by whole turns.
constexpr int wrapped(int i, int n) { return ((i % n) + n) % n; }

/// Of the vector (x, y) [deg].
double direction_of(double x, double y);

/// A scalar field on square cells [m].
struct Field {
  int width = 0, height = 0;
  double cell_size = 1;  ///< [m]
  bool periodic = true;
  std::vector<float> values;

  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y) * width + x; }
  /// The cell at (x, y) through periodic borders; beyond closed ones the edge goes on.
  std::size_t nearest(int x, int y) const;
  float at(int x, int y) const { return values[nearest(x, y)]; }
  /// Bilinear value at (x, y) in cells, cell centres at whole numbers.
  double sample(double x, double y) const;
};

/// Where a parabola through three values, a cell apart, has its top, from the middle one [cells]; within half
/// a cell.
double parabola_top(double before, double middle, double after);

/// Gaussian smoothing with `sigma` metres.
Field smoothed(const Field& field, double sigma);

/// Root mean square of the height about its mean [m].
double roughness(const Field& elevation);

/// Slope of each cell by central differences [deg], and the direction it falls to [deg].
struct Slopes {
  std::vector<float> slope_deg, direction_deg;
};
Slopes slopes(const Field& elevation);

/// Shares of cells with slopes in [0, width), [width, 2 width)… up to 90 degrees.
std::vector<double> slope_histogram(const Field& elevation, double bin_deg);

/// Smallest angle between two directions, 0…180.
double angle_between_deg(double a, double b);
/// Smallest angle between two undirected lines, 0…90.
double line_angle_between_deg(double a, double b);

/// The `share`-quantile (0…1) of values; 0 of none.
double quantile(std::vector<double> values, double share);

}  // namespace desert_sim
