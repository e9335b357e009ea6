#pragma once
/// Whether the tiles in which avalanches run show in the ground.

#include "src/metrics/field.hpp"

namespace desert_sim {

/// Mean square of the steps between neighbours across columns, by the columns' number modulo `period`
/// [cells], and the same across rows: by how much the greatest exceeds the mean of all, as a share of that
/// mean. Seams that stay keep cliffs, of which one class of columns or rows has all; ground that knows no
/// tiles has about 0.
double imprint(const std::vector<Field>& fields, int period);

}  // namespace desert_sim
