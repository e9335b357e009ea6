#pragma once
/// Values of layers for output: floats in the layer's unit.

#include "kernels/backend/exec.hpp"
#include "kernels/field/layers.hpp"

namespace desert_sim {

/// Converts quanta to metres, rounded once, so that all backends give the same bits.
struct QuantaToMetres {
  double quantum = 1, datum = 0;
  DESERT_HD float operator()(Quanta quanta) const { return static_cast<float>(datum + quanta * quantum); }
};

namespace layer_values {

/// Writes the values of rows first … first + rows − 1 of a layer, row-major, to `to` on the device. Rows
/// continue in the south beyond the north edge.
template <class E>
void step(E& exec, const TerrainView& t, Layer layer, const QuantaToMetres& metres, int first, int rows,
          float* to);

}  // namespace layer_values
}  // namespace desert_sim
