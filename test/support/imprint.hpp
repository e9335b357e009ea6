#pragma once
/// Whether a period stands out in the spectrum of a field.

#include "src/metrics/field.hpp"

namespace desert_sim {

/// Power of mode `mode` (cycles a grid) along x, or along y, over the geometric mean of the four modes beside
/// it; powers are summed over fields of one size and over their rows (columns). About 1 in a smooth spectrum.
/// 2 < mode.
double mode_excess(const std::vector<Field>& fields, bool along_x, int mode);

/// The greatest mode_excess() of the modes of `period` cells and half and a third of it that the grid holds.
double imprint(const std::vector<Field>& fields, int period);

/// The greatest mode_excess() of all other modes in the same range: what chance makes of such fields.
double imprint_by_chance(const std::vector<Field>& fields, int period);

}  // namespace desert_sim
