#pragma once
/// Angles of repose of sand, soil and bedrock, which reptation and avalanching share. Nilles 2024 §3.8 for
/// vegetation; Nilles 2025 §3.3.2 for soil and moisture.
///
///   tan θ = lerp(tan θ_bare, tan θ_vegetated, v) · f(m)
///   f(m)  = 1.5 + 0.5 M    where M ≤ 0,   M = 2 m − 1
///   f(m)  = 1.5 − 1.35 M   where M > 0                  (dry 1, half saturated 1.5, saturated 0.15)
///
/// Relative moisture m is the moisture over the ground's capacity, `moisture_capacity` · min(e + s, 1 m),
/// with the depths e of soil and s of sand. Bedrock has one angle everywhere.

#include "kernels/base/math.hpp"
#include "kernels/field/layers.hpp"
#include "src/core/constants.hpp"
#include "src/core/parameter_table.hpp"

namespace desert_sim {

struct ReposeParameters {
  float sand_deg = 33.0f;
  float vegetated_deg = 45.0f;
  float soil_deg = 45.0f;
  float soil_vegetated_deg = 68.0f;
  float bedrock_deg = 68.0f;
  float moisture_capacity = 0.3f;
};

constexpr auto parameter_table(const ReposeParameters*) {
  using P = ReposeParameters;
  return std::make_tuple(
      parameter("sand_deg", &P::sand_deg, 1, 80, "deg", "Angle of repose of dry bare sand."),
      parameter("vegetated_deg", &P::vegetated_deg, 1, 80, "deg",
                "Angle of repose of sand under full vegetation."),
      parameter("soil_deg", &P::soil_deg, 1, 85, "deg", "Angle of repose of bare soil."),
      parameter("soil_vegetated_deg", &P::soil_vegetated_deg, 1, 85, "deg",
                "Angle of repose of soil under full vegetation."),
      parameter("bedrock_deg", &P::bedrock_deg, 1, 89, "deg", "Angle at which bedrock breaks."),
      parameter("moisture_capacity", &P::moisture_capacity, 0.001, 1, "1",
                "Water that a metre of ground can hold, as a depth in metres."));
}
static_assert(table_is_complete<ReposeParameters>());

namespace repose {

/// Moisture of the ground relative to its capacity, 0 … 1; 0 where the layer `moisture` is not in use. Ground
/// shallower than 1 mm has the capacity of 1 mm.
struct RelativeMoisture {
  const Quanta *moisture, *soil, *sand;
  float capacity, quantum;

  RelativeMoisture(const TerrainView& t, const ReposeParameters& p)
      : moisture(t.quanta(Layer::moisture)),
        soil(t.quanta(Layer::soil)),
        sand(t.quanta(Layer::sand)),
        capacity(p.moisture_capacity),
        quantum(t.quantum) {}

  DESERT_HD float operator()(int i) const {
    if (!moisture || moisture[i] <= 0) return 0.0f;
    const float ground = static_cast<float>(value_or_zero(soil, i) + sand[i]) * quantum;
    return minimum(moisture[i] * quantum / (capacity * maximum(minimum(ground, 1.0f), 1e-3f)), 1.0f);
  }
};

DESERT_HD float moisture_factor(float relative_moisture) {
  const float m = 2.0f * relative_moisture - 1.0f;
  return m <= 0.0f ? 1.5f + 0.5f * m : 1.5f - 1.35f * m;
}

/// Tangents of the angles, computed once a step on the host.
struct Tangents {
  float sand, vegetated, soil, soil_vegetated, bedrock;

  explicit Tangents(const ReposeParameters& p)
      : sand(tangent(p.sand_deg)),
        vegetated(tangent(p.vegetated_deg)),
        soil(tangent(p.soil_deg)),
        soil_vegetated(tangent(p.soil_vegetated_deg)),
        bedrock(tangent(p.bedrock_deg)) {}
  static float tangent(float degrees) { return static_cast<float>(std::tan(degrees * pi / 180.0)); }
};

}  // namespace repose
}  // namespace desert_sim
