#include "src/rviz/corner_picture.hpp"

#include <OgreHardwarePixelBuffer.h>
#include <OgreMaterialManager.h>
#include <OgreTechnique.h>
#include <OgreTextureManager.h>
#include <Overlay/OgreOverlayContainer.h>
#include <Overlay/OgreOverlayManager.h>

#include <algorithm>
#include <string>
#include <vector>

namespace desert_sim {

namespace {

const Ogre::String& picture_group() { return Ogre::ResourceGroupManager::DEFAULT_RESOURCE_GROUP_NAME; }

/// All pictures in the order in which they were made: the first is the lowest.
std::vector<CornerPicture*>& pictures() {
  static std::vector<CornerPicture*> all;
  return all;
}

std::string picture_name() {
  static int count = 0;
  return "desert_sim/corner_picture" + std::to_string(count++);
}

}  // namespace

CornerPicture::CornerPicture(Corner corner) : corner_(corner), name_(picture_name()) {
  material_ = Ogre::MaterialManager::getSingleton().create(name_, picture_group());
  Ogre::Pass* const pass = material_->getTechnique(0)->getPass(0);
  pass->setLightingEnabled(false);
  pass->setSceneBlending(Ogre::SBT_TRANSPARENT_ALPHA);
  pass->setDepthCheckEnabled(false);
  pass->setDepthWriteEnabled(false);
  Ogre::OverlayManager& overlays = Ogre::OverlayManager::getSingleton();
  overlay_ = overlays.create(name_);
  panel_ = overlays.createOverlayElement("Panel", name_);
  panel_->setMetricsMode(Ogre::GMM_PIXELS);
  panel_->setVerticalAlignment(Ogre::GVA_BOTTOM);
  panel_->setHorizontalAlignment(corner == Corner::left ? Ogre::GHA_LEFT : Ogre::GHA_RIGHT);
  panel_->setMaterial(material_);
  overlay_->add2D(static_cast<Ogre::OverlayContainer*>(panel_));
  pictures().push_back(this);
}

CornerPicture::~CornerPicture() {
  hide();
  pictures().erase(std::find(pictures().begin(), pictures().end(), this));
  Ogre::OverlayManager& overlays = Ogre::OverlayManager::getSingleton();
  overlay_->remove2D(static_cast<Ogre::OverlayContainer*>(panel_));
  overlays.destroyOverlayElement(panel_);
  overlays.destroy(overlay_);
  Ogre::MaterialManager::getSingleton().remove(material_);
  if (texture_) Ogre::TextureManager::getSingleton().remove(texture_);
}

void CornerPicture::fit_texture(int width, int height) {
  const auto w = static_cast<Ogre::uint32>(width), h = static_cast<Ogre::uint32>(height);
  if (texture_ && texture_->getWidth() == w && texture_->getHeight() == h) return;
  Ogre::Pass* const pass = material_->getTechnique(0)->getPass(0);
  pass->removeAllTextureUnitStates();
  Ogre::TextureManager& textures = Ogre::TextureManager::getSingleton();
  if (texture_) textures.remove(texture_);
  texture_ = textures.createManual(name_, picture_group(), Ogre::TEX_TYPE_2D, w, h, 0, Ogre::PF_A8R8G8B8,
                                   Ogre::TU_DEFAULT);
  Ogre::TextureUnitState* const unit = pass->createTextureUnitState();
  unit->setTexture(texture_);
  unit->setTextureAddressingMode(Ogre::TextureUnitState::TAM_CLAMP);
  panel_->setDimensions(static_cast<Ogre::Real>(width), static_cast<Ogre::Real>(height));
}

void CornerPicture::draw(const QImage& picture) {
  fit_texture(picture.width(), picture.height());
  const Ogre::PixelBox pixels(texture_->getWidth(), texture_->getHeight(), 1, Ogre::PF_A8R8G8B8,
                              const_cast<uchar*>(picture.constBits()));
  texture_->getBuffer()->blitFromMemory(pixels);
  stack(corner_);
}

void CornerPicture::show() {
  if (overlay_->isVisible()) return;
  overlay_->show();
  stack(corner_);
}

void CornerPicture::hide() {
  overlay_->hide();
  stack(corner_);
}

void CornerPicture::stack(Corner corner) {
  constexpr Ogre::Real margin = 10;
  Ogre::Real above = margin;
  for (CornerPicture* const one : pictures()) {
    if (one->corner_ != corner || !one->overlay_->isVisible()) continue;
    above += one->panel_->getHeight();
    one->panel_->setPosition(corner == Corner::left ? margin : -margin - one->panel_->getWidth(), -above);
    above += margin;
  }
}

}  // namespace desert_sim
