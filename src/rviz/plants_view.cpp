#include "src/rviz/plants_view.hpp"

#include "src/rviz/materials.hpp"
#include "src/rviz/message_meshes.hpp"

namespace desert_sim {

void PlantsView::subscribe(ros::NodeHandle& node, const std::string& topic) {
  inbox_.subscribe(node, topic);
  message_.reset();
  object_.reset();
  shown_ = 0;
}

void PlantsView::update(double corner_x, double corner_y, double vertical_exaggeration, int most) {
  const Plants::ConstPtr newest = inbox_.take();
  if (newest) message_ = newest;
  if (!message_ || (!newest && vertical_exaggeration == exaggeration_ && most == most_)) return;
  exaggeration_ = vertical_exaggeration;
  most_ = most;
  const PlantsMesh plants = plants_mesh(*message_, corner_x, corner_y, vertical_exaggeration, most);
  if (!object_)
    object_ =
        std::make_unique<MeshObject>(parent_, materials::shapes(), Ogre::RenderOperation::OT_TRIANGLE_LIST);
  object_->set_mesh(plants.mesh);
  shown_ = plants.plants;
}

}  // namespace desert_sim
