#pragma once
/// Measures patterns of crests: their direction, their distance, and whether a period stands out in their
/// spectrum.

#include "support/field.hpp"

namespace desert_sim {

struct Orientation {
  double crest_deg = 0;  ///< direction along crests or ridges, 0…180
  double coherence = 0;  ///< 0: no direction … 1: all gradients parallel
};

/// From the structure tensor Σ ∇h ∇hᵀ of the field smoothed by a Gaussian of `sigma` metres.
Orientation crest_orientation(const Field& elevation, double sigma);

/// Distance of repetition along `direction_deg`: the first maximum of the autocorrelation after its first
/// zero [m]; 0 if there is none within half the grid.
double wavelength(const Field& elevation, double direction_deg);

/// Power of mode `mode` (cycles a grid) along x, or along y, over the geometric mean of the four modes beside
/// it; powers are summed over fields of one size and over their rows (columns). About 1 in a smooth spectrum.
/// 2 < mode.
double mode_excess(const std::vector<Field>& fields, bool along_x, int mode);

/// The greatest mode_excess() of the modes of `period` cells and half and a third of it that the grid holds.
double imprint(const std::vector<Field>& fields, int period);

/// The greatest mode_excess() of all other modes in the same range: what chance makes of such fields.
double imprint_by_chance(const std::vector<Field>& fields, int period);

}  // namespace desert_sim
