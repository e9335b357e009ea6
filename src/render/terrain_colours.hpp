#pragma once
/// The colours of the ground by its materials, of water by its depth, and the light of the sun: the same in rviz, in
/// point clouds and in pictures.

#include "src/render/colour.hpp"

namespace desert_sim::render {

/// What lies at one cell. What a terrain does not have, or what is unknown to the caller, is as below.
struct SurfaceMaterials {
  float sand = 0;                      ///< depth [m]
  float soil = 0;                      ///< depth, below the sand [m]
  float resistance = 0.5f;             ///< of the rock to erosion, 0…1
  float moisture = 0;                  ///< water in the ground, as a depth [m]
  float vegetation = 0;                ///< density of plants, 0…1
  float obstacle = 0;                  ///< 1 where there is one
  Colour plants{0.27f, 0.48f, 0.20f};  ///< colour of the species that grows here
};

/// The colour of the ground without light. Thin sand and soil (under 2 cm) show what is below, thick ones (over 12 cm)
/// hide it. Rock is the darker and redder the more it resists, and moist ground is darker. NaN counts as 0.
Colour ground_colour(const SurfaceMaterials& materials);

/// The colour of water of this depth [m], without light.
Colour water_colour(float depth);
/// How much of the ground water of this depth [m] hides: 0 … 0.92.
float water_opacity(float depth);

/// Unknown ground in pictures.
constexpr Colour unknown_colour{0.84f, 0.84f, 0.84f};

/// 0 up to `from`, 1 from `to` on, with a smooth curve between.
float smooth_step(float from, float to, float value);

}  // namespace desert_sim::render
