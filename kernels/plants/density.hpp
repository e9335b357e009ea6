#pragma once
/// How dense a plant is at a place. Nilles 2025 eq. 6 and 7; physics.md D.
///
///   D = max(exp(−½ (d²/σ² + z²/σ_z²)) − e⁻² d/r, 0),   σ = r/2,   σ_z = r·stem/2 above, r·root/2 below
///
/// with d the horizontal distance and z how far the place is above where stem and root meet: a Gaussian split
/// there, which is exactly 0 at the plant's own radius.

#include "kernels/field/math.hpp"
#include "kernels/plants/species.hpp"

namespace desert_sim::plants {

/// `distance2` [m²], `above` [m], radius [m] > 0.
DESERT_HD float density_at(float distance2, float above, float radius, float stem, float root) {
  const float radius2 = radius * radius;
  if (!(distance2 < radius2)) return 0.0f;
  const float half_height = radius * (above > 0.0f ? stem : root);
  const float upright = above / half_height;
  const float full = exp_negative(2.0f * (distance2 / radius2 + upright * upright));
  return maximum(full - 0.13533528f * (sqrtf(distance2) / radius), 0.0f);
}

DESERT_HD bool is_mature(const SpeciesTraits& s, float radius) {
  return radius >= s.maturity_share * s.max_radius;
}

}  // namespace desert_sim::plants
