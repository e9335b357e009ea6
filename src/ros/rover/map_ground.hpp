#pragma once
/// Ground from the maps of a TerrainClient.

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "include/desert_sim/client/layer_assembler.hpp"
#include "include/desert_sim/client/layer_map.hpp"
#include "src/ros/rover/map_micro_relief.hpp"
#include "src/rover/ground.hpp"

namespace desert_sim {

/// The uses of maps, as bits.
struct MapUse {
  static constexpr unsigned ground = 1, sensors = 2, micro_relief = 4;
};

/// What a rover knows of one state of the terrain.
struct TerrainMaps {
  enum Which : std::size_t {
    elevation,
    sand_depth,
    soil_depth,
    moisture,
    obstacle,
    water_depth,
    water_velocity_x,
    water_velocity_y,
    looseness,
    canopy_height,
    vegetation,
    airborne_sand,
    wind_x,
    wind_y,
    wind_shadow,
    count
  };
  struct Row {
    const char* name;
    unsigned uses;
  };
  /// In the order of Which. Those for micro_relief are MicroRelief::layers().
  static constexpr Row rows[count] = {{"elevation", MapUse::ground | MapUse::sensors | MapUse::micro_relief},
                                      {"sand_depth", MapUse::ground | MapUse::micro_relief},
                                      {"soil_depth", MapUse::ground | MapUse::micro_relief},
                                      {"moisture", MapUse::ground | MapUse::micro_relief},
                                      {"obstacle", MapUse::ground | MapUse::micro_relief},
                                      {"water_depth", MapUse::ground | MapUse::micro_relief},
                                      {"water_velocity_x", MapUse::ground},
                                      {"water_velocity_y", MapUse::ground},
                                      {"looseness", MapUse::ground},
                                      {"canopy_height", MapUse::sensors},
                                      {"vegetation", MapUse::sensors | MapUse::micro_relief},
                                      {"airborne_sand", MapUse::sensors},
                                      {"wind_x", MapUse::micro_relief},
                                      {"wind_y", MapUse::micro_relief},
                                      {"wind_shadow", MapUse::micro_relief}};
  std::array<std::shared_ptr<const LayerMap>, count> maps;
  bool loose = false;                                     ///< whether a cell of the looseness is not 0
  std::shared_ptr<const Snapshot> micro_relief_settings;  ///< snapshot_of() the message of ~micro_relief
  std::shared_ptr<const MapPlants> plants;                ///< of ~plants

  /// The names of the layers with one of these uses, and with none of those of `without`.
  static std::vector<std::string> names(unsigned uses, unsigned without = 0);
  /// The number of a layer's name; count if it is none of them.
  static std::size_t index(const std::string& name);
  /// Whether all is there that these uses need.
  bool complete(unsigned uses) const;
  /// Gives up the maps that names() names.
  void forget(unsigned uses, unsigned without);
  /// Of these maps; null if something for it is missing, or if some maps are of another terrain.
  std::shared_ptr<const MapMicroRelief> micro_relief() const;
  /// Takes a new map, of which these cells differ from the one before.
  void set(std::size_t which, const MapChange& change);
  const MapInfo& info() const { return maps[elevation]->info(); }
};

class MapGround : public GroundSource {
 public:
  /// `maps` must be complete for the ground. `use_looseness`: whether the layer says how loose the ground
  /// is. Where the maps have what micro_relief needs, the elevation has ripples and bumps.
  MapGround(TerrainMaps maps, double moisture_capacity, double moisture_depth, bool use_looseness)
      : maps_(std::move(maps)),
        moisture_capacity_(moisture_capacity),
        moisture_depth_(moisture_depth),
        use_looseness_(use_looseness),
        micro_relief_(maps_.micro_relief()) {}
  const TerrainMaps& maps() const { return maps_; }
  const std::shared_ptr<const MapMicroRelief>& micro_relief() const { return micro_relief_; }

  bool contains(double x, double y) const override;
  std::optional<double> elevation(double x, double y) const override;
  GroundPoint at(double x, double y) const override;
  double finest_feature() const override;

 private:
  double value(TerrainMaps::Which which, double x, double y) const;

  TerrainMaps maps_;
  double moisture_capacity_;  ///< of a metre of ground [m]
  double moisture_depth_;     ///< down to which it holds moisture [m]
  bool use_looseness_;
  std::shared_ptr<const MapMicroRelief> micro_relief_;  ///< null: none
};

}  // namespace desert_sim
