#pragma once
/// The picture of render/plant_cover.hpp on the ground: a texture of its material. A new picture is sent in
/// strips, over many frames; those that are as before are not.

#include <OgreMaterial.h>
#include <OgreTexture.h>

#include <memory>

#include "src/render/plant_cover.hpp"

namespace desert_sim {

class CoverTexture {
 public:
  /// `ground`: the material of that ground, whose first texture coordinates are metres east and north of its
  /// corner. Takes its place among the textures: what comes later lies on top.
  explicit CoverTexture(const Ogre::MaterialPtr& ground);
  ~CoverTexture();
  CoverTexture(const CoverTexture&) = delete;
  CoverTexture& operator=(const CoverTexture&) = delete;

  /// Begins to send a picture of plants whose origin lies there, from the ground's corner [m]. The one that
  /// is shown stays until all of a picture with another grid is there.
  void set(std::shared_ptr<const render::CoverPicture> picture, double east, double north);
  /// Shows nothing.
  void clear();
  /// Sends strips for at most `seconds`, but at least one.
  void update(double seconds);
  std::size_t waiting() const { return sending_ ? sending_->strips.size() - next_ : 0; }

 private:
  void send(const render::CoverStrip& strip);
  void show();
  void hide();
  void place();

  const Ogre::MaterialPtr ground_;
  Ogre::TextureUnitState* unit_ = nullptr;
  Ogre::TexturePtr nothing_, shown_, filled_;  ///< filled_: the one that strips are sent to
  /// The pixels on the card, without their values: strips of the picture that was sent last.
  render::CoverPicture known_;
  std::shared_ptr<const render::CoverPicture> sending_;  ///< null: all is sent
  std::size_t next_ = 0;                                 ///< strip
  double east_ = 0, north_ = 0;
};

}  // namespace desert_sim
