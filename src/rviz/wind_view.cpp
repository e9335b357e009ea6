#include "src/rviz/wind_view.hpp"

#include "src/rviz/materials.hpp"
#include "src/rviz/message_meshes.hpp"

namespace desert_sim {

void WindView::subscribe(ros::NodeHandle& node, const std::string& topic) {
  inbox_.subscribe(node, topic);
  message_.reset();
  object_.reset();
}

void WindView::update(const LayerMap& ground, int most) {
  const WindField::ConstPtr newest = inbox_.take();
  if (newest) message_ = newest;
  if (!message_ || (!newest && most == most_)) return;
  most_ = most;
  const std::optional<render::Mesh> mesh = wind_mesh(*message_, ground, most);
  if (!mesh) return;
  if (!object_)
    object_ =
        std::make_unique<MeshObject>(parent_, materials::shapes(), Ogre::RenderOperation::OT_TRIANGLE_LIST);
  object_->set_mesh(*mesh);
}

}  // namespace desert_sim
