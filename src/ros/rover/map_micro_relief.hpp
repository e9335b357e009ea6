#pragma once
/// Ripples and bumps on the maps of a TerrainClient: MicroRelief of the layers and of what ~micro_relief
/// and ~plants say.

#include <map>
#include <memory>
#include <mutex>

#include "include/desert_sim/client/layer_map.hpp"
#include "src/ros/rover/map_plants.hpp"
#include "src/rover/sensors/height_field_scene.hpp"
#include "src/simulation/views/micro_relief.hpp"

namespace desert_sim {

class MapMicroRelief : public MicroReliefSource {
 public:
  using Maps = std::map<Layer, std::shared_ptr<const LayerMap>>;

  /// `maps` has the layers MicroRelief::layers(), of one geometry. `settings`: snapshot_of() a message.
  /// `plants`: may be null if these settings need no feet.
  MapMicroRelief(Maps maps, Snapshot settings, std::shared_ptr<const MapPlants> plants);

  /// Of the whole terrain.
  SceneGeometry geometry() const {
    return {settings_.width, settings_.height, settings_.cell_size, settings_.origin_x, settings_.origin_y};
  }
  /// MicroRelief::offset() [m] at a point of the terrain's frame. Rows of cells are looked at as far as
  /// points need them. From any thread.
  double offset(double x, double y) const;

  const Snapshot& grid() const override { return settings_; }
  std::shared_ptr<const PlantFeet> feet() const override;
  std::vector<float> values(Layer layer, const Rectangle& cells) const override;

 private:
  Snapshot snapshot(const RowBand& band) const;

  const Maps maps_;
  const std::shared_ptr<const MapPlants> plants_;
  Snapshot settings_;  ///< with the whole grid, without layers
  mutable std::mutex mutex_;
  mutable std::unique_ptr<const MicroRelief> near_;  ///< of the rows around near_y_
  mutable double near_y_ = 0;                        ///< [m]
};

}  // namespace desert_sim
