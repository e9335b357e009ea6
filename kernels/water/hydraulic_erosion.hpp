#pragma once
/// Hydraulic erosion: flowing water dissolves ground into sediment up to its transport capacity, and deposits
/// the sediment above it. Mei 2007; Nilles 2025 §3.4.1.
///
///   capacity    C = k_c max(sin α, `least_slope`) |U| (1 − h v) · min(a + (1 − a) w/d, 1) · e^(−w/`deep`)
///   dissolve    S += min(K Δt, 1) (C − S)             where S < C
///               K = K_sand, K_soil where there is no sand, K_rock (1 − ρ) where there is neither
///   deposit     S −= min(K_d (1 + t v) Δt, 1) (S − C)   where S > C, as sand; all of S on dry ground
///   transport   S moves with the water: sediment_transport.hpp
///
/// C and S (suspended_sediment) are depths of sediment [m], α is the slope angle of the solid surface, U the
/// water's velocity, w its depth, a `shallow_share`, d `shallow_depth`, v vegetation, h `plant_hold`, t
/// `plant_trap`, ρ erosion_resistance. An obstacle itself does not dissolve; sand that settles on it does.
///
/// Reads bedrock, soil, sand, water, water_velocity_x, water_velocity_y, suspended_sediment, vegetation,
/// erosion_resistance, obstacle; writes bedrock, soil, sand, suspended_sediment.

#include "kernels/backend/buffer.hpp"
#include "kernels/field/dice.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/ledger.hpp"
#include "src/core/parameter_table.hpp"

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
  float shallow_share = 0.1f;
  float shallow_depth = 1.0f;
  float plant_hold = 0.5f;
  float plant_trap = 1.0f;
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
      parameter("deposit", &P::deposit, 0, 100, "1/s", "How fast what the water cannot carry falls."),
      parameter("shallow_share", &P::shallow_share, 0, 1, "1",
                "Share of the capacity that the shallowest water has."),
      parameter("shallow_depth", &P::shallow_depth, 0.001, 1000, "m",
                "Depth from which water has all of it; in between the share is linear."),
      parameter("plant_hold", &P::plant_hold, 0, 1, "1",
                "Share by which full vegetation lessens the capacity (Nilles 2025: 1/2)."),
      parameter(
          "plant_trap", &P::plant_trap, 0, 100, "1",
          "How much faster, in parts of `deposit`, sediment falls under full vegetation (Nilles 2025: 1, "
          "twice as fast)."));
}
static_assert(table_is_complete<HydraulicErosionParameters>());

namespace hydraulic_erosion {

struct Workspace {
  Buffer<float> capacity;  ///< [m of sediment]
  std::size_t bytes() const { return capacity.bytes(); }
};

template <class E>
void step(E& exec, const TerrainView& t, const HydraulicErosionParameters& p, float time_step,
          const Dice& dice, LedgerView ledger, Workspace& work);

}  // namespace hydraulic_erosion
}  // namespace desert_sim
