#pragma once
/// Correlations of reliefs, and what follows from them: the wavelength of a pattern and its motion.

#include <optional>

#include "src/metrics/field.hpp"

namespace desert_sim {

/// The correlation of two fields h and g of one grid at all lags d,
///
///   C(d) = Σ_x (h(x) − h̄) (g(x + d) − ḡ) / √(Σ (h − h̄)² · Σ (g − ḡ)²),
///
/// by Fourier transforms. Periodic fields are wrapped; otherwise sums and means are those of the cells that
/// overlap (Lewis 1995, Fast normalized cross-correlation).
class Correlation {
 public:
  /// Throws ConfigError unless both fields have the same grid and borders.
  Correlation(const Field& h, const Field& g);
  /// At a lag of whole cells. |x| < width, |y| < height. 0 where a field does not vary.
  double at(int x, int y) const;
  /// Bilinear between them.
  double sample(double x, double y) const;

 private:
  /// Of rectangle_sums(): over the cells that overlap at the lag (x, y), on its side of the grid.
  double overlap(const std::vector<double>& sums, int x, int y) const;

  int width_, height_;
  bool periodic_;
  double norm_ = 0;
  Field products_;  ///< Σ of products of deviations, by wrapped lag; twice the size if not periodic
  std::vector<double> sums_h_, sums_g_, squares_h_, squares_g_;  ///< if not periodic
};

/// Distance of repetition along `direction_deg`: the first maximum of the autocorrelation after its first
/// zero, of a parabola through the greatest of the lags a cell apart [m]; none within half the grid: empty.
std::optional<double> wavelength(const Field& relief, double direction_deg);

/// How far a pattern has moved from one time to another.
struct Displacement {
  double x = 0, y = 0;     ///< [m]
  double correlation = 0;  ///< of the former relief, moved, with the latter: 1 if it has only moved
};

/// The lag of the greatest correlation within a quarter of the grid, of a parabola along x and along y. A
/// pattern that repeats has to move by less than half its wavelength, because farther motions look like
/// shorter ones. Empty where the greatest correlation is below `least_correlation`, or lies at the rim of the
/// lags that are searched.
std::optional<Displacement> displacement(const Field& before, const Field& after,
                                         double least_correlation = 0.5);

}  // namespace desert_sim
