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

bool transform_to_fixed_frame(const rviz::DisplayContext& context, const std::string& frame,
                              tf2::Transform& transform) {
  transform.setIdentity();
  const std::string fixed = context.getFixedFrame().toStdString();
  if (fixed == frame) return true;
  try {
    const auto buffer = context.getFrameManager()->getTF2BufferPtr();
    tf2::fromMsg(buffer->lookupTransform(fixed, frame, ros::Time(0)).transform, transform);
    return true;
  } catch (const tf2::TransformException&) {
    return false;  // the caller's status says what to do
  }
}

Ogre::Vector3 to_ogre(const tf2::Vector3& v) {
  return {static_cast<Ogre::Real>(v.x()), static_cast<Ogre::Real>(v.y()), static_cast<Ogre::Real>(v.z())};
}

Ogre::Quaternion to_ogre(const tf2::Quaternion& q) {
  return {static_cast<Ogre::Real>(q.w()), static_cast<Ogre::Real>(q.x()), static_cast<Ogre::Real>(q.y()),
          static_cast<Ogre::Real>(q.z())};
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
