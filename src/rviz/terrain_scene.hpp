#pragma once
/// The blocks of a terrain in OGRE's scene: builds those that changed, or whose distance asks for another
/// level of detail, within a time for each frame.

#include <OgreCamera.h>
#include <OgreSceneManager.h>

#include <memory>
#include <vector>

#include "src/render/level_of_detail.hpp"
#include "src/render/rebuild_queue.hpp"
#include "src/render/terrain_block.hpp"
#include "src/rviz/mesh_object.hpp"

namespace desert_sim {

class TerrainScene {
 public:
  /// Below `parent`, which must outlive it.
  explicit TerrainScene(Ogre::SceneNode* parent);
  ~TerrainScene();
  TerrainScene(const TerrainScene&) = delete;
  TerrainScene& operator=(const TerrainScene&) = delete;

  /// Begins anew with a grid of this size; all cells have changed.
  void set_grid(int width, int height, double cell_size, const render::LayerWindow& window);
  void clear() { set_grid(0, 0, 1, {}); }
  /// Blocks are built with these values from now on.
  void set_window(const render::LayerWindow& window) { window_ = window; }
  void touch(const render::CellRectangle& cells) { queue_.touch(cells); }
  /// All blocks are built anew. Exaggeration of heights is a scale of node(); blocks have true heights.
  void set_look(const render::TerrainLook& look);
  const render::TerrainLook& look() const { return look_; }
  void set_limits(const render::DetailLimits& limits) { limits_ = limits; }

  /// Builds waiting blocks for at most `seconds`; at least one.
  void update(const Ogre::Camera& camera, int viewport_height, double seconds);

  struct Counts {
    int blocks = 0, waiting = 0;
    std::uint64_t built = 0;     ///< blocks built since the start
    std::int64_t triangles = 0;  ///< of the ground, in all blocks
  };
  Counts counts() const;
  /// The node whose frame is the grid's corner, with heights exaggerated.
  Ogre::SceneNode* node() const { return node_; }

 private:
  struct Block {
    std::unique_ptr<MeshObject> ground, water, contours;
    std::int64_t triangles = 0;
  };

  render::View view_of(const Ogre::Camera& camera, int viewport_height) const;
  void build(int block, int level);

  Ogre::SceneNode *const parent_, *const node_;
  render::BlockLayout layout_;
  double cell_size_ = 1;
  float base_ = 0;  ///< where the walls at the edges end [m]
  render::LayerWindow window_;
  render::TerrainLook look_;
  render::DetailLimits limits_;
  render::RebuildQueue queue_;
  std::vector<render::Box> boxes_;  ///< with true heights
  std::vector<Block> blocks_;
  std::uint64_t built_ = 0;
};

}  // namespace desert_sim
