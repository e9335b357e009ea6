#pragma once
/// A picture in a lower corner of rviz's view, over everything. Those that are shown in the same corner stand
/// above one another.

#include <OgreMaterial.h>
#include <OgreTexture.h>
#include <Overlay/OgreOverlay.h>

#include <QImage>
#include <string>

namespace desert_sim {

class CornerPicture {
 public:
  enum class Corner { left, right };

  explicit CornerPicture(Corner corner);
  ~CornerPicture();
  CornerPicture(const CornerPicture&) = delete;
  CornerPicture& operator=(const CornerPicture&) = delete;

  /// `picture`: ARGB32, of the size that it takes in the view. Not shown before show().
  void draw(const QImage& picture);
  void show();
  void hide();

 private:
  void fit_texture(int width, int height);
  static void stack(Corner corner);

  const Corner corner_;
  const std::string name_;
  Ogre::TexturePtr texture_;
  Ogre::MaterialPtr material_;
  Ogre::Overlay* overlay_;
  Ogre::OverlayElement* panel_;
};

}  // namespace desert_sim
