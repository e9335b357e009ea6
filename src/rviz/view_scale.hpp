#pragma once
/// How large things are in rviz's view.

#include <OgreVector3.h>

#include <optional>

#include "src/render/view.hpp"

namespace Ogre {
class Camera;
class Node;
class Viewport;
}  // namespace Ogre
namespace rviz {
class ViewController;
}

namespace desert_sim {

/// What the camera sees in the frame of a node, with a viewport so high [pixels].
render::View view_of(const Ogre::Camera& camera, int viewport_height, const Ogre::Node& frame);

/// The size of a pixel at a point of the scene [m].
float metres_per_pixel(const Ogre::Viewport& viewport, const Ogre::Vector3& point);

/// What the view looks at: its focal point if it has a distance from one, else where the middle of the
/// picture meets the plane z = 0 of the fixed frame; empty if it does not.
std::optional<Ogre::Vector3> focus_of(const rviz::ViewController& view);

}  // namespace desert_sim
