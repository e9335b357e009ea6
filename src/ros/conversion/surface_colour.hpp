#pragma once
/// The colour of the surface in point clouds: that of its material, shaded by the sun.

#include <vector>

#include "src/render/colour.hpp"
#include "src/simulation/simulation.hpp"

namespace desert_sim {

class SurfaceColour {
 public:
  /// Keeps a reference to the snapshot. Slopes are central differences over 2 · `reach` cells.
  SurfaceColour(const Snapshot& snapshot, int reach);
  /// The colour at cell (x, y), of what src/render/terrain_colours.hpp says: of the ground with the plants of
  /// their species, and the water on it; all are shaded.
  render::Colour at(int x, int y) const;

 private:
  render::Colour material(std::size_t i) const;
  render::Colour light(int x, int y) const;

  const Snapshot& s_;
  const int reach_;
  const std::vector<float>*elevation_, *sand_, *soil_, *water_, *vegetation_, *plants_, *obstacle_;
};

}  // namespace desert_sim
