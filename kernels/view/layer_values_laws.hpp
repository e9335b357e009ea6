#pragma once
/// The laws of layer_values.hpp, cell by cell.

#include "kernels/backend/for_each.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/surface_laws.hpp"
#include "kernels/view/layer_values.hpp"

namespace desert_sim::layer_values {

/// A layer that is not in use is null, and 0.
struct Stored {
  const Quanta* quanta;
  const float* real;
  Metres metres;
  DESERT_HD float operator()(int i) const { return quanta ? metres(quanta[i]) : value_or_zero(real, i); }
};

/// The layer `elevation`, which no step fills, without it.
struct Surface {
  surface::SolidHeight height;
  Metres metres;
  DESERT_HD float operator()(int i) const { return metres(height(i)); }
};

}  // namespace desert_sim::layer_values
