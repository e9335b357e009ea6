#pragma once
/// Flowing water wears the ground, carries it, and lets it fall. Mei 2007, Nilles 2025 §3.4; physics.md C3.
///
///   capacity   C = k_c max(sin α, floor) |U| (1 − ½ v) · min(0.1 + 0.9 w/1 m, 1) e^(−w/deep)   [m of
///   sediment] below it   sand, soil where there is no sand, rock where there is neither, go into the water:
///              K Δt (C − S), K by material, of rock · (1 − resistance)
///   above it   K_d (1 + v) Δt (S − C) falls, as sand; all of it where the ground is dry
///   transport  with the water: sediment_transport.hpp
///
/// α is the angle of the solid surface, U the water's velocity. Reads bedrock, soil, sand, water,
/// water_velocity_*, vegetation, erosion_resistance, obstacle; writes bedrock, soil, sand,
/// suspended_sediment.

#include "kernels/backend/buffer.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/ledger.hpp"
#include "src/core/parameters.hpp"

namespace desert_sim {

struct HydraulicErosionParameters {
  bool enabled = false;
  float capacity = 0.1f;
  float least_slope = 0.05f;
  float deep = 10.0f;
  float sand = 0.1f;
  float soil = 0.05f;
  float rock = 0.01f;
  float deposit = 0.1f;
};

constexpr auto parameter_table(const HydraulicErosionParameters*) {
  using P = HydraulicErosionParameters;
  return std::make_tuple(
      parameter("enabled", &P::enabled, "Whether flowing water wears the ground."),
      parameter("capacity", &P::capacity, 0, 100, "s",
                "Sediment that water can carry, as a depth, per m/s and slope (k_c)."),
      parameter("least_slope", &P::least_slope, 0, 1, "1",
                "Sine that counts as the least slope of the ground."),
      parameter("deep", &P::deep, 0.01, 1e4, "m",
                "Depth at which water carries 1/e of what the same flow would in shallow water."),
      parameter("sand", &P::sand, 0, 100, "1/s", "How fast sand goes into the water that could carry more."),
      parameter("soil", &P::soil, 0, 100, "1/s", "How fast soil does, where there is no sand on it."),
      parameter("rock", &P::rock, 0, 100, "1/s", "How fast bare rock does."),
      parameter("deposit", &P::deposit, 0, 100, "1/s", "How fast what the water cannot carry falls."));
}
static_assert(table_is_complete<HydraulicErosionParameters>());

namespace hydraulic_erosion {

struct Workspace {
  Buffer<float> capacity;  ///< [m of sediment]
};

template <class E>
void step(E& exec, const TerrainView& t, const HydraulicErosionParameters& p, float time_step,
          LedgerView ledger, Workspace& work);

}  // namespace hydraulic_erosion
}  // namespace desert_sim
