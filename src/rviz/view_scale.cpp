#include "src/rviz/view_scale.hpp"

#include <OgreCamera.h>
#include <OgreNode.h>
#include <OgrePlane.h>
#include <OgreViewport.h>
#include <rviz/view_controller.h>

#include <cmath>

#include "src/rviz/placement.hpp"

namespace desert_sim {

namespace {

Eigen::Matrix4d to_matrix(const Ogre::Matrix4& m) {
  using RowByRow = Eigen::Matrix<Ogre::Real, 4, 4, Eigen::RowMajor>;
  return Eigen::Map<const RowByRow>(m[0]).cast<double>();
}

}  // namespace

render::View view_of(const Ogre::Camera& camera, int viewport_height, const Ogre::Node& frame) {
  return {to_matrix(camera.getProjectionMatrix()),
          to_matrix(Ogre::Matrix4(camera.getViewMatrix(true)) * Ogre::Matrix4(frame._getFullTransform())),
          viewport_height};
}

float metres_per_pixel(const Ogre::Viewport& viewport, const Ogre::Vector3& point) {
  const Ogre::Camera& camera = *viewport.getCamera();
  const Ogre::Matrix4 projection = camera.getProjectionMatrix();
  const float depth = (camera.getViewMatrix() * point).z;
  const float w = projection[3][2] * depth + projection[3][3];  // 1 in orthographic views
  return 2 * std::abs(w) / (projection[1][1] * static_cast<float>(viewport.getActualHeight()));
}

std::optional<Ogre::Vector3> focus_of(const rviz::ViewController& view) {
  const Ogre::Camera* const camera = view.getCamera();
  if (!camera) return std::nullopt;
  const Ogre::Ray ahead(camera->getDerivedPosition(), camera->getDerivedDirection());
  if (const rviz::Property* const distance = child_named(view, "Distance"))
    return ahead.getPoint(distance->getValue().toFloat());
  const auto [meets, way] = ahead.intersects(Ogre::Plane(Ogre::Vector3::UNIT_Z, 0));
  return meets ? std::optional(ahead.getPoint(way)) : std::nullopt;
}

}  // namespace desert_sim
