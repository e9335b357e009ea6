#pragma once
/// The environment of a plant in the cell where it stands.

#include "kernels/base/math.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/plants/species.hpp"
#include "kernels/sand/repose.hpp"

namespace desert_sim::plants {

/// The ground along roots and stem, as shares of their length.
struct Ground {
  float soil, sand;              ///< of the roots
  float root_cover, stem_cover;  ///< shares that are in the ground
};

struct Site {
  Grid grid;
  const Quanta *bedrock, *soil, *sand, *water;
  const float *obstacle, *heights;  ///< heights of the surface [quanta]
  float quantum, quanta_per_metre;
  repose::RelativeMoisture relative_moisture;

  Site(const TerrainView& t, const ReposeParameters& repose, const float* heights_of_cells)
      : grid(t.grid),
        bedrock(t.quanta(Layer::bedrock)),
        soil(t.quanta(Layer::soil)),
        sand(t.quanta(Layer::sand)),
        water(t.quanta(Layer::water)),
        obstacle(t.real(Layer::obstacle)),
        heights(heights_of_cells),
        quantum(t.quantum),
        quanta_per_metre(t.quanta_per_metre),
        relative_moisture(t, repose) {}

  DESERT_HD int cell(float x, float y) const {
    return grid.index(clamp_index(static_cast<int>(x / grid.cell_size), grid.width),
                      clamp_index(static_cast<int>(y / grid.cell_size), grid.height));
  }
  DESERT_HD Quanta surface(int i) const { return bedrock[i] + value_or_zero(soil, i) + sand[i]; }
  DESERT_HD float water_depth(int i) const { return static_cast<float>(value_or_zero(water, i)) * quantum; }
  /// Depth of soil and sand [m].
  DESERT_HD float loose_depth(int i) const {
    return static_cast<float>(value_or_zero(soil, i) + sand[i]) * quantum;
  }

  /// Rise over run, by central differences.
  DESERT_HD float slope(int i) const {
    const int x = i % grid.width, y = i / grid.width;
    const float per_metre = 0.5f * quantum / grid.cell_size;
    const float along_x = heights[sample_index(grid, x + 1, y)] - heights[sample_index(grid, x - 1, y)];
    const float along_y = heights[sample_index(grid, x, y + 1)] - heights[sample_index(grid, x, y - 1)];
    return hypotenuse(along_x * per_metre, along_y * per_metre);
  }

  /// The ground of a plant whose stem and root meet at z; `stem`, `root`: their lengths [quanta].
  DESERT_HD Ground ground(int i, Quanta z, float stem, float root) const {
    const float rock = static_cast<float>(bedrock[i] - z),
                below_sand = rock + static_cast<float>(value_or_zero(soil, i)),
                top = below_sand + static_cast<float>(sand[i]);  // relative to z
    const auto overlap = [&](float from, float to) {
      return maximum(minimum(to, 0.0f) - maximum(from, -root), 0.0f) / root;
    };
    return {overlap(rock, below_sand), overlap(below_sand, top), clamp((top + root) / root, 0.0f, 1.0f),
            clamp(top / stem, 0.0f, 1.0f)};
  }
};

DESERT_HD float ground_quality(const SpeciesTraits& s, const Ground& g) {
  return minimum(s.soil * g.soil + s.sand * g.sand, 1.0f);
}

DESERT_HD bool lives_under_water(const SpeciesTraits& s) { return s.water_resistance >= 1.0f; }

}  // namespace desert_sim::plants
