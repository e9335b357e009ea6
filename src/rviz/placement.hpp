#pragma once
/// Where things stand in rviz's scene, and where its view looks to.

#include <OgreQuaternion.h>
#include <OgreVector3.h>
#include <tf2/LinearMath/Transform.h>

#include <string>

namespace rviz {
class DisplayContext;
}

namespace desert_sim {

/// The latest transform from `frame` to the fixed frame, in double precision, which rviz's own transforms do
/// not have: coordinates of a map projection have millions of metres. False if tf does not know it.
bool transform_to_fixed_frame(const rviz::DisplayContext& context, const std::string& frame,
                              tf2::Transform& transform);

Ogre::Vector3 to_ogre(const tf2::Vector3& v);
Ogre::Quaternion to_ogre(const tf2::Quaternion& q);

/// Turns the present view to a point of the fixed frame, from where a terrain of this diagonal is seen whole.
/// A view without focal point and distance stays as it is.
void show_in_view(rviz::DisplayContext& context, const Ogre::Vector3& point, double diagonal);

}  // namespace desert_sim
