#pragma once
/// The blocks of a terrain in OGRE's scene: builds those that changed, or whose distance asks for another
/// level of detail, within a time for each frame, and shows all of a change in the same frame.

#include <OgreCamera.h>
#include <OgreSceneManager.h>

#include <memory>
#include <optional>
#include <vector>

#include "src/render/level_of_detail.hpp"
#include "src/render/rebuild_queue.hpp"
#include "src/render/sunlight.hpp"
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
  /// Blocks are built with these values from the next batch on.
  void set_window(const render::LayerWindow& window) { window_ = window; }
  const render::LayerWindow& window() const { return window_; }
  void touch(const render::CellRectangle& cells) {
    queue_.touch(render::cells_in_shade_of(cells, grid_.shadow_reach));
  }
  /// All blocks are built anew. Exaggeration of heights is a scale of node(); blocks have true heights.
  void set_look(const render::TerrainLook& look);
  const render::TerrainLook& look() const { return look_; }
  void set_limits(const render::DetailLimits& limits) { limits_ = limits; }
  const render::TerrainGrid& grid() const { return grid_; }
  /// In the terrain's frame, with heights as they are drawn.
  render::View view_of(const Ogre::Camera& camera, int viewport_height) const;
  /// The pixels that a metre takes at most anywhere on the terrain.
  double most_pixels_per_metre(const render::View& view) const;
  /// Shows this ground between the centres of the outermost of `cells`, in place of the blocks there, in the
  /// same frame as they leave it out. An empty rectangle shows none.
  void set_near_ground(const render::CellRectangle& cells, render::Mesh ground);

  /// Builds waiting blocks for at most `seconds`; at least one. While `hold`, no batch begins: more of the
  /// same change is on its way.
  void update(const Ogre::Camera& camera, int viewport_height, double seconds, bool hold = false);

  struct Counts {
    int blocks = 0, waiting = 0;
    std::uint64_t built = 0;          ///< blocks built since the start
    std::int64_t triangles = 0;       ///< of the ground, in all blocks
    std::int64_t near_triangles = 0;  ///< of the ground near the camera
  };
  Counts counts() const;
  /// The node whose frame is the grid's corner, with heights exaggerated.
  Ogre::SceneNode* node() const { return node_; }
  /// With which this ground alone is drawn.
  const Ogre::MaterialPtr& ground_material() const { return ground_material_; }

 private:
  struct Block {
    std::unique_ptr<MeshObject> ground, water, contours;
    std::int64_t triangles = 0;
  };
  /// Meshes of a block that wait for the rest of their batch.
  struct Staged {
    int block;
    render::TerrainBlock meshes;
  };

  struct NearMesh {
    render::CellRectangle cells;
    render::Mesh ground;
  };

  void keep_fine(std::vector<int>& levels) const;
  void show_near(const NearMesh& near);
  std::vector<render::Box> boxes_as_seen() const;
  void begin_batch(const render::View& view);
  void build(int block, int level);
  void show(int block, const render::TerrainBlock& meshes);
  void put(std::unique_ptr<MeshObject>& object, const render::Mesh& mesh, const Ogre::MaterialPtr& material,
           Ogre::RenderOperation::OperationType type);

  Ogre::SceneNode *const parent_, *const node_;
  const Ogre::MaterialPtr ground_material_;
  render::TerrainGrid grid_;
  render::LayerWindow window_, batch_window_;  ///< the newest values; those of the batch that is being built
  render::TerrainLook look_;
  render::DetailLimits limits_;
  render::RebuildQueue queue_;
  std::vector<render::Box> boxes_;  ///< with true heights
  std::vector<Block> blocks_;
  std::vector<Staged> staged_;
  std::optional<NearMesh> next_near_, batch_near_;  ///< for the next batch, and with the one being built
  std::unique_ptr<MeshObject> near_ground_, near_contours_;
  std::int64_t near_triangles_ = 0;
  std::uint64_t built_ = 0;
};

}  // namespace desert_sim
