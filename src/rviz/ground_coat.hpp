#pragma once
/// A picture that lies on the ground, seen from above: a texture of the material with which a display
/// desert_sim/Terrain draws it. So it moves with the ground, at every level of detail; no mesh is built for
/// it, and none is drawn twice.

#include <OgreMaterial.h>
#include <OgreTexture.h>

#include <string>
#include <vector>

#include "src/render/cells.hpp"
#include "src/render/colour.hpp"
#include "src/rviz/placement.hpp"

namespace desert_sim {

class TerrainDisplay;

class GroundCoat {
 public:
  GroundCoat();
  ~GroundCoat();
  GroundCoat(const GroundCoat&) = delete;
  GroundCoat& operator=(const GroundCoat&) = delete;

  /// A picture of so many pixels, each of `cell_size` [m], and nothing on it yet.
  void set_grid(int width, int height, double cell_size);
  /// The pixels of some cells, row by row from the south-west. The outermost ones of the grid have to be
  /// transparent: they are what lies on all ground beyond it.
  void write(const render::CellRectangle& cells, const std::vector<render::PackedColour>& pixels);
  /// Shows it on this terrain and no other one, with its south-west corner here.
  void show(const TerrainDisplay& terrain, const Placement& corner);
  void hide();

 private:
  void add_to(const Ogre::MaterialPtr& ground);

  const std::string name_;
  Ogre::MaterialPtr ground_;                ///< on which it is shown; null: on none
  Ogre::TextureUnitState* unit_ = nullptr;  ///< of that
  Ogre::TexturePtr texture_;
  double width_ = 1, height_ = 1;  ///< [m]
};

}  // namespace desert_sim
