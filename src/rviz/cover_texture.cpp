#include "src/rviz/cover_texture.hpp"

#include <OgreHardwarePixelBuffer.h>
#include <OgrePass.h>
#include <OgreTechnique.h>
#include <OgreTextureManager.h>

#include <string>
#include <utility>

#include "src/render/rebuild_queue.hpp"

namespace desert_sim {

namespace {

Ogre::TexturePtr new_texture(int width, int height, std::size_t levels) {
  static int count = 0;
  return Ogre::TextureManager::getSingleton().createManual(
      "desert_sim/plant_cover" + std::to_string(count++),
      Ogre::ResourceGroupManager::DEFAULT_RESOURCE_GROUP_NAME, Ogre::TEX_TYPE_2D,
      static_cast<Ogre::uint32>(width), static_cast<Ogre::uint32>(height), static_cast<int>(levels) - 1,
      Ogre::PF_A8B8G8R8, Ogre::TU_STATIC_WRITE_ONLY);
}

void remove(Ogre::TexturePtr& texture) {
  if (texture) Ogre::TextureManager::getSingleton().remove(texture);
  texture.reset();
}

}  // namespace

CoverTexture::CoverTexture(const Ogre::MaterialPtr& ground)
    : ground_(ground),
      unit_(ground->getTechnique(0)->getPass(0)->createTextureUnitState()),
      nothing_(new_texture(1, 1, 1)) {
  unit_->setTextureAddressingMode(Ogre::TextureUnitState::TAM_BORDER);
  unit_->setTextureBorderColour(Ogre::ColourValue::ZERO);  // the ground beyond the picture stays as it is
  unit_->setTextureFiltering(Ogre::TFO_TRILINEAR);
  unit_->setAlphaOperation(Ogre::LBX_SOURCE1, Ogre::LBS_CURRENT, Ogre::LBS_TEXTURE);
  hide();
}

CoverTexture::~CoverTexture() {
  clear();
  remove(nothing_);
}

/// Lets the ground through as it is. A unit without a texture would show OGRE's warning.
void CoverTexture::hide() {
  unit_->setTexture(nothing_);
  unit_->setColourOperationEx(Ogre::LBX_SOURCE1, Ogre::LBS_CURRENT, Ogre::LBS_CURRENT);
}

void CoverTexture::set(std::shared_ptr<const render::CoverPicture> picture, double east, double north) {
  if (picture->empty()) return clear();
  sending_ = std::move(picture);
  next_ = 0;
  east_ = east;
  north_ = north;
  if (filled_ != shown_) remove(filled_);
  filled_ = shown_ && known_.same_grid(*sending_)
                ? shown_
                : new_texture(sending_->width, sending_->height, sending_->levels.size());
  if (filled_ != shown_) known_.strips.clear();
}

void CoverTexture::clear() {
  sending_.reset();
  known_ = {};
  hide();
  if (filled_ != shown_) remove(filled_);
  filled_.reset();
  remove(shown_);
}

void CoverTexture::update(double seconds) {
  if (!sending_) return;
  const double begin = render::RebuildQueue::steady_seconds();
  while (next_ < sending_->strips.size()) {
    const render::CoverStrip& strip = sending_->strips[next_];
    const bool same = next_ < known_.strips.size() && known_.strips[next_].hash == strip.hash;
    ++next_;
    if (same) continue;
    send(strip);
    if (render::RebuildQueue::steady_seconds() - begin > seconds) break;
  }
  if (next_ == sending_->strips.size()) show();
}

void CoverTexture::send(const render::CoverStrip& strip) {
  const auto width = static_cast<Ogre::uint32>(sending_->width >> strip.level);
  const auto first = static_cast<Ogre::uint32>(strip.first), rows = static_cast<Ogre::uint32>(strip.rows);
  // OGRE takes pixels to change; it only reads these.
  auto* const pixels = const_cast<render::PackedColour*>(sending_->levels[strip.level].data()) +
                       static_cast<std::size_t>(first) * width;
  filled_->getBuffer(0, strip.level)
      ->blitFromMemory(Ogre::PixelBox(width, rows, 1, Ogre::PF_A8B8G8R8, pixels),
                       Ogre::Box(0, first, width, first + rows));
}

void CoverTexture::show() {
  if (filled_ != shown_) {
    remove(shown_);
    shown_ = filled_;
    unit_->setTexture(shown_);
    unit_->setColourOperationEx(Ogre::LBX_BLEND_TEXTURE_ALPHA, Ogre::LBS_TEXTURE, Ogre::LBS_CURRENT);
  }
  known_ = {sending_->west,  sending_->south, sending_->pixel, sending_->width, sending_->height, {},
            sending_->strips};
  sending_.reset();
  place();
}

void CoverTexture::place() {
  const double width = known_.width * known_.pixel, height = known_.height * known_.pixel;
  Ogre::Matrix4 texture_from_ground = Ogre::Matrix4::IDENTITY;  // begins in the south-west, as the pixels do
  texture_from_ground[0][0] = static_cast<Ogre::Real>(1 / width);
  texture_from_ground[1][1] = static_cast<Ogre::Real>(1 / height);
  texture_from_ground[0][3] = static_cast<Ogre::Real>(-(east_ + known_.west) / width);
  texture_from_ground[1][3] = static_cast<Ogre::Real>(-(north_ + known_.south) / height);
  unit_->setTextureTransform(texture_from_ground);
}

}  // namespace desert_sim
