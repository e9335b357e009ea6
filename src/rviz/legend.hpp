#pragma once
/// The legend of an overlay in the lower left corner of rviz's view: name, unit, colours and range.

#include <OgreMaterial.h>
#include <OgreTexture.h>
#include <Overlay/OgreOverlay.h>

#include <string>

#include "src/render/overlay.hpp"

namespace desert_sim {

class Legend {
 public:
  Legend();
  ~Legend();
  Legend(const Legend&) = delete;
  Legend& operator=(const Legend&) = delete;

  /// Shows the overlay's colours from low to high, and says its name and unit.
  void show(const std::string& title, const render::Overlay& overlay);
  void hide() { overlay_->hide(); }

 private:
  static constexpr int width = 220, height = 64;  // [pixels]

  const std::size_t place_;  ///< from below, among the legends of all displays
  const std::string name_;
  std::string text_;  ///< what is drawn now
  Ogre::TexturePtr texture_;
  Ogre::MaterialPtr material_;
  Ogre::Overlay* overlay_;
  Ogre::OverlayElement* panel_;
};

}  // namespace desert_sim
