#pragma once
/// The plants of ~plants in OGRE's scene.

#include <desert_sim/Plants.h>

#include <memory>

#include "src/rviz/mesh_object.hpp"
#include "src/rviz/topic_inbox.hpp"

namespace desert_sim {

class PlantsView {
 public:
  /// Below `parent`, which must outlive it, and whose origin is the origin of the terrain's frame.
  explicit PlantsView(Ogre::SceneNode* parent) : parent_(parent) {}

  /// Shows the plants of this topic from now on; none for an empty name.
  void subscribe(ros::NodeHandle& node, const std::string& topic);
  /// `corner_x`, `corner_y`: where the parent's origin lies in the terrain's frame [m].
  void update(double corner_x, double corner_y, double vertical_exaggeration, int most);
  std::size_t shown() const { return shown_; }
  std::size_t total() const { return message_ ? message_->total : 0; }

 private:
  Ogre::SceneNode* const parent_;
  TopicInbox<Plants> inbox_;
  Plants::ConstPtr message_;
  double exaggeration_ = 1;
  int most_ = 0;
  std::unique_ptr<MeshObject> object_;
  std::size_t shown_ = 0;
};

}  // namespace desert_sim
