#include "src/rviz/draped_line_display.hpp"

#include <OgreRenderQueue.h>
#include <OgreSceneNode.h>
#include <rviz/display_context.h>
#include <rviz/properties/bool_property.h>
#include <rviz/properties/color_property.h>
#include <rviz/properties/float_property.h>
#include <rviz/properties/int_property.h>
#include <rviz/properties/ros_topic_property.h>
#include <rviz/properties/string_property.h>

#include "src/core/error.hpp"
#include "src/render/drawable.hpp"
#include "src/rviz/materials.hpp"
#include "src/rviz/names.hpp"
#include "src/rviz/processor_time.hpp"

namespace desert_sim {

using rviz::StatusProperty;

namespace {

constexpr float opacity_behind = 0.3F;

render::Colour to_colour(const QColor& c) {
  return {static_cast<float>(c.redF()), static_cast<float>(c.greenF()), static_cast<float>(c.blueF())};
}

}  // namespace

DrapedLineDisplay::DrapedLineDisplay(const QString& topic, const QString& datatype,
                                     const QString& description, const QColor& colour) {
  topic_ = new rviz::RosTopicProperty("Topic", topic, datatype, description, this, SLOT(subscribe()));
  node_ = new rviz::StringProperty("Node", "desert_sim",
                                   "The simulator's node on whose terrain the line is laid.", this,
                                   SLOT(subscribe()));
  colour_ = new rviz::ColorProperty("Colour", colour, "Colour of the line.", this, SLOT(update_look()));
  width_ = new rviz::IntProperty("Line Width", 4, "Width of the line [pixels].", this, SLOT(update_look()));
  width_->setMin(1);
  width_->setMax(10);
  height_ = new rviz::FloatProperty("Height", 0.05F, "How far the line is above the ground [m].", this,
                                    SLOT(update_look()));
  legend_wanted_ = new rviz::BoolProperty(
      "Legend", true, "Show the colour and the name of this display in the picture.", this);
}

DrapedLineDisplay::~DrapedLineDisplay() {
  if (legend_) legend_->hide(this);
  seen_.reset();
  behind_.reset();
}

// ---- what rviz calls ----

void DrapedLineDisplay::onInitialize() {
  terrain_ = std::make_unique<TerrainPicker>(*context_);
  legend_ = LineLegend::shared();
  update_look();
}

void DrapedLineDisplay::onEnable() { subscribe(); }
void DrapedLineDisplay::onDisable() { unsubscribe(); }

void DrapedLineDisplay::reset() {
  Display::reset();
  if (isEnabled()) subscribe();
}

void DrapedLineDisplay::setTopic(const QString& topic, const QString&) { topic_->setString(topic); }

void DrapedLineDisplay::update(float, float) {
  const double begin = processor_seconds();
  if (std::optional<Line> newest = take()) {
    line_ = *std::move(newest);
    changed_ = true;
  }
  if (terrain_->update()) {
    scene_node_->setPosition(terrain_->corner().position);
    scene_node_->setOrientation(terrain_->corner().orientation);
    if (needs_building()) build();
  }
  if (legend_wanted_->getBool() && !line_.points.empty())
    legend_->show(this, getNameStd(), to_colour(colour_->getColor()));
  else
    legend_->hide(this);
  report();
  frame_milliseconds_ = 1e3 * (processor_seconds() - begin);
}

// ---- the line ----

void DrapedLineDisplay::subscribe() {
  if (!initialized() || !isEnabled()) return;
  unsubscribe();
  clearStatuses();
  statuses_.clear();
  try {
    receive(full_name(topic_->getTopicStd(), "topic"));
    terrain_->follow(node_->getStdString());
    subscribed_ = true;
  } catch (const ConfigError& error) {
    statuses_.set(StatusProperty::Error, "Topic", std::string(error.what()) + ". Choose another Topic.");
  }
}

void DrapedLineDisplay::unsubscribe() {
  subscribed_ = false;
  receive("");
  line_ = {};
  ground_.reset();
  if (!terrain_) return;
  terrain_->follow("");
  seen_->set_mesh({});
  behind_->set_mesh({});
  legend_->hide(this);
}

void DrapedLineDisplay::update_look() {
  if (!terrain_) return;
  const auto line = [this](const Ogre::MaterialPtr& material) {
    auto object = std::make_unique<MeshObject>(scene_node_, material, Ogre::RenderOperation::OT_LINE_LIST);
    object->setRenderQueueGroup(Ogre::RENDER_QUEUE_6);  // over water
    return object;
  };
  behind_ = line(materials::lines_behind(width_->getInt()));
  seen_ = line(materials::lines(width_->getInt()));
  changed_ = true;
}

/// Whether the line, the ground, or what is between their frames has changed. False and a status if tf does
/// not know that.
bool DrapedLineDisplay::needs_building() {
  if (line_.frame.empty() && line_.points.empty()) return std::exchange(changed_, false);
  const std::string& terrain = terrain_->map()->info().frame;
  const std::optional<tf2::Transform> transform = transform_between(terrain, line_.frame, *context_);
  if (!transform) {
    statuses_.set(StatusProperty::Error, "Transform",
                  "No transform from the line's frame [" + line_.frame + "] to the terrain's [" + terrain +
                      "]: let a node publish it.");
    return false;
  }
  statuses_.set(StatusProperty::Ok, "Transform", "[" + line_.frame + "]");
  const bool moved = !(*transform == terrain_from_line_);
  terrain_from_line_ = *transform;
  return changed_ || moved || ground_ != terrain_->map() || exaggeration_ != terrain_->exaggeration();
}

void DrapedLineDisplay::build() {
  changed_ = false;
  ground_ = terrain_->map();
  exaggeration_ = terrain_->exaggeration();
  const LayerMap::Info& info = ground_->info();
  std::vector<render::Place> places;
  places.reserve(line_.points.size());
  for (const render::Place& p : line_.points) {
    const tf2::Vector3 at = terrain_from_line_ * tf2::Vector3(p.x, p.y, 0);
    const render::Place place{at.x() - info.origin_x, at.y() - info.origin_y};
    if (render::is_drawable(place.x) && render::is_drawable(place.y)) places.push_back(place);
  }
  std::vector<render::Point> points = render::drape(terrain_->field(), places);
  for (render::Point& p : points) p.z() += static_cast<double>(height_->getFloat()) / exaggeration_;
  const render::Colour colour = to_colour(colour_->getColor());
  render::Mesh mesh;
  render::append_line(mesh, points, exaggeration_, render::pack(colour));
  seen_->set_mesh(mesh);
  for (render::Vertex& v : mesh.vertices) v.colour = render::pack(colour, opacity_behind);
  behind_->set_mesh(mesh);
  ++built_lines_;
}

// ---- status ----

void DrapedLineDisplay::report() {
  if (!subscribed_) return;
  const std::string topic = topic_->getTopicStd();
  if (!line_.points.empty())
    statuses_.set(StatusProperty::Ok, "Topic", std::to_string(line_.points.size()) + " points");
  else if (connected())
    statuses_.set(StatusProperty::Ok, "Topic", "No line on " + topic + " at present.");
  else
    statuses_.set(StatusProperty::Warn, "Topic", "Nobody publishes " + topic + " yet.");
  if (terrain_->problem().empty())
    statuses_.set(StatusProperty::Ok, "Ground", "of " + node_->getStdString());
  else
    statuses_.set(StatusProperty::Error, "Ground", terrain_->problem());
}

}  // namespace desert_sim
