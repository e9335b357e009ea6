#pragma once
/// The sky of src/render/sky.hpp in OGRE's scene, behind everything else.

#include <OgreCamera.h>
#include <OgreSceneNode.h>

#include <memory>

#include "src/rviz/mesh_object.hpp"

namespace desert_sim {

class Sky {
 public:
  /// Below `root`, which must outlive it. It is not seen before show().
  explicit Sky(Ogre::SceneNode* root);
  ~Sky();
  Sky(const Sky&) = delete;
  Sky& operator=(const Sky&) = delete;

  /// Shows it around this camera, unless that is an orthographic one, which has no horizon.
  void show(const Ogre::Camera& camera);
  void hide();

 private:
  Ogre::SceneNode* const node_;
  std::unique_ptr<MeshObject> dome_;
};

}  // namespace desert_sim
