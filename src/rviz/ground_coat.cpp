#include "src/rviz/ground_coat.hpp"

#include <OgreHardwarePixelBuffer.h>
#include <OgreTechnique.h>
#include <OgreTextureManager.h>

#include "src/rviz/terrain_display.hpp"

namespace desert_sim {

namespace {

std::string coat_name() {
  static int count = 0;
  return "desert_sim/ground_coat" + std::to_string(count++);
}

}  // namespace

GroundCoat::GroundCoat() : name_(coat_name()) {}

GroundCoat::~GroundCoat() {
  hide();
  if (texture_) Ogre::TextureManager::getSingleton().remove(texture_);
}

void GroundCoat::set_grid(int width, int height, double cell_size) {
  width_ = width * cell_size;
  height_ = height * cell_size;
  const auto w = static_cast<Ogre::uint32>(width), h = static_cast<Ogre::uint32>(height);
  if (texture_ && texture_->getWidth() == w && texture_->getHeight() == h) return;
  hide();
  Ogre::TextureManager& textures = Ogre::TextureManager::getSingleton();
  if (texture_) textures.remove(texture_);
  texture_ = textures.createManual(name_, Ogre::ResourceGroupManager::DEFAULT_RESOURCE_GROUP_NAME,
                                   Ogre::TEX_TYPE_2D, w, h, 0, Ogre::PF_A8B8G8R8, Ogre::TU_DEFAULT);
}

void GroundCoat::write(const render::CellRectangle& cells, const std::vector<render::PackedColour>& pixels) {
  const auto width = static_cast<std::size_t>(cells.width);
  const auto height = static_cast<std::size_t>(cells.height);
  std::vector<render::PackedColour> from_north;  // as textures are
  from_north.reserve(pixels.size());
  for (std::size_t row = height; row-- > 0;)
    from_north.insert(from_north.end(), pixels.begin() + static_cast<std::ptrdiff_t>(row * width),
                      pixels.begin() + static_cast<std::ptrdiff_t>((row + 1) * width));
  const int texture_height = static_cast<int>(texture_->getHeight());
  const Ogre::Box place(
      static_cast<Ogre::uint32>(cells.x), static_cast<Ogre::uint32>(texture_height - cells.top()),
      static_cast<Ogre::uint32>(cells.right()), static_cast<Ogre::uint32>(texture_height - cells.y));
  texture_->getBuffer()->blitFromMemory(
      Ogre::PixelBox(static_cast<Ogre::uint32>(width), static_cast<Ogre::uint32>(height), 1,
                     Ogre::PF_A8B8G8R8, from_north.data()),
      place);
}

void GroundCoat::show(const TerrainDisplay& terrain, const Placement& corner) {
  if (terrain.ground_material() != ground_) {
    hide();
    add_to(terrain.ground_material());
  }
  const Placement ground = terrain.corner();
  const Ogre::Affine3 picture_from_ground = Ogre::Affine3(corner.position, corner.orientation).inverse() *
                                            Ogre::Affine3(ground.position, ground.orientation);
  Ogre::Matrix4 texture_from_ground = Ogre::Matrix4::IDENTITY;  // which begins in the north-west
  for (int n = 0; n < 4; ++n) {
    texture_from_ground[0][n] = picture_from_ground[0][n] / static_cast<Ogre::Real>(width_);
    texture_from_ground[1][n] = -picture_from_ground[1][n] / static_cast<Ogre::Real>(height_);
  }
  texture_from_ground[1][3] += 1;
  unit_->setTextureTransform(texture_from_ground);
}

void GroundCoat::hide() {
  if (!ground_) return;
  Ogre::Pass* const pass = ground_->getTechnique(0)->getPass(0);
  pass->removeTextureUnitState(pass->getTextureUnitStateIndex(unit_));
  ground_.reset();
}

void GroundCoat::add_to(const Ogre::MaterialPtr& ground) {
  ground_ = ground;
  unit_ = ground->getTechnique(0)->getPass(0)->createTextureUnitState();
  unit_->setTexture(texture_);
  unit_->setTextureAddressingMode(Ogre::TextureUnitState::TAM_CLAMP);
  unit_->setTextureFiltering(Ogre::FO_POINT, Ogre::FO_LINEAR, Ogre::FO_NONE);  // smooth where it is near
  unit_->setColourOperationEx(Ogre::LBX_BLEND_TEXTURE_ALPHA, Ogre::LBS_TEXTURE, Ogre::LBS_CURRENT);
  unit_->setAlphaOperation(Ogre::LBX_SOURCE1, Ogre::LBS_CURRENT, Ogre::LBS_TEXTURE);
}

}  // namespace desert_sim
