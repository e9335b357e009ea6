#pragma once
/// A mesh as OGRE draws it.

#include <OgreHardwareIndexBuffer.h>
#include <OgreHardwareVertexBuffer.h>
#include <OgreSimpleRenderable.h>

#include "src/render/mesh.hpp"

namespace desert_sim {

class MeshObject : public Ogre::SimpleRenderable {
 public:
  /// Attaches itself to `parent`, which must outlive it.
  MeshObject(Ogre::SceneNode* parent, const Ogre::MaterialPtr& material,
             Ogre::RenderOperation::OperationType type);
  ~MeshObject() override;
  MeshObject(const MeshObject&) = delete;
  MeshObject& operator=(const MeshObject&) = delete;

  /// Copies the mesh to OGRE's buffers, which stay the same while their sizes fit. An empty mesh hides the
  /// object and frees them.
  void set_mesh(const render::Mesh& mesh);
  /// Draws only the first so many indices of the mesh; with 0 nothing.
  void draw_first(std::size_t indices);

  /// An empty mesh is not drawn, even if somebody makes all objects of its node visible.
  void _updateRenderQueue(Ogre::RenderQueue* queue) override;
  Ogre::Real getBoundingRadius() const override;
  Ogre::Real getSquaredViewDepth(const Ogre::Camera* camera) const override;

 private:
  void reserve(std::size_t vertices, std::size_t indices);

  Ogre::SceneNode* const parent_;
  Ogre::HardwareVertexBufferSharedPtr vertices_;
  Ogre::HardwareIndexBufferSharedPtr indices_;
  std::size_t count_ = 0;  ///< indices of the mesh
};

}  // namespace desert_sim
