/// Laws and functions of surface.hpp; compiled once for each backend.
#include "kernels/field/surface.hpp"

#include "kernels/backend/loops.hpp"
#include "kernels/field/surface_laws.hpp"

namespace desert_sim::surface {

/// Writes the solid surface to the layer elevation.
struct SolidSurface {
  Grid grid;
  SolidHeight height;
  Quanta* elevation;

  explicit SolidSurface(const TerrainView& t)
      : grid(t.grid), height(t), elevation(t.quanta(Layer::elevation)) {}
  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    elevation[i] = height(i);
  }
};

template <class E>
void fill_elevation(E& exec, const TerrainView& terrain) {
  for_each_cell(exec, terrain.grid, SolidSurface(terrain));
}

/// Writes elevation + water to the layer water_surface.
struct WaterSurface {
  Grid grid;
  SolidHeight height;
  const Quanta* water;
  Quanta* surface;

  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    surface[i] = height(i) + value_or_zero(water, i);
  }
};

template <class E>
void fill_water_surface(E& exec, const TerrainView& t, int first, int rows) {
  for_each_cell_of_rows(
      exec, t.grid, first, rows,
      WaterSurface{t.grid, SolidHeight(t), t.quanta(Layer::water), t.quanta(Layer::water_surface)});
}

template <class E>
void compute_heights(E& exec, const TerrainView& t, Heights& heights) {
  for_each_cell(exec, heights.blocks, make_heights_law(t, heights));
}

template void fill_elevation(Backend&, const TerrainView&);
template void fill_water_surface(Backend&, const TerrainView&, int, int);
template void compute_heights(Backend&, const TerrainView&, Heights&);

}  // namespace desert_sim::surface
