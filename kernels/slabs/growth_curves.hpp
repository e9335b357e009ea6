#pragma once
/// How plants answer to a year's burial in the slab model of Nield & Baas 2008: growth curves, which are
/// linear between points and constant beyond the first and the last.

#include "kernels/base/macros.hpp"

namespace desert_sim {

struct GrowthCurve {
  static constexpr int capacity = 8;
  float burial[capacity] = {};  ///< ascending [m/year]
  float growth[capacity] = {};  ///< change of the effectiveness [1/year]
  int count = 0;                ///< points, 2 … capacity

  /// The change in a year of so much burial [m].
  DESERT_HD float at(float buried) const {
    if (buried <= burial[0]) return growth[0];
    for (int n = 1; n < count; ++n)
      if (buried <= burial[n]) {
        const float share = (buried - burial[n - 1]) / (burial[n] - burial[n - 1]);
        return growth[n - 1] + share * (growth[n] - growth[n - 1]);
      }
    return growth[count - 1];
  }
};

/// In the order of the layers grass, mesquite, shrub.
struct GrowthCurves {
  static constexpr int kinds = 3;
  GrowthCurve of[kinds];
};
constexpr const char* growth_curve_names[GrowthCurves::kinds] = {"grass", "mesquite", "shrub"};

}  // namespace desert_sim
