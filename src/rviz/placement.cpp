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

namespace {

/// The property of this name; null if there is none.
rviz::Property* child_named(const rviz::Property& parent, const QString& name) {
  for (int n = 0; n < parent.numChildren(); ++n)
    if (parent.childAt(n)->getName() == name) return parent.childAt(n);
  return nullptr;
}

}  // namespace

std::optional<Placement> corner_of(const LayerMap::Info& map, const rviz::DisplayContext& context) {
  tf2::Transform fixed_from_map;
  fixed_from_map.setIdentity();
  const std::string fixed = context.getFixedFrame().toStdString();
  try {
    if (fixed != map.frame)
      tf2::fromMsg(context.getFrameManager()
                       ->getTF2BufferPtr()
                       ->lookupTransform(fixed, map.frame, ros::Time(0))
                       .transform,
                   fixed_from_map);
  } catch (const tf2::TransformException&) {
    return std::nullopt;
  }
  const tf2::Vector3 corner = fixed_from_map * tf2::Vector3(map.origin_x, map.origin_y, 0);
  const tf2::Quaternion turned = fixed_from_map.getRotation();
  return Placement{{static_cast<Ogre::Real>(corner.x()), static_cast<Ogre::Real>(corner.y()),
                    static_cast<Ogre::Real>(corner.z())},
                   {static_cast<Ogre::Real>(turned.w()), static_cast<Ogre::Real>(turned.x()),
                    static_cast<Ogre::Real>(turned.y()), static_cast<Ogre::Real>(turned.z())}};
}

std::string missing_transform(const LayerMap::Info& map, const rviz::DisplayContext& context) {
  return "No transform from the terrain's frame [" + map.frame + "] to the fixed frame [" +
         context.getFixedFrame().toStdString() + "]: choose [" + map.frame +
         "] as Fixed Frame, or let a node publish the transform.";
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
