#pragma once
/// Parameters of the slab models; see slab_model.hpp.

#include "src/core/parameter_table.hpp"

namespace desert_sim {

enum class SlabKind : int { werner, momiji, bishop, nield_baas, snow };
constexpr bool speeds_up(SlabKind kind) { return kind == SlabKind::momiji || kind == SlabKind::bishop; }
constexpr bool has_resistance(SlabKind kind) {
  return kind == SlabKind::nield_baas || kind == SlabKind::snow;
}

enum class SlabPolling : int { repeated, non_repeated };
constexpr const char* slab_polling_names[] = {"repeated", "non_repeated"};

struct SlabModelParameters {
  float slab_height = 1.0f / 3.0f;
  SlabPolling polling = SlabPolling::repeated;
  float poll_time = 1.0f;
  float hop_time = 1.0f;
  float deposit_on_sand = 0.6f;
  float deposit_on_rock = 0.4f;
  float repose_deg = 30.0f;
  float shadow_deg = 15.0f;
  float longest_shadow = 120.0f;
  float linear_speedup = 0.4f;
  float square_speedup = 0.002f;
  bool forced_erosion = false;
};

constexpr auto parameter_table(const SlabModelParameters*) {
  using P = SlabModelParameters;
  return std::make_tuple(
      parameter("slab_height", &P::slab_height, 0.001, 10, "m", "Height of a slab; whole slabs move."),
      parameter("polling", &P::polling, slab_polling_names,
                "Whether cells are polled at random, some more than once, or each of them once in turn."),
      parameter("poll_time", &P::poll_time, 0.001, 1e9, "s", "Time in which each cell is polled once."),
      parameter("hop_time", &P::hop_time, 0.001, 1000, "s", "Length of a hop over the speed of the wind."),
      parameter("deposit_on_sand", &P::deposit_on_sand, 0.01, 1, "1",
                "Probability that a slab that lands on sand stays there."),
      parameter("deposit_on_rock", &P::deposit_on_rock, 0.01, 1, "1",
                "The same where there is less than a slab of sand."),
      parameter("repose_deg", &P::repose_deg, 1, 80, "deg", "Angle of repose, seen before a slab moves."),
      parameter("shadow_deg", &P::shadow_deg, 1, 80, "deg",
                "Angle of the wind's shadow, in which all slabs stay that land."),
      parameter("longest_shadow", &P::longest_shadow, 1, 10000, "m",
                "Longest shadow; longer ones may end there."),
      parameter("linear_speedup", &P::linear_speedup, 0, 100, "cells/slab",
                "C1: what a slab of height adds to a hop (momiji, bishop)."),
      parameter("square_speedup", &P::square_speedup, 0, 10, "cells/slab^2",
                "C2: the same of its square, above the reference height."),
      parameter("forced_erosion", &P::forced_erosion,
                "Whether a poll that takes no slab is made again elsewhere, until one does."));
}
static_assert(table_is_complete<SlabModelParameters>());

/// Plants of nield_baas.
struct SlabPlantParameters {
  float growth_time = 80.0f;
  float held_from = 0.3f;
  float held_repose_deg = 40.0f;
};

constexpr auto parameter_table(const SlabPlantParameters*) {
  using P = SlabPlantParameters;
  return std::make_tuple(
      parameter("growth_time", &P::growth_time, 0.001, 1e12, "s",
                "What counts as a year: plants grow at its end, by growth_curves."),
      parameter("held_from", &P::held_from, 0, 10, "1",
                "Effectiveness of all plants of a cell from which they hold steeper slopes."),
      parameter("held_repose_deg", &P::held_repose_deg, 1, 80, "deg", "Angle of repose there."));
}
static_assert(table_is_complete<SlabPlantParameters>());

/// Snow of the model snow. With the defaults snow at −20 °C packs in 98 days.
struct SlabSnowParameters {
  float temperature = -20.0f;
  float fall_temperature = -20.0f;
  float packed_density = 250.7f;
  float settling_time = 86400.0f;
  float loose_density = 150.0f;
  float stiffening = 0.046f;
  double settling_rate = 2.777e-6;
  double settling_warmth = 0.04;
};

constexpr auto parameter_table(const SlabSnowParameters*) {
  using P = SlabSnowParameters;
  return std::make_tuple(
      parameter("temperature", &P::temperature, -20, 0, "degC",
                "Temperature of the snow; run.timeline can change it in the course of a run."),
      parameter("fall_temperature", &P::fall_temperature, -20, 0, "degC",
                "Temperature at which the snow fell, which gives its density when fresh."),
      parameter("packed_density", &P::packed_density, 130, 917, "kg/m^3",
                "Density from which the wind moves no more snow."),
      parameter("settling_time", &P::settling_time, 60, 1e7, "s",
                "Time after which the density is computed anew."),
      parameter("loose_density", &P::loose_density, 10, 917, "kg/m^3",
                "Density beyond which snow settles more slowly (Anderson 1976)."),
      parameter("stiffening", &P::stiffening, 0.001, 1, "m^3/kg",
                "How much more slowly beyond it: by e^(-stiffening times the excess) (Anderson 1976)."),
      parameter("settling_rate", &P::settling_rate, 0, 1, "1/s",
                "Share by which loose snow at 0 degC becomes denser a second (Anderson 1976: c3)."),
      parameter("settling_warmth", &P::settling_warmth, 0, 10, "1/K",
                "How much faster warm snow settles: by e^(settling_warmth T) (Anderson 1976: c4)."));
}
static_assert(table_is_complete<SlabSnowParameters>());

}  // namespace desert_sim
