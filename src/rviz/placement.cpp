#include "src/rviz/placement.hpp"

#include <rviz/display_context.h>
#include <rviz/frame_manager.h>
#include <rviz/properties/tf_frame_property.h>
#include <rviz/properties/vector_property.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>
#include <tf2_geometry_msgs/tf2_geometry_msgs.h>
#include <tf2_ros/buffer.h>

namespace desert_sim {

rviz::Property* child_named(const rviz::Property& parent, const QString& name) {
  for (int n = 0; n < parent.numChildren(); ++n)
    if (parent.childAt(n)->getName() == name) return parent.childAt(n);
  return nullptr;
}

std::optional<tf2::Transform> transform_between(const std::string& to, const std::string& from,
                                                const rviz::DisplayContext& context) {
  tf2::Transform transform;
  transform.setIdentity();
  if (to == from) return transform;
  try {
    tf2::fromMsg(
        context.getFrameManager()->getTF2BufferPtr()->lookupTransform(to, from, ros::Time(0)).transform,
        transform);
  } catch (const tf2::TransformException&) {
    return std::nullopt;
  }
  return transform;
}

std::optional<Placement> placement_of(const std::string& frame, const tf2::Transform& pose,
                                      const rviz::DisplayContext& context) {
  const auto fixed_from_frame = transform_between(context.getFixedFrame().toStdString(), frame, context);
  if (!fixed_from_frame) return std::nullopt;
  const tf2::Transform placed = *fixed_from_frame * pose;
  const tf2::Vector3& at = placed.getOrigin();
  const tf2::Quaternion turned = placed.getRotation();
  return Placement{
      {static_cast<Ogre::Real>(at.x()), static_cast<Ogre::Real>(at.y()), static_cast<Ogre::Real>(at.z())},
      {static_cast<Ogre::Real>(turned.w()), static_cast<Ogre::Real>(turned.x()),
       static_cast<Ogre::Real>(turned.y()), static_cast<Ogre::Real>(turned.z())}};
}

std::optional<Placement> corner_of(const LayerMap::Info& map, const rviz::DisplayContext& context) {
  return placement_of(
      map.frame, tf2::Transform(tf2::Quaternion::getIdentity(), {map.origin_x, map.origin_y, 0}), context);
}

std::string missing_transform(const std::string& what, const std::string& frame,
                              const rviz::DisplayContext& context) {
  return "No transform from the " + what + "'s frame [" + frame + "] to the fixed frame [" +
         context.getFixedFrame().toStdString() + "]: choose [" + frame +
         "] as Fixed Frame, or let a node publish the transform.";
}

std::string missing_transform(const LayerMap::Info& map, const rviz::DisplayContext& context) {
  return missing_transform("terrain", map.frame, context);
}

void show_in_view(rviz::DisplayContext& context, const Ogre::Vector3& point, double diagonal) {
  constexpr double distances = 1.0;  // of the diagonal: rviz's cameras see 45 degrees
  const rviz::ViewController* const view = context.getViewManager()->getCurrent();
  if (!view) return;
  rviz::Property* const distance = child_named(*view, "Distance");
  auto* const focal_point = dynamic_cast<rviz::VectorProperty*>(child_named(*view, "Focal Point"));
  auto* const target = dynamic_cast<rviz::TfFrameProperty*>(child_named(*view, "Target Frame"));
  Ogre::Vector3 position;
  Ogre::Quaternion orientation;
  if (!distance || !focal_point || !target ||
      !context.getFrameManager()->getTransform(target->getFrameStd(), ros::Time(), position, orientation))
    return;
  focal_point->setVector(orientation.Inverse() * (point - position));
  distance->setValue(static_cast<float>(distances * diagonal));
}

}  // namespace desert_sim
