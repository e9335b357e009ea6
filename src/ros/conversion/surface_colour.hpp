#pragma once
/// How the surface looks: the colour of its material, and its light.

#include <vector>

#include "src/simulation/simulation.hpp"

namespace desert_sim {

struct Colour {
  float r = 0, g = 0, b = 0;  ///< 0…1
};

/// Of water so deep [m], unlit.
Colour water_colour(float depth);

class SurfaceColour {
 public:
  /// Keeps a reference to the snapshot. `reach` [cells]: slopes are taken over twice as many.
  SurfaceColour(const Snapshot& snapshot, int reach);
  /// Sand warm, soil brown and rock grey-brown where sand is thin, plants in their species' colour, water
  /// blue by depth, obstacles violet; times the light.
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
