#pragma once
/// The table of layers, and the view of them that is passed to laws.

#include <array>
#include <cstdint>
#include <cstring>

#include "kernels/base/grid.hpp"
#include "kernels/base/quanta.hpp"

namespace desert_sim {

enum class Layer : int {
  bedrock,
  soil,
  sand,
  water,
  airborne_sand,
  suspended_sediment,
  moisture,
  humus,
  vegetation,
  erosion_resistance,
  obstacle,
  looseness,
  water_flux_x,
  water_flux_y,
  grass,
  mesquite,
  shrub,
  burial,
  snow_density,
  elevation,
  water_velocity_x,
  water_velocity_y,
  wind_x,
  wind_y,
  wind_shadow,
  echo,
  flux_x,
  flux_y,
  illumination,
  illumination_canopy,
  canopy_height,
  slope,
  normal_x,
  normal_y,
  normal_z,
  roughness,
  step_height,
  slip,
  slip_downhill,
  slip_across,
  sinkage,
  traversability,
  water_surface,
  plants,
};

enum class Storage { quanta, real };  ///< fixed-point metres, or float32; both four bytes
enum class Lifetime {
  persistent,  ///< part of the state
  held,        ///< likewise where a step is shorter than `run.hold_time`, else derived
  derived,     ///< computed from the state for the processes of a step
  on_request   ///< computed from the state only when a snapshot needs it
};

struct LayerInfo {
  Layer layer;
  const char* name;
  const char* unit;
  Storage storage;
  Lifetime lifetime;
  double lowest, highest;  ///< values that scenarios and edits may set, in `unit`
  const char* doc;
};

constexpr double any_height = 1e6;

constexpr std::array<LayerInfo, 44> layer_table{{
    {Layer::bedrock, "bedrock", "m", Storage::quanta, Lifetime::persistent, -any_height, any_height,
     "Top of the rock, absolute."},
    {Layer::soil, "soil", "m", Storage::quanta, Lifetime::persistent, 0, any_height,
     "Depth of soil on the rock."},
    {Layer::sand, "sand", "m", Storage::quanta, Lifetime::persistent, 0, any_height,
     "Depth of sand on soil and rock."},
    {Layer::water, "water", "m", Storage::quanta, Lifetime::persistent, 0, any_height,
     "Depth of standing water."},
    {Layer::airborne_sand, "airborne_sand", "m", Storage::quanta, Lifetime::persistent, 0, any_height,
     "Sand that the wind carries over a cell, as a depth."},
    {Layer::suspended_sediment, "suspended_sediment", "m", Storage::quanta, Lifetime::persistent, 0,
     any_height, "Sediment in the water, as a depth."},
    {Layer::moisture, "moisture", "m", Storage::quanta, Lifetime::persistent, 0, any_height,
     "Water in the ground, as a depth."},
    {Layer::humus, "humus", "m", Storage::quanta, Lifetime::persistent, 0, any_height,
     "Humus in the soil, as a depth."},
    {Layer::vegetation, "vegetation", "1", Storage::real, Lifetime::persistent, 0, 1, "Density of plants."},
    {Layer::erosion_resistance, "erosion_resistance", "1", Storage::real, Lifetime::persistent, 0, 1,
     "Resistance of rock and soil to wear; 1 never wears."},
    {Layer::obstacle, "obstacle", "1", Storage::real, Lifetime::persistent, 0, 1,
     "1 where a solid object stands, that neither gives nor takes sand."},
    {Layer::looseness, "looseness", "1", Storage::real, Lifetime::persistent, 0, 1,
     "How loose the ground's surface is: 0 packed … 1 fresh."},
    {Layer::water_flux_x, "water_flux_x", "m^3/s", Storage::real, Lifetime::persistent, -any_height,
     any_height, "Water that flows through a cell's east face."},
    {Layer::water_flux_y, "water_flux_y", "m^3/s", Storage::real, Lifetime::persistent, -any_height,
     any_height, "Water that flows through a cell's north face."},
    {Layer::grass, "grass", "1", Storage::real, Lifetime::persistent, 0, 1,
     "Effectiveness of grass against the transport of slabs (nield_baas)."},
    {Layer::mesquite, "mesquite", "1", Storage::real, Lifetime::persistent, -1, 3,
     "Likewise of mesquite; it may be short of water (< 0), or have growth in reserve (> 1)."},
    {Layer::shrub, "shrub", "1", Storage::real, Lifetime::persistent, -0.5, 1.5, "Likewise of shrubs."},
    {Layer::burial, "burial", "m", Storage::quanta, Lifetime::persistent, -any_height, any_height,
     "Sand that slabs have brought since these plants last grew; < 0: taken."},
    {Layer::snow_density, "snow_density", "kg/m^3", Storage::real, Lifetime::persistent, 0, 917,
     "Density of the snow that the layer sand holds (slab model snow)."},
    {Layer::elevation, "elevation", "m", Storage::quanta, Lifetime::derived, -any_height, any_height,
     "Solid surface: bedrock + soil + sand."},
    {Layer::water_velocity_x, "water_velocity_x", "m/s", Storage::real, Lifetime::derived, 0, 0,
     "Mean velocity of the water, eastward part."},
    {Layer::water_velocity_y, "water_velocity_y", "m/s", Storage::real, Lifetime::derived, 0, 0,
     "Mean velocity of the water, northward part."},
    {Layer::wind_x, "wind_x", "m/s", Storage::real, Lifetime::derived, 0, 0,
     "Wind at the surface, eastward part."},
    {Layer::wind_y, "wind_y", "m/s", Storage::real, Lifetime::derived, 0, 0,
     "Wind at the surface, northward part."},
    {Layer::wind_shadow, "wind_shadow", "1", Storage::real, Lifetime::held, 0, 1,
     "0 in the open … 1 fully in the lee."},
    {Layer::echo, "echo", "1", Storage::real, Lifetime::derived, -1, 1,
     "In front of cliffs: < 0 erosion, > 0 sticky."},
    {Layer::flux_x, "flux_x", "m^2/s", Storage::real, Lifetime::derived, -any_height, any_height,
     "Sand that the wind carried through a metre of width in the last step, eastward part."},
    {Layer::flux_y, "flux_y", "m^2/s", Storage::real, Lifetime::derived, -any_height, any_height,
     "Likewise, northward part."},
    {Layer::illumination, "illumination", "1", Storage::real, Lifetime::derived, 0, 1,
     "Light on the ground over the day; 1 in the open."},
    {Layer::illumination_canopy, "illumination_canopy", "1", Storage::real, Lifetime::derived, 0, 1,
     "Light at the top of the plants."},
    {Layer::canopy_height, "canopy_height", "m", Storage::real, Lifetime::derived, 0, any_height,
     "Height of the plants above the ground."},
    {Layer::slope, "slope", "rad", Storage::real, Lifetime::on_request, 0, 1.5707964,
     "Angle of the surface to the horizontal."},
    {Layer::normal_x, "normal_x", "1", Storage::real, Lifetime::on_request, -1, 1,
     "Unit normal of the surface, eastward part."},
    {Layer::normal_y, "normal_y", "1", Storage::real, Lifetime::on_request, -1, 1,
     "Unit normal of the surface, northward part."},
    {Layer::normal_z, "normal_z", "1", Storage::real, Lifetime::on_request, 0, 1,
     "Unit normal of the surface, upward part."},
    {Layer::roughness, "roughness", "m", Storage::real, Lifetime::on_request, 0, any_height,
     "Rms deviation from the plane that fits the surroundings best."},
    {Layer::step_height, "step_height", "m", Storage::real, Lifetime::on_request, 0, any_height,
     "Largest rise or drop nearby that is no slope a rover could drive."},
    {Layer::slip, "slip", "1", Storage::real, Lifetime::on_request, -1, 1,
     "Slip of the rover of the section traversability that drives up the steepest way; 1: it is stuck."},
    {Layer::slip_downhill, "slip_downhill", "1", Storage::real, Lifetime::on_request, -1, 1,
     "Its slip down that way; < 0: it slides ahead of its wheels."},
    {Layer::slip_across, "slip_across", "1", Storage::real, Lifetime::on_request, 0, 1,
     "Its drift downhill over the way made across the slope, as the tangent of the slip angle."},
    {Layer::sinkage, "sinkage", "m", Storage::real, Lifetime::on_request, 0, any_height,
     "How deep its wheels stand in the ground as it drives up."},
    {Layer::traversability, "traversability", "1", Storage::real, Lifetime::on_request, 0, 1,
     "1 free ground … 0 no way for the rover of the section traversability."},
    {Layer::water_surface, "water_surface", "m", Storage::quanta, Lifetime::on_request, -any_height,
     any_height, "Elevation + water."},
    {Layer::plants, "plants", "1", Storage::real, Lifetime::on_request, 0, 16,
     "Species of the plant that is densest here: its place in the list, from 1 on; 0 where none grows."},
}};
constexpr int layer_count = static_cast<int>(layer_table.size());

/// Whether each row stands where its layer's number says: info() looks rows up by that number.
constexpr bool layer_table_is_ordered() {
  for (std::size_t n = 0; n < layer_table.size(); ++n)
    if (static_cast<std::size_t>(layer_table[n].layer) != n) return false;
  return true;
}
static_assert(layer_table_is_ordered());

constexpr const LayerInfo& info(Layer layer) { return layer_table[static_cast<std::size_t>(layer)]; }

/// Plain pointers to the layers on the backend's device, passed to laws by value. A layer that is not in use
/// is null and counts as 0 everywhere. Heights are quanta above the datum.
struct TerrainView {
  Grid grid;
  float quantum = 0;           ///< [m]
  float quanta_per_metre = 0;  ///< 1 / quantum, exact
  void* layers[layer_count] = {};

  DESERT_HD Quanta* quanta(Layer layer) const {
    return static_cast<Quanta*>(layers[static_cast<int>(layer)]);
  }
  DESERT_HD float* real(Layer layer) const { return static_cast<float*>(layers[static_cast<int>(layer)]); }
};

/// Water deeper than this covers the ground: wind moves no sand there, and the ground does not dry [m].
constexpr float wet_depth = 1e-5f;

/// The value of a layer, or 0 if the layer is not in use.
DESERT_HD Quanta value_or_zero(const Quanta* layer, int i) { return layer ? layer[i] : 0; }
DESERT_HD float value_or_zero(const float* layer, int i) { return layer ? layer[i] : 0.0f; }

/// Where the ground and the water on it end in a cell [quanta above the datum].
struct FilledHeight {
  const Quanta *bedrock, *soil, *sand, *water;

  explicit FilledHeight(const TerrainView& t)
      : bedrock(t.quanta(Layer::bedrock)),
        soil(t.quanta(Layer::soil)),
        sand(t.quanta(Layer::sand)),
        water(t.quanta(Layer::water)) {}
  DESERT_HD Quanta operator()(int i) const {
    return bedrock[i] + value_or_zero(soil, i) + sand[i] + value_or_zero(water, i);
  }
};

}  // namespace desert_sim
