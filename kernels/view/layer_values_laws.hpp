#pragma once
/// Laws of layer_values.hpp: the value of a cell, by the way in which a layer has it.

#include "kernels/backend/for_each.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/surface_laws.hpp"
#include "kernels/view/layer_values.hpp"

namespace desert_sim::layer_values {

/// Value of a layer of quanta that is in use.
struct StoredQuanta {
  static constexpr bool may_be_nan = false;
  const Quanta* quanta;
  QuantaToMetres metres;
  DESERT_HD float operator()(int i) const { return metres(quanta[i]); }
};

/// Value of a layer of floats; 0 if the pointer is null because the layer is not in use.
struct StoredReal {
  static constexpr bool may_be_nan = true;
  const float* real;
  DESERT_HD float operator()(int i) const { return value_or_zero(real, i); }
};

/// Value of the layer `elevation`, computed from the layers below it, because no step fills it.
struct Surface {
  static constexpr bool may_be_nan = false;
  surface::SolidHeight height;
  QuantaToMetres metres;
  DESERT_HD float operator()(int i) const { return metres(height(i)); }
};

/// Calls body(values) with the one of these that has the layer.
template <class Body>
void with_values(const TerrainView& t, Layer layer, const QuantaToMetres& metres, const Body& body) {
  const bool counted = info(layer).storage == Storage::quanta;
  if (layer == Layer::elevation)
    body(Surface{surface::SolidHeight(t), metres});
  else if (counted && t.quanta(layer))
    body(StoredQuanta{t.quanta(layer), metres});
  else
    body(StoredReal{counted ? nullptr : t.real(layer)});
}

}  // namespace desert_sim::layer_values
