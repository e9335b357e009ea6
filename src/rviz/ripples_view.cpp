#include "src/rviz/ripples_view.hpp"

#include <OgreHardwarePixelBuffer.h>
#include <OgrePass.h>
#include <OgreTechnique.h>
#include <OgreTextureManager.h>

#include <chrono>

#include "src/rviz/materials.hpp"

namespace desert_sim {

namespace {

/// The texture, which is made with its place in the ground's material when it is asked for the first time.
Ogre::TexturePtr texture_of(Ogre::Pass& ground) {
  const char* const name = "desert_sim/ripples";
  const Ogre::String& group = Ogre::ResourceGroupManager::DEFAULT_RESOURCE_GROUP_NAME;
  Ogre::TextureManager& textures = Ogre::TextureManager::getSingleton();
  if (const Ogre::TexturePtr there = textures.getByName(name, group)) return there;
  const Ogre::TexturePtr made = textures.createManual(
      name, group, Ogre::TEX_TYPE_2D, RippleTile::pixels, RippleTile::pixels, Ogre::MIP_UNLIMITED,
      Ogre::PF_BYTE_RGB, Ogre::TU_DYNAMIC_WRITE_ONLY | Ogre::TU_AUTOMIPMAP);
  // The tile's light where the vertices' alpha is 1, that of level ground where it is 0; then twice that times colour.
  Ogre::TextureUnitState* const light = ground.createTextureUnitState();
  light->setTexture(made);
  light->setTextureFiltering(Ogre::TFO_TRILINEAR);
  light->setColourOperationEx(Ogre::LBX_BLEND_DIFFUSE_ALPHA, Ogre::LBS_TEXTURE, Ogre::LBS_MANUAL,
                              Ogre::ColourValue::White, Ogre::ColourValue(0.5F, 0.5F, 0.5F));
  Ogre::TextureUnitState* const colour = ground.createTextureUnitState();
  colour->setTexture(made);
  colour->setColourOperationEx(Ogre::LBX_MODULATE_X2, Ogre::LBS_CURRENT, Ogre::LBS_DIFFUSE);
  return made;
}

}  // namespace

RipplesView::RipplesView()
    : ground_(materials::ground()), texture_(texture_of(*ground_->getTechnique(0)->getPass(0))) {
  show(ripple_tile({}));
}

void RipplesView::subscribe(ros::NodeHandle& node, const std::string& topic) {
  inbox_.subscribe(node, topic);
  if (topic.empty()) show(ripple_tile({}));
  drawn_.reset();
}

void RipplesView::update() {
  if (tile_.valid()) {
    if (tile_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    show(tile_.get());
  }
  const MicroReliefState::ConstPtr newest = inbox_.take();
  if (!newest || (drawn_ && !ripples_differ(*drawn_, *newest))) return;
  drawn_ = newest;
  tile_ = std::async(std::launch::async, [newest] { return ripple_tile(*newest); });
}

void RipplesView::show(const RippleTile& tile) {
  std::vector<std::uint8_t> grey;
  grey.reserve(3 * tile.brightness.size());
  for (const std::uint8_t value : tile.brightness) grey.insert(grey.end(), 3, value);
  texture_->getBuffer()->blitFromMemory(
      Ogre::PixelBox(RippleTile::pixels, RippleTile::pixels, 1, Ogre::PF_BYTE_RGB, grey.data()));
  // Texture coordinates are metres from the grid's corner.
  for (Ogre::TextureUnitState* const unit : ground_->getTechnique(0)->getPass(0)->getTextureUnitStates())
    unit->setTextureScale(tile.side, tile.side);
}

}  // namespace desert_sim
