#pragma once
/// Ground from the maps of a TerrainClient.

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "src/client/layer_map.hpp"
#include "src/rover/ground.hpp"

namespace desert_sim {

/// The layers of one state of the terrain that matter to a rover.
struct TerrainMaps {
  enum Which : std::size_t {
    elevation,
    sand_depth,
    soil_depth,
    moisture,
    obstacle,
    water_depth,
    looseness,
    count
  };
  static constexpr const char* names[count] = {"elevation", "sand_depth",  "soil_depth", "moisture",
                                               "obstacle",  "water_depth", "looseness"};
  std::array<std::shared_ptr<const LayerMap>, count> maps;

  /// The names of those that this version of the simulation has.
  static std::vector<std::string> known_names();
  /// The number of a layer's name; count if it is none of them.
  static std::size_t index(const std::string& name);
  /// Whether there is a map of each layer that the simulation has.
  bool complete() const;
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
