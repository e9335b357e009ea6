#pragma once
/// Where things stand in rviz's scene, and where its view looks to.

#include <OgreQuaternion.h>
#include <OgreVector3.h>

#include <optional>
#include <string>

#include "include/desert_sim/client/layer_map.hpp"

namespace rviz {
class DisplayContext;
}

namespace desert_sim {

/// Where something is in the fixed frame.
struct Placement {
  Ogre::Vector3 position = Ogre::Vector3::ZERO;
  Ogre::Quaternion orientation = Ogre::Quaternion::IDENTITY;
};

/// The south-west corner of a map's grid, by the latest transform of its frame. It is worked out in double
/// precision, which rviz's own transforms do not have: coordinates of a map projection have millions of
/// metres. Empty if tf does not know the transform; missing_transform() says what to do.
std::optional<Placement> corner_of(const LayerMap::Info& map, const rviz::DisplayContext& context);
std::string missing_transform(const LayerMap::Info& map, const rviz::DisplayContext& context);

/// Turns the present view to a point of the fixed frame, from where a terrain of this diagonal is seen whole.
/// A view without focal point and distance stays as it is.
void show_in_view(rviz::DisplayContext& context, const Ogre::Vector3& point, double diagonal);

}  // namespace desert_sim
