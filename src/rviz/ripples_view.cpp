#include "src/rviz/ripples_view.hpp"

#include <OgreHardwarePixelBuffer.h>
#include <OgrePass.h>
#include <OgreTechnique.h>
#include <OgreTextureManager.h>

#include <chrono>

namespace desert_sim {

namespace {

/// A name that no other texture of rviz has.
std::string texture_name() {
  static int count = 0;
  return "desert_sim/ripples" + std::to_string(count++);
}

}  // namespace

RipplesView::RipplesView(const Ogre::MaterialPtr& ground)
    : ground_(ground),
      texture_(Ogre::TextureManager::getSingleton().createManual(
          texture_name(), Ogre::ResourceGroupManager::DEFAULT_RESOURCE_GROUP_NAME, Ogre::TEX_TYPE_2D,
          RippleTile::pixels, RippleTile::pixels, Ogre::MIP_UNLIMITED, Ogre::PF_BYTE_RGB,
          Ogre::TU_DYNAMIC_WRITE_ONLY | Ogre::TU_AUTOMIPMAP)) {
  Ogre::Pass* const pass = ground_->getTechnique(0)->getPass(0);
  // The tile's light where the vertices' alpha is 1, that of level ground where it is 0; then twice that
  // times colour.
  light_ = pass->createTextureUnitState();
  light_->setTexture(texture_);
  light_->setTextureFiltering(Ogre::TFO_TRILINEAR);
  light_->setColourOperationEx(Ogre::LBX_BLEND_DIFFUSE_ALPHA, Ogre::LBS_TEXTURE, Ogre::LBS_MANUAL,
                               Ogre::ColourValue::White, Ogre::ColourValue(0.5F, 0.5F, 0.5F));
  Ogre::TextureUnitState* const colour = pass->createTextureUnitState();
  colour->setTexture(texture_);
  colour->setColourOperationEx(Ogre::LBX_MODULATE_X2, Ogre::LBS_CURRENT, Ogre::LBS_DIFFUSE);
  show(ripple_tile({}));
}

RipplesView::~RipplesView() { Ogre::TextureManager::getSingleton().remove(texture_); }

void RipplesView::subscribe(ros::NodeHandle& node, const std::string& topic) {
  inbox_.subscribe(node, topic);
  tile_ = {};  // waits for one that is being drawn
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
  light_->setTextureScale(tile.side, tile.side);  // of coordinates in metres from the grid's corner
}

}  // namespace desert_sim
