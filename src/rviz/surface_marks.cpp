#include "src/rviz/surface_marks.hpp"

#include <OgreCamera.h>
#include <OgreRenderQueue.h>
#include <OgreSceneManager.h>
#include <OgreSceneNode.h>
#include <OgreViewport.h>
#include <rviz/ogre_helpers/movable_text.h>

#include <algorithm>
#include <cmath>

#include "src/rviz/materials.hpp"

namespace desert_sim {

namespace {

constexpr float text_pixels = 22;

/// The size of a pixel at a point of the scene [m].
float metres_per_pixel(const Ogre::Viewport& viewport, const Ogre::Vector3& point) {
  const Ogre::Camera& camera = *viewport.getCamera();
  const Ogre::Matrix4 projection = camera.getProjectionMatrix();
  const float depth = (camera.getViewMatrix() * point).z;
  const float w = projection[3][2] * depth + projection[3][3];  // 1 in orthographic views
  return 2 * std::abs(w) / (projection[1][1] * static_cast<float>(viewport.getActualHeight()));
}

}  // namespace

SurfaceMarks::SurfaceMarks(Ogre::SceneManager& scene)
    : scene_(scene),
      node_(scene.getRootSceneNode()->createChildSceneNode()),
      text_node_(node_->createChildSceneNode()),
      lines_(std::make_unique<MeshObject>(node_, materials::marks(), Ogre::RenderOperation::OT_LINE_LIST)),
      text_(std::make_unique<rviz::MovableText>("x", "Liberation Sans", text_pixels)) {
  lines_->setRenderQueueGroup(Ogre::RENDER_QUEUE_OVERLAY - 1);
  text_->setTextAlignment(rviz::MovableText::H_LEFT, rviz::MovableText::V_ABOVE);
  text_->showOnTop();
  text_node_->attachObject(text_.get());
  hide();
}

SurfaceMarks::~SurfaceMarks() {
  text_node_->detachObject(text_.get());
  lines_.reset();
  scene_.destroySceneNode(text_node_);
  scene_.destroySceneNode(node_);
}

void SurfaceMarks::show(const TerrainPicker& terrain, const std::vector<Line>& lines) {
  node_->setPosition(terrain.position());
  node_->setOrientation(terrain.orientation());
  render::Mesh mesh;
  for (const Line& line : lines) append_line(mesh, line.points, terrain.exaggeration(), line.colour);
  lines_->set_mesh(mesh);
}

void SurfaceMarks::show_text(const TerrainPicker& terrain, const std::string& text, const render::Point& at,
                             const Ogre::Viewport& viewport) {
  text_->setVisible(!text.empty());
  if (text.empty()) return;
  const Ogre::Vector3 place(static_cast<float>(at.x), static_cast<float>(at.y),
                            static_cast<float>(terrain.exaggeration() * at.z));
  text_node_->setPosition(place);
  const float pixel = metres_per_pixel(viewport, terrain.position() + terrain.orientation() * place);
  text_->setCharacterHeight(text_pixels * pixel);
  text_->setCaption(text);
}

void SurfaceMarks::hide() {
  lines_->set_mesh({});
  text_->setVisible(false);
}

}  // namespace desert_sim
