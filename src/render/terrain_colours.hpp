#pragma once
/// The colours of the ground by its materials, and of water by its depth: the same in rviz, in point clouds
/// and in pictures.

#include <optional>

#include "src/render/palette.hpp"

namespace desert_sim::render {

/// What lies at one cell. What a terrain does not have, or what is unknown to the caller, is as below.
struct SurfaceMaterials {
  float sand = 0;                ///< share of what is below that it hides (cover_of_depth), 0…1
  float soil = 0;                ///< likewise, below the sand
  float resistance = 0.5f;       ///< of the rock to erosion, 0…1
  float moisture = 0;            ///< water in the ground, as a depth [m]
  float vegetation = 0;          ///< density of plants, 0…1
  float obstacle = 0;            ///< 1 where there is one
  std::optional<Colour> plants;  ///< colour of the species that grows here, if there is one
};

/// How much of what is below sand or soil of this depth [m] hides: nothing up to 2 cm, all from 12 cm on. NaN
/// counts as 0.
float cover_of_depth(float depth);

/// The colour of the ground without light. Rock is the darker and redder the more it resists, and moist
/// ground is darker. NaN counts as 0.
Colour ground_colour(const SurfaceMaterials& materials, const Palette& palette = {});

/// The colour of water of this depth [m], without light.
Colour water_colour(float depth, const Palette& palette = {});
/// How much of the ground water of this depth [m] hides: 0 … 0.92.
float water_opacity(float depth);

/// The colour of the wind: blue up to half the speed high above the ground, near white at that speed, red
/// from one and a half times on. `relative`: the speed divided by the one high above.
Colour wind_colour(float relative);

/// The walls where a terrain ends, as those of a block diagram.
constexpr Colour cut_colour{0.42f, 0.36f, 0.31f};
/// Unknown ground in pictures.
constexpr Colour unknown_colour{215 / 255.0f, 215 / 255.0f, 215 / 255.0f};

/// 0 up to `from`, 1 from `to` on, with a smooth curve between.
float smooth_step(float from, float to, float value);

}  // namespace desert_sim::render
