#pragma once
/// The plants that are near, as shapes in OGRE's scene, tile by tile.

#include <memory>
#include <unordered_map>
#include <vector>

#include "src/render/plant_choice.hpp"
#include "src/rviz/mesh_object.hpp"

namespace desert_sim {

class PlantObjects {
 public:
  /// Below `parent`, which must outlive it; the plants' origin lies there in its frame [m].
  PlantObjects(Ogre::SceneNode* parent, double east, double north,
               std::shared_ptr<const render::PlantTiles> plants);
  ~PlantObjects();
  PlantObjects(const PlantObjects&) = delete;
  PlantObjects& operator=(const PlantObjects&) = delete;

  /// Draws the tiles that are chosen for this view; builds for at most `seconds` those that have no mesh or
  /// another one, but at least one of them. What is built is kept for as long as it is not too much. With
  /// `hidden` all is built and nothing drawn.
  void update(const Ogre::Camera& camera, int viewport_height, double exaggeration,
              const render::PlantLimits& limits, double seconds, bool hidden = false);

  const std::shared_ptr<const render::PlantTiles>& plants() const { return plants_; }
  std::size_t drawn() const { return drawn_; }      ///< plants
  std::size_t waiting() const { return waiting_; }  ///< tiles that are to be built

 private:
  struct Tile {
    std::unique_ptr<MeshObject> object;
    bool detailed = false;
    double exaggeration = 0;
    std::uint64_t frame = 0;  ///< in which it was drawn last
  };
  void build(const render::ChosenTile& chosen, double exaggeration, Tile& tile);
  void hide_others(std::size_t most_plants);

  Ogre::SceneNode* const node_;
  const std::shared_ptr<const render::PlantTiles> plants_;
  std::unordered_map<std::size_t, Tile> tiles_;  ///< that have a mesh
  std::uint64_t frame_ = 0;
  std::size_t drawn_ = 0, waiting_ = 0;
};

}  // namespace desert_sim
