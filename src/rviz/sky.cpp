#include "src/rviz/sky.hpp"

#include <OgreSceneManager.h>

#include "src/render/sky.hpp"
#include "src/rviz/materials.hpp"

namespace desert_sim {

namespace {

/// Within the far clip distance of rviz's cameras, and so far that other cameras of the scene see it as
/// sky, too [m].
constexpr float dome_radius = 2e4F;

}  // namespace

Sky::Sky(Ogre::SceneNode* root)
    : node_(root->createChildSceneNode()),
      dome_(std::make_unique<MeshObject>(node_, materials::sky(), Ogre::RenderOperation::OT_TRIANGLE_LIST)) {
  dome_->setRenderQueueGroup(Ogre::RENDER_QUEUE_SKIES_EARLY);
  dome_->set_mesh(render::sky_dome(dome_radius));
  hide();
}

Sky::~Sky() {
  dome_.reset();
  node_->getCreator()->destroySceneNode(node_);
}

void Sky::show(const Ogre::Camera& camera) {
  node_->setPosition(camera.getDerivedPosition());
  const Ogre::Matrix4& projection = camera.getProjectionMatrix();
  node_->setVisible(projection[3][2] != 0);
}

void Sky::hide() { node_->setVisible(false); }

}  // namespace desert_sim
