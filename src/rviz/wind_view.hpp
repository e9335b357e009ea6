#pragma once
/// The wind of ~wind as arrows on the ground in OGRE's scene.

#include <desert_sim/WindField.h>

#include <memory>

#include "include/desert_sim/client/layer_map.hpp"
#include "src/rviz/mesh_object.hpp"
#include "src/rviz/topic_inbox.hpp"

namespace desert_sim {

class WindView {
 public:
  /// Below `parent`, which must outlive it, and whose origin is the corner of the grid.
  explicit WindView(Ogre::SceneNode* parent) : parent_(parent) {}

  /// Shows the wind of this topic from now on; none for an empty name.
  void subscribe(ros::NodeHandle& node, const std::string& topic);
  /// Lays at most `most` arrows on this ground, when there is a new wind.
  void update(const LayerMap& ground, int most);

 private:
  Ogre::SceneNode* const parent_;
  TopicInbox<WindField> inbox_;
  WindField::ConstPtr message_;
  int most_ = 0;
  std::unique_ptr<MeshObject> object_;
};

}  // namespace desert_sim
