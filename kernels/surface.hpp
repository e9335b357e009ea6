#pragma once
/// The solid surface, h = b + e + s, that wind, shadow and echo dunes look at.
/// Reads bedrock, soil, sand; writes elevation.

#include "desert_sim/kernels/for_each.hpp"
#include "desert_sim/kernels/layers.hpp"

namespace desert_sim::surface {

struct SolidSurface {
  Grid grid;
  const Quanta *bedrock, *soil, *sand;
  Quanta* elevation;

  explicit SolidSurface(const TerrainView& t)
      : grid(t.grid),
        bedrock(t.quanta(Layer::bedrock)),
        soil(t.quanta(Layer::soil)),
        sand(t.quanta(Layer::sand)),
        elevation(t.quanta(Layer::elevation)) {}

  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    elevation[i] = bedrock[i] + value_or_zero(soil, i) + sand[i];
  }
};

template <class E>
void step(E& exec, const TerrainView& terrain) {
  for_each_cell(exec, terrain.grid, SolidSurface(terrain));
}

}  // namespace desert_sim::surface
