#pragma once
/// Angles of repose of sand, soil and bedrock, which reptation and avalanching share. Nilles 2024 §3.8 for
/// vegetation; Nilles 2025 §3.3.2 for soil and moisture.
///
///   tan θ = lerp(tan θ_bare, tan θ_vegetated, v) · f(m)
///   f(m)  = f_h + (f_h − 1) M     where M ≤ 0,   M = 2 m − 1
///   f(m)  = f_h − (f_h − f_s) M   where M > 0
///
/// f is 1 of dry ground, f_h = `half_wet` of half saturated and f_s = `saturated` of saturated ground.
/// Relative moisture m is the moisture over the ground's capacity, c_M min(e + s, d_M), with the depths e
/// of soil and s of sand, c_M = `moisture_capacity` and d_M = `moisture_depth`. Bedrock has one angle
/// everywhere.

#include "kernels/base/math.hpp"
#include "kernels/field/layers.hpp"
#include "src/core/elementary.hpp"
#include "src/core/parameter_table.hpp"

namespace desert_sim {

struct ReposeParameters {
  float sand_deg = 33.0f;
  float vegetated_deg = 45.0f;
  float soil_deg = 45.0f;
  float soil_vegetated_deg = 68.0f;
  float bedrock_deg = 68.0f;
  float moisture_capacity = 0.3f;
  float moisture_depth = 1.0f;
  float half_wet = 1.5f;
  float saturated = 0.15f;
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
                "Water that a metre of ground can hold, as a depth in metres."),
      parameter("moisture_depth", &P::moisture_depth, 0.01, 100, "m",
                "Depth down to which ground holds moisture (Nilles 2025: 1 m)."),
      parameter(
          "half_wet", &P::half_wet, 0.1, 10, "1",
          "Tangent of the angles of half-wet sand and soil over that of dry (Nilles 2025: slightly more, "
          "most at 50 %)."),
      parameter(
          "saturated", &P::saturated, 0.001, 10, "1",
          "Tangent of the angles of saturated sand and soil over that of dry (Nilles 2025: nearly 0)."));
}
static_assert(table_is_complete<ReposeParameters>());

namespace repose {

/// Ground that is shallower has the capacity of this depth, so that none divides by 0 [m].
constexpr float least_moist_depth = 1e-3f;

/// Moisture of the ground relative to its capacity, 0 … 1; 0 where the layer `moisture` is not in use.
struct RelativeMoisture {
  const Quanta *moisture, *soil, *sand;
  float capacity, deepest, quantum;

  RelativeMoisture(const TerrainView& t, const ReposeParameters& p)
      : moisture(t.quanta(Layer::moisture)),
        soil(t.quanta(Layer::soil)),
        sand(t.quanta(Layer::sand)),
        capacity(p.moisture_capacity),
        deepest(p.moisture_depth),
        quantum(t.quantum) {}

  DESERT_HD float operator()(int i) const {
    if (!moisture || moisture[i] <= 0) return 0.0f;
    const float ground = static_cast<float>(value_or_zero(soil, i) + sand[i]) * quantum;
    const float moist = maximum(minimum(ground, deepest), least_moist_depth);
    return minimum(moisture[i] * quantum / (capacity * moist), 1.0f);
  }
};

/// f(m).
struct MoistureFactor {
  float half_wet, gain, loss;

  explicit MoistureFactor(const ReposeParameters& p)
      : half_wet(p.half_wet), gain(p.half_wet - 1.0f), loss(p.half_wet - p.saturated) {}
  DESERT_HD float operator()(float relative_moisture) const {
    if (!(relative_moisture > 0.0f)) return 1.0f;
    const float m = 2.0f * relative_moisture - 1.0f;
    return m <= 0.0f ? half_wet + gain * m : half_wet - loss * m;
  }
};

/// Tangents of the angles and what moisture makes of them, computed once a step on the host.
struct Tangents {
  float sand, vegetated, soil, soil_vegetated, bedrock;
  MoistureFactor moisture_factor;

  explicit Tangents(const ReposeParameters& p)
      : sand(tangent(p.sand_deg)),
        vegetated(tangent(p.vegetated_deg)),
        soil(tangent(p.soil_deg)),
        soil_vegetated(tangent(p.soil_vegetated_deg)),
        bedrock(tangent(p.bedrock_deg)),
        moisture_factor(p) {}
  static float tangent(float degrees) { return static_cast<float>(elementary::tan_deg(degrees)); }
};

}  // namespace repose
}  // namespace desert_sim
