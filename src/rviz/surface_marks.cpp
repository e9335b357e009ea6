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
#include "src/rviz/view_scale.hpp"

namespace desert_sim {

namespace {

constexpr float text_pixels = 20;
constexpr std::size_t longest_line = 48;  // characters

std::unique_ptr<rviz::MovableText> make_text(Ogre::SceneNode* node, const Ogre::ColourValue& colour,
                                             Ogre::uint8 queue) {
  // Without a letter its box would be empty at first, and OGRE would never draw it.
  auto text = std::make_unique<rviz::MovableText>("x", "Liberation Sans", text_pixels, colour);
  text->setTextAlignment(rviz::MovableText::H_CENTER, rviz::MovableText::V_ABOVE);
  text->showOnTop();
  text->setRenderQueueGroup(queue);
  node->createChildSceneNode()->attachObject(
      text.get());  // two of them in one node are refused: none has a name
  return text;
}

/// The text with line breaks instead of some blanks.
std::string broken(std::string text) {
  std::size_t line = 0, blank = std::string::npos;
  for (std::size_t n = 0; n < text.size(); ++n) {
    if (text[n] == '\n') {
      line = n + 1;
      blank = std::string::npos;
      continue;
    }
    if (text[n] == ' ') blank = n;
    if (n - line >= longest_line && blank != std::string::npos) {
      text[blank] = '\n';
      line = blank + 1;
      blank = std::string::npos;
    }
  }
  return text;
}

}  // namespace

SurfaceMarks::SurfaceMarks(Ogre::SceneManager& scene)
    : scene_(scene),
      node_(scene.getRootSceneNode()->createChildSceneNode()),
      text_node_(node_->createChildSceneNode()),
      lines_(std::make_unique<MeshObject>(node_, materials::marks(), Ogre::RenderOperation::OT_LINE_LIST)),
      text_(make_text(text_node_, Ogre::ColourValue::White, Ogre::RENDER_QUEUE_OVERLAY - 1)),
      shadow_(make_text(text_node_, Ogre::ColourValue::Black, Ogre::RENDER_QUEUE_OVERLAY - 2)) {
  lines_->setRenderQueueGroup(Ogre::RENDER_QUEUE_OVERLAY - 3);
  hide();
}

SurfaceMarks::~SurfaceMarks() {
  for (const auto* const text : {&text_, &shadow_}) {
    Ogre::SceneNode* const node = (*text)->getParentSceneNode();
    node->detachAllObjects();
    scene_.destroySceneNode(node);
  }
  lines_.reset();
  scene_.destroySceneNode(text_node_);
  scene_.destroySceneNode(node_);
}

void SurfaceMarks::show(const TerrainPicker& terrain, const std::vector<Line>& lines) {
  node_->setPosition(terrain.corner().position);
  node_->setOrientation(terrain.corner().orientation);
  render::Mesh mesh;
  for (const Line& line : lines) append_line(mesh, line.points, terrain.exaggeration(), line.colour);
  lines_->set_mesh(mesh);
}

void SurfaceMarks::show_text(const TerrainPicker& terrain, const std::string& text, const render::Point& at,
                             const Ogre::Viewport& viewport) {
  text_node_->setVisible(!text.empty());
  if (text.empty()) return;
  const Ogre::Vector3 place(static_cast<float>(at.x()), static_cast<float>(at.y()),
                            static_cast<float>(terrain.exaggeration() * at.z()));
  text_node_->setPosition(place);
  const float pixel =
      metres_per_pixel(viewport, terrain.corner().position + terrain.corner().orientation * place);
  for (rviz::MovableText* const one : {text_.get(), shadow_.get()}) {
    one->setCharacterHeight(text_pixels * pixel);
    one->setSpaceWidth(0.3f * text_pixels * pixel);
    one->setCaption(broken(text));
    one->getParentSceneNode()->needUpdate();  // its box is another one
  }
  shadow_->setLocalTranslation({1.3f * pixel, -1.3f * pixel, 0});
}

void SurfaceMarks::hide() {
  lines_->set_mesh({});
  text_node_->setVisible(false);
}

}  // namespace desert_sim
