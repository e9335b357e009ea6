#include "src/rviz/materials.hpp"

#include <OgreMaterialManager.h>
#include <OgreResourceGroupManager.h>
#include <OgreTechnique.h>

#include <string>

namespace desert_sim::materials {

namespace {

const Ogre::String& group() { return Ogre::ResourceGroupManager::DEFAULT_RESOURCE_GROUP_NAME; }

/// The material of this name, which is made when it is asked for the first time, and lives as long as rviz.
template <class SetUp>
Ogre::MaterialPtr material(const std::string& name, const SetUp& set_up) {
  Ogre::MaterialManager& all = Ogre::MaterialManager::getSingleton();
  if (const Ogre::MaterialPtr there = all.getByName(name, group())) return there;
  Ogre::MaterialPtr made = all.create(name, group());
  made->setReceiveShadows(false);
  Ogre::Pass* const pass = made->getTechnique(0)->getPass(0);
  pass->setLightingEnabled(false);
  pass->setCullingMode(Ogre::CULL_NONE);
  set_up(*pass);
  return made;
}

}  // namespace

Ogre::MaterialPtr new_ground() {
  static int count = 0;
  return material("desert_sim/ground" + std::to_string(count++),
                  [](Ogre::Pass& pass) { pass.setDepthBias(-2, -1); });
}

void remove(const Ogre::MaterialPtr& material) { Ogre::MaterialManager::getSingleton().remove(material); }

Ogre::MaterialPtr sky() {
  return material("desert_sim/sky", [](Ogre::Pass& pass) {
    pass.setDepthCheckEnabled(false);
    pass.setDepthWriteEnabled(false);
  });
}

Ogre::MaterialPtr translucent() {
  return material("desert_sim/translucent", [](Ogre::Pass& pass) {
    pass.setSceneBlending(Ogre::SBT_TRANSPARENT_ALPHA);
    pass.setDepthWriteEnabled(false);
  });
}

Ogre::MaterialPtr shapes() {
  return material("desert_sim/shapes", [](Ogre::Pass&) {});
}

Ogre::MaterialPtr marks() {
  return material("desert_sim/marks", [](Ogre::Pass& pass) {
    pass.setSceneBlending(Ogre::SBT_TRANSPARENT_ALPHA);
    pass.setDepthCheckEnabled(false);
    pass.setDepthWriteEnabled(false);
    pass.setLineWidth(2);
  });
}

Ogre::MaterialPtr lines(int pixels) {
  return material("desert_sim/lines" + std::to_string(pixels), [pixels](Ogre::Pass& pass) {
    pass.setSceneBlending(Ogre::SBT_TRANSPARENT_ALPHA);
    pass.setDepthWriteEnabled(false);
    pass.setLineWidth(static_cast<float>(pixels));
  });
}

Ogre::MaterialPtr lines_behind(int pixels) {
  return material("desert_sim/lines_behind" + std::to_string(pixels), [pixels](Ogre::Pass& pass) {
    pass.setSceneBlending(Ogre::SBT_TRANSPARENT_ALPHA);
    pass.setDepthCheckEnabled(false);
    pass.setDepthWriteEnabled(false);
    pass.setLineWidth(static_cast<float>(pixels));
  });
}

}  // namespace desert_sim::materials
