#pragma once
/// Layers as others see them: floats in the layer's unit.

#include "kernels/backend/for_each.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/surface.hpp"

namespace desert_sim {

/// What a number of quanta stands for [m]. Rounded once: the same bits on every backend.
struct Metres {
  double quantum = 1, datum = 0;
  DESERT_HD float operator()(Quanta quanta) const { return static_cast<float>(datum + quanta * quantum); }
};

namespace layer_values {

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

template <class Values>
struct Convert {
  Grid grid;
  Values values;
  int first;
  float* to;

  DESERT_HD void operator()(int x, int y) const {
    to[grid.index(x, y)] = values(grid.index(x, wrap(first + y, grid.height)));
  }
};

/// Writes the values of rows first … first + rows − 1 of a layer, row-major, to `to` on the device. Rows
/// beyond the north edge are those in the south.
template <class E>
void step(E& exec, const TerrainView& t, Layer layer, const Metres& metres, int first, int rows, float* to) {
  Grid band = t.grid;
  band.height = rows;
  if (layer == Layer::elevation)
    return for_each_cell(exec, band, Convert<Surface>{t.grid, {surface::SolidHeight(t), metres}, first, to});
  const bool counted = info(layer).storage == Storage::quanta;
  const Stored stored{counted ? t.quanta(layer) : nullptr, counted ? nullptr : t.real(layer), metres};
  for_each_cell(exec, band, Convert<Stored>{t.grid, stored, first, to});
}

}  // namespace layer_values
}  // namespace desert_sim
