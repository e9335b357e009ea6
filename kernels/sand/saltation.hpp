#pragma once
/// Saltation: the wind lifts sand, carries it a hop, and a share of it is deposited where it lands; the rest
/// bounces on. Expected values replace random events. Nilles 2024 §3.6, eq. 5; Nilles 2025 §3.3.2 for soil,
/// moisture and water.
///
///   lift      L = min(s, T (ε_s (1 − r_s)(1 − v)(r_e > 0 ? k_s : 1) M + (r_e < 0 ? k_e : 0)))
///             M = clamp(1 − m/m_c, 0, 1), and 0 under water
///             s ← s − φ L
///             c = s − (1 − φ) L, the sand that L leaves on the ground
///   advect    φ (a + L) moves by w T / l cells and is scattered bilinearly to the four cells around; the
///             rest of a waits. Of what lands in a cell, a binomial kernel of the standard deviation
///             `hop_spread`, at most 0.7 l, takes shares to its eight neighbours: hops differ in length.
///   deposit   p = clamp(max(r_s, (1 − f) + v f, r_e), 0, 1) · max(M, p_w)
///             p = 0 on obstacles and where r_e < 0
///             f = 0.4 on sand, 0.5 on soil, 0.6 on rock, by c
///             s ← s + p · landed
///   bounce    a ← waiting + (1 − p) · landed
///   impacts   r = (deposited + bounced)(1 − v)/φ, the strength of reptation
///
/// A hop takes the time T = `hop_time`. In a step of Δt ≤ T the share φ = Δt/T of the sand completes what all
/// of it does in T, so that flux and airborne sand of a steady state do not depend on Δt: over a flat bed the
/// flux is ε_s T |w|/p, and a = ε_s T (1 − p)/p. A step with Δt > T consists of ⌈Δt/T⌉ equal parts.
///
/// Symbols: s sand, a airborne_sand, w wind, r_s wind_shadow, r_e echo, v vegetation, m relative moisture,
/// m_c `moisture_cutoff`, p_w `least_deposit`, k_s `sticky_lift` of echo_dunes.hpp. Nothing is lifted in
/// still air or below `threshold_speed`. The scatter adds integers, so that its result does not depend on the
/// order of threads. Amounts below 256 quanta are rounded by dice (dice.hpp), and so few land in one of the
/// four cells, drawn by the shares.
///
/// Sand that the wind carries over an open edge is recorded in the ledger as outflow; `influx` enters where
/// the wind blows in, spread over the length of a hop w T.
///
/// Where the layers flux_x and flux_y are in use, each hop adds to its cell's flux
///
///   q += φ (a + L) w T / Δt    [m²/s]
///
/// from the counted quanta of the hop, Δt being the whole step: after the step they are the mean volume of
/// sand that went through a metre of width in a second. Reptation, avalanches and `influx` are not part of
/// it.
///
/// Reads sand, airborne_sand, soil, water, moisture, vegetation, obstacle, wind_x, wind_y, wind_shadow, echo,
/// and for abrasion bedrock and erosion_resistance. Writes sand, airborne_sand, the tangents of repose and
/// the impact strength (scratch), with abrasion also bedrock and soil, and wind_shadow where it computes that
/// in the same pass. Adds to flux_x and flux_y where they are in use.

#include <cmath>

#include "kernels/field/layers.hpp"
#include "kernels/field/ledger.hpp"
#include "kernels/sand/abrasion.hpp"
#include "kernels/sand/reptation.hpp"
#include "kernels/wind/echo_dunes.hpp"

namespace desert_sim {

/// Of the hops of this file and of the same as random events of slabs (desertscape.hpp). For continuum.hpp
/// only `enabled`, `moisture_cutoff`, `influx` and `flux` count, for flights of grains only
/// `moisture_cutoff` and `influx`, for slabs only `influx`.
struct SaltationParameters {
  bool enabled = true;
  float lift = 1.0f;
  float hop_time = 1.0f;
  float hop_spread = 0.6f;
  float threshold_speed = 0.0f;
  float bounce_on_sand = 0.4f;
  float bounce_on_soil = 0.5f;
  float bounce_on_rock = 0.6f;
  float bare_depth = 0.001f;
  float moisture_cutoff = 0.1f;
  float least_deposit = 0.01f;
  float influx = 0.0f;
  bool flux = false;
};

constexpr auto parameter_table(const SaltationParameters*) {
  using P = SaltationParameters;
  return std::make_tuple(
      parameter("enabled", &P::enabled,
                "Whether the wind carries sand, where sand.model is hops, desertscape_2019 or continuum."),
      parameter(
          "lift", &P::lift, 0, 10, "m/s",
          "Sand lifted from an open cell a second (epsilon_s). The smaller, the slower and higher dunes are; "
          "desertscape_2019 needs about 0.1."),
      parameter("hop_time", &P::hop_time, 0.001, 100, "s", "Time that a hop takes (T)."),
      parameter(
          "hop_spread", &P::hop_spread, 0, 100, "m",
          "Standard deviation of landing points about the mean hop, along each axis; 0.7 cells at most."),
      parameter("threshold_speed", &P::threshold_speed, 0, 100, "m/s", "Wind below which nothing is lifted."),
      parameter("bounce_on_sand", &P::bounce_on_sand, 0, 1, "1",
                "Share of landing sand that bounces on sand (f)."),
      parameter("bounce_on_soil", &P::bounce_on_soil, 0, 1, "1",
                "Share of landing sand that bounces on soil."),
      parameter("bounce_on_rock", &P::bounce_on_rock, 0, 1, "1",
                "Share of landing sand that bounces on rock."),
      parameter("bare_depth", &P::bare_depth, 0, 1, "m",
                "Depth of sand below which the ground counts as bare."),
      parameter(
          "moisture_cutoff", &P::moisture_cutoff, 0.001, 1, "1",
          "Relative moisture at which the wind lifts no more sand; it lifts less the nearer to that the "
          "ground is (Nilles 2025: 10 %)."),
      parameter(
          "least_deposit", &P::least_deposit, 0, 1, "1",
          "Share of the usual deposit that is left on wet ground and under water, so that sand does not "
          "pile up at their edge (Nilles 2025: 1 %)."),
      parameter("influx", &P::influx, 0, 100, "m^2/s",
                "Sand that enters an open windward edge, per metre of edge."),
      parameter("flux", &P::flux, "Whether the layers flux_x and flux_y tell what the wind carries."));
}
static_assert(table_is_complete<SaltationParameters>());

namespace wind_shadow {
struct Shadow;
}

namespace saltation {

/// The widest cells on which dunes move within a fifth of as far as on cells of a quarter of a metre [m]: on
/// cells of 1 m they move up to 17 % too far, on cells of 2 m 23 to 47 %, whatever the size of the dune, at
/// winds of 3 and 6 m/s.
constexpr float widest_cell = 1.0f;

/// How a step is divided: into `parts`, in each of which the share φ of the sand hops.
struct Hops {
  int parts;
  float share;

  Hops(const SaltationParameters& p, float time_step)
      : parts(static_cast<int>(std::ceil(time_step / p.hop_time))), share(time_step / (parts * p.hop_time)) {}
};

struct StepInputs {
  SaltationParameters saltation;
  AbrasionParameters abrasion;
  ReposeParameters repose;     ///< for the ground's capacity of moisture
  EchoDuneParameters echo;     ///< for the lift where sand is held
  float time_step;             ///< [s]
  float flux_time;             ///< over which the layers flux_x and flux_y are a mean [s]
  Quanta* landed;              ///< scratch, one value a cell [quanta]
  reptation::Impacts impacts;  ///< what it writes of them
  /// Computes the wind shadow in the pass of the lift. Null where the layer is up to date, and where flux_x
  /// and flux_y are in use.
  const wind_shadow::Shadow* shadow = nullptr;
};

template <class E>
void step(E& exec, const TerrainView& t, const StepInputs& in, const Dice& dice, LedgerView ledger);

/// Sets the layers flux_x and flux_y, which are in use, to 0.
template <class E>
void clear_flux(E& exec, const TerrainView& t);

}  // namespace saltation
}  // namespace desert_sim
