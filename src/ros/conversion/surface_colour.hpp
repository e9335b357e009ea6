#pragma once
/// The colour of the surface in point clouds: that of its material, shaded by the sun.

#include <vector>

#include "src/simulation/simulation.hpp"

namespace desert_sim {

struct Colour {
  float r = 0, g = 0, b = 0;  ///< 0…1
};

/// The colour of water of this depth [m], without shading.
Colour water_colour(float depth);

class SurfaceColour {
 public:
  /// Keeps a reference to the snapshot. Slopes are central differences over 2 · `reach` cells.
  SurfaceColour(const Snapshot& snapshot, int reach);
  /// The colour at cell (x, y): sand is warm, soil brown and rock grey-brown where sand is thin, plants have
  /// the colour of their species, water is blue by depth, obstacles are violet; all are shaded.
  Colour at(int x, int y) const;

 private:
  Colour material(std::size_t i) const;
  Colour plants(std::size_t i) const;
  float light(int x, int y) const;

  const Snapshot& s_;
  const int reach_;
  const std::vector<float>*elevation_, *sand_, *soil_, *water_, *vegetation_, *plants_, *obstacle_;
};

}  // namespace desert_sim
