#pragma once
/// Parameters of the section `water`: springs, flow (virtual_pipes.hpp, shallow_water.hpp), the sea, waves,
/// evaporation (water_sources.hpp).

#include <cstddef>

#include "src/core/parameter_table.hpp"

namespace desert_sim {

struct Spring {
  float x = 0;
  float y = 0;
  float radius = 1;
  float discharge = 0;
};

constexpr auto parameter_table(const Spring*) {
  using P = Spring;
  return std::make_tuple(
      parameter("x", &P::x, -1e7, 1e7, "m", "Centre, in the terrain's frame."),
      parameter("y", &P::y, -1e7, 1e7, "m", "Centre, in the terrain's frame."),
      parameter("radius", &P::radius, 0, 1e5, "m",
                "Cells of the terrain with their centre in it share the discharge; at least one does."),
      parameter("discharge", &P::discharge, 0, 1e5, "m^3/s", "Water that comes out a second."));
}
static_assert(table_is_complete<Spring>());
constexpr std::size_t max_springs = 64;

enum class WaterModel : int { pipes, shallow_water };
constexpr const char* water_models[] = {"pipes", "shallow_water"};

enum class Sea : int { none, border, everywhere };
constexpr const char* seas[] = {"none", "border", "everywhere"};

struct WaterParameters {
  bool enabled = false;
  WaterModel model = WaterModel::pipes;
  float friction = 0.1f;
  float drag = 0.0f;
  float manning = 0.0f;
  int most_substeps = 64;
  float evaporation = 0.01f;
  Sea sea = Sea::none;
  float sea_level = 0.0f;
  float wave_strength = 0.0f;
  float wave_period = 10.0f;
  float wave_depth = 5.0f;
  float gravity = 9.81f;
};

constexpr auto parameter_table(const WaterParameters*) {
  using P = WaterParameters;
  return std::make_tuple(
      parameter("enabled", &P::enabled,
                "Whether there is water on the ground; rain, springs, hydraulic_erosion and moisture bring "
                "it too."),
      parameter("model", &P::model, water_models,
                "pipes: slow water, with long steps; shallow_water: with momentum, for floods and streams."),
      parameter("friction", &P::friction, 0, 100, "1/s",
                "How fast flow slows down by itself, whatever its depth (c)."),
      parameter("drag", &P::drag, 0, 10, "1",
                "Drag of the bed, which holds shallow water most (c_f): 0.002 of mud, 0.01 of sand, 0.05 of "
                "stones; 0: none."),
      parameter("manning", &P::manning, 0, 1, "s/m^(1/3)",
                "Manning's n of the bed, which adds to its drag: 0.025 of sand, 0.04 of gravel, 0.07 among "
                "shrubs; 0: none."),
      parameter("most_substeps", &P::most_substeps, 1, 256, "1",
                "Most parts that a step of pipes is divided into; waves on water that would need more travel "
                "slower."),
      parameter("evaporation", &P::evaporation, 0, 10, "1/s",
                "Share of standing water that evaporates a second."),
      parameter(
          "sea", &P::sea, seas,
          "Where water stands at least at sea_level: nowhere, at the edges of the terrain, everywhere."),
      parameter("sea_level", &P::sea_level, -1e6, 1e6, "m", "Elevation of the sea."),
      parameter("wave_strength", &P::wave_strength, 0, 10, "1/s",
                "Acceleration of deep water by 1 m/s of wind, at a wave's height (c_wave); 0: no waves."),
      parameter("wave_period", &P::wave_period, 0.01, 1e6, "s", "From wave to wave."),
      parameter(
          "wave_depth", &P::wave_depth, 0.01, 1e4, "m",
          "Depth of water at which waves have 1 - 1/sqrt(e), two fifths, of their strength; none where it "
          "is 0."),
      parameter("gravity", &P::gravity, 0.01, 100, "m/s^2", "Gravity (g); 3.71 on Mars."));
}
static_assert(table_is_complete<WaterParameters>());

}  // namespace desert_sim
