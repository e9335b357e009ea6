#pragma once
/// Laws of layer_values.hpp.

#include "kernels/backend/for_each.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/surface_laws.hpp"
#include "kernels/view/layer_values.hpp"

namespace desert_sim::layer_values {

/// Value of a stored layer; 0 if both pointers are null because the layer is not in use.
struct StoredLayer {
  const Quanta* quanta;
  const float* real;
  QuantaToMetres metres;
  DESERT_HD float operator()(int i) const { return quanta ? metres(quanta[i]) : value_or_zero(real, i); }
};

/// Value of the layer `elevation`, computed from the layers below it, because no step fills it.
struct Surface {
  surface::SolidHeight height;
  QuantaToMetres metres;
  DESERT_HD float operator()(int i) const { return metres(height(i)); }
};

}  // namespace desert_sim::layer_values
