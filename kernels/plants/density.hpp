#pragma once
/// Density of a plant at a point. Nilles 2025 §3.2.1, eq. 6–7.
///
///   D = max(exp(−½ (d²/σ² + z²/σ_z²)) − e⁻² d/r, 0)
///   σ = r/2,   σ_z = r h_s/2 where z > 0, r h_r/2 below
///
/// d is the horizontal distance, z the height above the point where stem and root meet, h_s and h_r are
/// `stem` and `root`. This is a split Gaussian that is exactly 0 at the plant's own radius. (The covariance
/// printed in the paper is 16 times as wide.)

#include "kernels/base/math.hpp"
#include "kernels/plants/species.hpp"

namespace desert_sim::plants {

/// `distance2`: d² [m²]; `above`: z [m]; `radius`: r > 0 [m].
DESERT_HD float density_at(float distance2, float above, float radius, float stem, float root) {
  const float radius2 = radius * radius;
  if (!(distance2 < radius2)) return 0.0f;
  const float half_height = radius * (above > 0.0f ? stem : root);
  const float relative_height = above / half_height;
  const float full = exp_negative(2.0f * (distance2 / radius2 + relative_height * relative_height));
  return maximum(full - 0.13533528f * (sqrtf(distance2) / radius), 0.0f);
}

DESERT_HD bool is_mature(const SpeciesTraits& s, float radius) {
  return radius >= s.maturity_share * s.max_radius;
}

}  // namespace desert_sim::plants
