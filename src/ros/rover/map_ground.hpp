#pragma once
/// Ground from the maps of a TerrainClient.

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "src/client/layer_assembler.hpp"
#include "src/client/layer_map.hpp"
#include "src/rover/ground.hpp"

namespace desert_sim {

/// The layers of one state of the terrain that matter to a rover, and after them those that only its sensors
/// see.
struct TerrainMaps {
  enum Which : std::size_t {
    elevation,
    sand_depth,
    soil_depth,
    moisture,
    obstacle,
    water_depth,
    looseness,
    ground_count,
    canopy_height = ground_count,
    vegetation,
    airborne_sand,
    count
  };
  static constexpr const char* names[count] = {"elevation",  "sand_depth",   "soil_depth", "moisture",
                                               "obstacle",   "water_depth",  "looseness",  "canopy_height",
                                               "vegetation", "airborne_sand"};
  std::array<std::shared_ptr<const LayerMap>, count> maps;
  bool loose = false;  ///< whether a cell of the looseness is not 0

  /// The names of the layers for the ground, or of those for sensors only.
  static std::vector<std::string> ground_names() { return {names, names + ground_count}; }
  static std::vector<std::string> sensor_names() { return {names + ground_count, names + count}; }
  /// The number of a layer's name; count if it is none of them.
  static std::size_t index(const std::string& name);
  /// Whether there is a map of each layer for the ground, and for sensors if they are asked for.
  bool complete(bool with_sensors) const;
  void forget_sensor_layers() { std::fill(maps.begin() + ground_count, maps.end(), nullptr); }
  /// Takes a new map, of which these cells differ from the one before.
  void set(std::size_t which, const MapChange& change);
  const MapInfo& info() const { return maps[elevation]->info(); }
};

class MapGround : public GroundSource {
 public:
  /// `maps` must be complete. `use_looseness`: whether the layer says how loose the ground is.
  MapGround(TerrainMaps maps, double moisture_capacity, bool use_looseness)
      : maps_(std::move(maps)), moisture_capacity_(moisture_capacity), use_looseness_(use_looseness) {}
  const TerrainMaps& maps() const { return maps_; }

  bool contains(double x, double y) const override;
  std::optional<double> elevation(double x, double y) const override;
  GroundPoint at(double x, double y) const override;

 private:
  double value(TerrainMaps::Which which, double x, double y) const;

  TerrainMaps maps_;
  double moisture_capacity_;
  bool use_looseness_;
};

}  // namespace desert_sim
