#pragma once
/// Where things stand in rviz's scene, and where its view looks to.

#include <OgreQuaternion.h>
#include <OgreVector3.h>
#include <tf2/LinearMath/Transform.h>

#include <QString>
#include <optional>
#include <string>

#include "include/desert_sim/client/layer_map.hpp"

namespace rviz {
class DisplayContext;
class Property;
}  // namespace rviz

namespace desert_sim {

/// Where something is in the fixed frame.
struct Placement {
  Ogre::Vector3 position = Ogre::Vector3::ZERO;
  Ogre::Quaternion orientation = Ogre::Quaternion::IDENTITY;
};

/// The latest transform of points from one frame to another; empty if tf does not know it.
std::optional<tf2::Transform> transform_between(const std::string& to, const std::string& from,
                                                const rviz::DisplayContext& context);

/// A pose in some frame, by the latest transform of that. It is worked out in double precision, which rviz's
/// own transforms do not have: coordinates of a map projection have millions of metres. Empty if tf does not
/// know the transform; missing_transform() says what to do.
std::optional<Placement> placement_of(const std::string& frame, const tf2::Transform& pose,
                                      const rviz::DisplayContext& context);
/// `what` has this frame: "terrain".
std::string missing_transform(const std::string& what, const std::string& frame,
                              const rviz::DisplayContext& context);

/// The south-west corner of a map's grid.
std::optional<Placement> corner_of(const LayerMap::Info& map, const rviz::DisplayContext& context);
std::string missing_transform(const LayerMap::Info& map, const rviz::DisplayContext& context);

/// The property of this name, of a view for example; null if there is none.
rviz::Property* child_named(const rviz::Property& parent, const QString& name);

/// Turns the present view to a point of the fixed frame, from where a terrain of this diagonal is seen whole.
/// A view without focal point and distance stays as it is.
void show_in_view(rviz::DisplayContext& context, const Ogre::Vector3& point, double diagonal);

}  // namespace desert_sim
