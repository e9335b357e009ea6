#include "src/rviz/terrain_picker.hpp"

#include <OgreCamera.h>
#include <OgreViewport.h>
#include <rviz/display_context.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>
#include <rviz/viewport_mouse_event.h>

#include <map>

#include "src/core/error.hpp"
#include "src/rviz/names.hpp"
#include "src/rviz/terrain_display.hpp"

namespace desert_sim {

namespace {

render::Point to_point(const Ogre::Vector3& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

/// The client of a node's elevation, which all pickers of the process share.
std::shared_ptr<TerrainClient> client_of(const std::string& node) {
  static std::map<std::string, std::weak_ptr<TerrainClient>> clients;
  std::shared_ptr<TerrainClient> client = clients[node].lock();
  if (client) return client;
  TerrainClient::Options options;
  options.node = node;
  client = std::make_shared<TerrainClient>(ros::NodeHandle(), options);
  clients[node] = client;
  return client;
}

}  // namespace

void TerrainPicker::follow(const std::string& node) {
  map_.reset();
  field_ = {};
  client_.reset();
  node_ = node;
  if (node.empty()) return;
  try {
    node_ = full_name(node, "node");
    client_ = client_of(node_);
  } catch (const ConfigError& error) {
    problem_ = error.what();
  }
}

bool TerrainPicker::update() {
  if (!client_) return false;
  const std::shared_ptr<const ElevationMap> newest = client_->map();
  if (!newest) {
    problem_ = "There is no terrain of " + node_ + " yet: start the node, or change the tool's Node.";
    return false;
  }
  const LayerMap::Info& info = newest->info();
  const std::optional<Placement> corner = corner_of(info, context_);
  if (!corner) {
    problem_ = missing_transform(info, context_);
    return false;
  }
  corner_ = *corner;
  exaggeration_ = exaggeration_of_display();
  if (newest != map_) {
    map_ = newest;
    field_.width = static_cast<int>(info.width);
    field_.height = static_cast<int>(info.height);
    field_.cell_size = info.cell_size;
    field_.at = [map = map_.get()](int x, int y) {
      return map->at(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
    };
  }
  problem_.clear();
  return true;
}

std::optional<render::Point> TerrainPicker::hover(const rviz::ViewportMouseEvent& event) {
  if (event.type == QEvent::Leave || !update()) return std::nullopt;
  return pick(event);
}

bool TerrainPicker::turns_view(rviz::ViewportMouseEvent& event) {
  return event.alt() || event.middle() || event.right() || event.middleUp() || event.rightUp();
}

void TerrainPicker::give_to_view(rviz::ViewportMouseEvent& event) const {
  if (rviz::ViewController* const view = context_.getViewManager()->getCurrent())
    view->handleMouseEvent(event);
}

std::optional<render::Point> TerrainPicker::pick(const rviz::ViewportMouseEvent& event) const {
  const Ogre::Viewport& viewport = *event.viewport;
  const auto part = [](int position, int size) {
    return static_cast<Ogre::Real>(position) / static_cast<Ogre::Real>(size);
  };
  const Ogre::Ray seen = viewport.getCamera()->getCameraToViewportRay(
      part(event.x, viewport.getActualWidth()), part(event.y, viewport.getActualHeight()));
  const Ogre::Quaternion turn = corner_.orientation.Inverse();
  render::Ray ray{to_point(turn * (seen.getOrigin() - corner_.position)),
                  to_point(turn * seen.getDirection())};
  ray.origin.z() /= exaggeration_;
  ray.direction.z() /= exaggeration_;
  return render::first_hit(field_, ray);
}

render::Place TerrainPicker::in_terrain_frame(const render::Point& point) const {
  return {point.x() + map_->info().origin_x, point.y() + map_->info().origin_y};
}

/// 1 if no display shows this terrain.
double TerrainPicker::exaggeration_of_display() const {
  const TerrainDisplay* const display = terrain_display(context_, node_);
  return display ? display->vertical_exaggeration() : 1;
}

}  // namespace desert_sim
