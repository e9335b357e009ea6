#pragma once
/// A picture that lies on the ground, seen from above: one more pass of the material with which displays
/// desert_sim/Terrain draw it. So it lies on whatever ground is drawn, moves with it, at every level of
/// detail, and no mesh is built for it.

#include <OgreFrustum.h>
#include <OgreMaterial.h>
#include <OgreTexture.h>

#include <string>
#include <vector>

#include "src/render/cells.hpp"
#include "src/render/colour.hpp"
#include "src/rviz/placement.hpp"

namespace desert_sim {

class GroundCoat {
 public:
  GroundCoat();
  ~GroundCoat();
  GroundCoat(const GroundCoat&) = delete;
  GroundCoat& operator=(const GroundCoat&) = delete;

  /// A picture of so many pixels, each of `cell_size` [m], and nothing on it yet.
  void set_grid(int width, int height, double cell_size);
  /// The pixels of some cells, row by row from the south-west; their colours are multiplied by their alpha.
  void write(const render::CellRectangle& cells, const std::vector<render::PackedColour>& pixels);
  /// Where the south-west corner lies; the picture's east is its x axis.
  void place(const Placement& corner);
  void show(bool shown);

 private:
  void add_pass();

  const std::string name_;
  Ogre::MaterialPtr ground_;
  Ogre::Pass* pass_ = nullptr;  ///< null while nothing is shown
  Ogre::TexturePtr texture_;
  Ogre::Frustum from_above_;
};

}  // namespace desert_sim
