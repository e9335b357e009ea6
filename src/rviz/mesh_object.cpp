#include "src/rviz/mesh_object.hpp"

#include <OgreCamera.h>
#include <OgreHardwareBufferManager.h>
#include <OgreSceneNode.h>

#include <algorithm>
#include <cstddef>

namespace desert_sim {

namespace {

Ogre::Vector3 to_ogre(const render::Point& p) {
  return {static_cast<Ogre::Real>(p.x()), static_cast<Ogre::Real>(p.y()), static_cast<Ogre::Real>(p.z())};
}

/// Room for a quarter more, so that a mesh that changes a little needs no new buffer.
std::size_t with_reserve(std::size_t count) { return count + count / 4; }

}  // namespace

MeshObject::MeshObject(Ogre::SceneNode* parent, const Ogre::MaterialPtr& material,
                       Ogre::RenderOperation::OperationType type)
    : parent_(parent) {
  mRenderOp.operationType = type;
  mRenderOp.vertexData = new Ogre::VertexData;
  mRenderOp.indexData = new Ogre::IndexData;
  mRenderOp.useIndexes = true;
  using render::Vertex;
  Ogre::VertexDeclaration* const layout = mRenderOp.vertexData->vertexDeclaration;
  layout->addElement(0, offsetof(Vertex, x), Ogre::VET_FLOAT3, Ogre::VES_POSITION);
  layout->addElement(0, offsetof(Vertex, x), Ogre::VET_FLOAT2,
                     Ogre::VES_TEXTURE_COORDINATES);  // metres: what lies on the ground is seen from above
  layout->addElement(0, offsetof(Vertex, normal_x), Ogre::VET_FLOAT3, Ogre::VES_NORMAL);
  layout->addElement(0, offsetof(Vertex, colour), Ogre::VET_COLOUR_ABGR, Ogre::VES_DIFFUSE);
  setMaterial(material);
  setCastShadows(false);
  setVisible(false);
  parent_->attachObject(this);
}

MeshObject::~MeshObject() {
  parent_->detachObject(this);
  delete mRenderOp.vertexData;
  delete mRenderOp.indexData;
}

void MeshObject::reserve(std::size_t vertices, std::size_t indices) {
  Ogre::HardwareBufferManager& buffers = Ogre::HardwareBufferManager::getSingleton();
  constexpr auto usage = Ogre::HardwareBuffer::HBU_DYNAMIC_WRITE_ONLY_DISCARDABLE;
  const auto fits = [](std::size_t has, std::size_t needs) { return has >= needs && has <= 4 * needs; };
  if (!vertices_ || !fits(vertices_->getNumVertices(), vertices)) {
    vertices_ = buffers.createVertexBuffer(sizeof(render::Vertex), with_reserve(vertices), usage);
    mRenderOp.vertexData->vertexBufferBinding->setBinding(0, vertices_);
  }
  if (!indices_ || !fits(indices_->getNumIndexes(), indices)) {
    indices_ = buffers.createIndexBuffer(Ogre::HardwareIndexBuffer::IT_32BIT, with_reserve(indices), usage);
    mRenderOp.indexData->indexBuffer = indices_;
  }
}

void MeshObject::set_mesh(const render::Mesh& mesh) {
  count_ = mesh.indices.size();
  draw_first(count_);
  mRenderOp.vertexData->vertexCount = mesh.vertices.size();
  if (mesh.empty()) {
    mRenderOp.vertexData->vertexBufferBinding->unsetAllBindings();
    mRenderOp.indexData->indexBuffer.reset();
    vertices_.reset();
    indices_.reset();
    return;
  }
  reserve(mesh.vertices.size(), mesh.indices.size());
  const std::size_t vertex_bytes = mesh.vertices.size() * sizeof(render::Vertex),
                    index_bytes = mesh.indices.size() * sizeof(std::uint32_t);
  vertices_->writeData(0, vertex_bytes, mesh.vertices.data(), true);
  indices_->writeData(0, index_bytes, mesh.indices.data(), true);
  const render::Box box = render::bounding_box(mesh);
  setBoundingBox({to_ogre(box.min()), to_ogre(box.max())});
  parent_->needUpdate();
}

void MeshObject::draw_first(std::size_t indices) {
  mRenderOp.indexData->indexCount = std::min(indices, count_);
  setVisible(mRenderOp.indexData->indexCount > 0);
}

void MeshObject::_updateRenderQueue(Ogre::RenderQueue* queue) {
  if (mRenderOp.indexData->indexCount > 0) Ogre::SimpleRenderable::_updateRenderQueue(queue);
}

Ogre::Real MeshObject::getBoundingRadius() const {
  return std::max(mBox.getMinimum().length(), mBox.getMaximum().length());
}

Ogre::Real MeshObject::getSquaredViewDepth(const Ogre::Camera* camera) const {
  return getWorldBoundingBox(true).squaredDistance(camera->getDerivedPosition());
}

}  // namespace desert_sim
