#include "src/rviz/ground_coat.hpp"

#include <OgreHardwarePixelBuffer.h>
#include <OgreTechnique.h>
#include <OgreTextureManager.h>

#include "src/rviz/materials.hpp"

namespace desert_sim {

namespace {

std::string coat_name() {
  static int count = 0;
  return "desert_sim/ground_coat" + std::to_string(count++);
}

}  // namespace

GroundCoat::GroundCoat() : name_(coat_name()), ground_(materials::ground()) {}

GroundCoat::~GroundCoat() {
  show(false);
  if (texture_) Ogre::TextureManager::getSingleton().remove(texture_);
}

void GroundCoat::set_grid(int width, int height, double cell_size) {
  const auto w = static_cast<Ogre::uint32>(width), h = static_cast<Ogre::uint32>(height);
  if (!texture_ || texture_->getWidth() != w || texture_->getHeight() != h) {
    const bool shown = pass_ != nullptr;
    show(false);
    Ogre::TextureManager& textures = Ogre::TextureManager::getSingleton();
    if (texture_) textures.remove(texture_);
    texture_ = textures.createManual(name_, Ogre::ResourceGroupManager::DEFAULT_RESOURCE_GROUP_NAME,
                                     Ogre::TEX_TYPE_2D, w, h, 0, Ogre::PF_A8B8G8R8, Ogre::TU_DEFAULT);
    show(shown);
  }
  // From metres east and north of the corner to -1 … 1, as OpenGL clips.
  Ogre::Matrix4 projection = Ogre::Matrix4::IDENTITY;
  projection[0][0] = static_cast<Ogre::Real>(2 / (width * cell_size));
  projection[1][1] = static_cast<Ogre::Real>(2 / (height * cell_size));
  projection[0][3] = projection[1][3] = -1;
  projection[2][2] = -1e-4F;  // heights do not count, but OGRE inverts the matrix
  from_above_.setCustomProjectionMatrix(true, projection);
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

void GroundCoat::place(const Placement& corner) {
  const Ogre::Affine3 scene_from_corner(corner.position, corner.orientation);
  from_above_.setCustomViewMatrix(true, scene_from_corner.inverse());
}

void GroundCoat::show(bool shown) {
  if (shown == (pass_ != nullptr)) return;
  if (shown) {
    if (texture_) add_pass();
    return;
  }
  Ogre::Technique* const technique = ground_->getTechnique(0);
  technique->removePass(pass_->getIndex());
  pass_ = nullptr;
}

void GroundCoat::add_pass() {
  pass_ = ground_->getTechnique(0)->createPass();
  pass_->setLightingEnabled(false);
  pass_->setCullingMode(Ogre::CULL_NONE);
  pass_->setSceneBlending(Ogre::SBF_ONE, Ogre::SBF_ONE_MINUS_SOURCE_ALPHA);  // multiplied already
  pass_->setDepthWriteEnabled(false);
  pass_->setDepthBias(-1, -0.5F);  // in front of the ground, and behind lines on it
  Ogre::TextureUnitState* const unit = pass_->createTextureUnitState();
  unit->setTexture(texture_);
  unit->setTextureAddressingMode(Ogre::TextureUnitState::TAM_BORDER);
  unit->setTextureBorderColour(Ogre::ColourValue(0, 0, 0, 0));
  unit->setTextureFiltering(Ogre::FO_LINEAR, Ogre::FO_LINEAR, Ogre::FO_NONE);
  unit->setProjectiveTexturing(true, &from_above_);
  unit->setColourOperationEx(Ogre::LBX_SOURCE1, Ogre::LBS_TEXTURE);
  unit->setAlphaOperation(Ogre::LBX_SOURCE1, Ogre::LBS_TEXTURE);
}

}  // namespace desert_sim
