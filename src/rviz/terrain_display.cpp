#include "src/rviz/terrain_display.hpp"

#include <OgreSceneNode.h>
#include <OgreViewport.h>
#include <rviz/display_context.h>
#include <rviz/display_group.h>
#include <rviz/properties/bool_property.h>
#include <rviz/properties/float_property.h>
#include <rviz/properties/int_property.h>
#include <rviz/properties/ros_topic_property.h>
#include <rviz/render_panel.h>
#include <rviz/view_manager.h>

#include <algorithm>
#include <cmath>
#include <pluginlib/class_list_macros.hpp>

#include "src/core/error.hpp"
#include "src/rviz/placement.hpp"
#include "src/rviz/processor_time.hpp"

namespace desert_sim {

using rviz::StatusProperty;

namespace {

/// The mean of known cells here and there, which a hill in the middle hardly raises; 0 if there are none.
float usual_height(const LayerMap& elevation) {
  constexpr std::uint32_t count = 8;
  float sum = 0, known = 0;
  for (std::uint32_t n = 0; n < count * count; ++n) {
    const float height = elevation.at((2 * (n % count) + 1) * elevation.info().width / (2 * count),
                                      (2 * (n / count) + 1) * elevation.info().height / (2 * count));
    if (std::isnan(height)) continue;
    sum += height;
    ++known;
  }
  return known > 0 ? sum / known : 0;
}

}  // namespace

TerrainDisplay::TerrainDisplay() {
  topic_ = new rviz::RosTopicProperty(
      "Elevation Topic", "desert_sim/elevation",
      QString::fromStdString(ros::message_traits::datatype<ElevationGrid>()),
      "Keyframes of the terrain. Updates, layers, plants and wind are taken from the same node.", this,
      SLOT(subscribe()));
  exaggeration_ = new rviz::FloatProperty("Vertical Exaggeration", 1,
                                          "Factor by which heights are multiplied when they are drawn.", this,
                                          SLOT(update_look()));
  exaggeration_->setMin(0.01F);
  exaggeration_->setMax(100);
  materials_ =
      new rviz::BoolProperty("Materials", true, "Colour rock, soil, sand, wet ground and plants as such.",
                             this, SLOT(update_look()));
  water_ =
      new rviz::BoolProperty("Water", true, "Show water, if the terrain has it.", this, SLOT(update_look()));
  shadows_ =
      new rviz::BoolProperty("Shadows", true, "Let dunes and hills cast shadows.", this, SLOT(update_look()));
  ripples_ =
      new rviz::BoolProperty("Ripples", true, "Show wind ripples of ~micro_relief on sand near the camera.",
                             this, SLOT(subscribe_views()));
  sky_shown_ = new rviz::BoolProperty(
      "Sky", true, "Show sky and sun behind the terrain, in views with a perspective.", this);
  overlay_ = std::make_unique<OverlayProperties>(this);
  connect(overlay_.get(), SIGNAL(changed()), this, SLOT(update_look()));
  contours_ = new rviz::FloatProperty(
      "Contour Interval", 0, "Contour lines are so many metres apart; 0: none.", this, SLOT(update_look()));
  contours_->setMin(0);
  plants_ =
      new rviz::BoolProperty("Plants", true, "Show the plants of ~plants.", this, SLOT(subscribe_views()));
  most_plants_ = new rviz::IntProperty("Most Plants", 10000, "The widest so many are shown.", plants_);
  most_plants_->setMin(1);
  wind_ = new rviz::BoolProperty("Wind", false, "Show the wind of ~wind as arrows on the ground.", this,
                                 SLOT(subscribe_views()));
  most_arrows_ = new rviz::IntProperty("Most Arrows", 1000, "At most so many arrows.", wind_);
  most_arrows_->setMin(1);
  quad_pixels_ = new rviz::FloatProperty(
      "Quad Size", 4, "A quad of the mesh takes about so many pixels, if the terrain has cells enough.", this,
      SLOT(update_limits()));
  quad_pixels_->setMin(1);
  quad_pixels_->setMax(64);
  triangles_ = new rviz::IntProperty("Most Triangles", 40000,
                                     "At most so many triangles of ground are in the picture.", this,
                                     SLOT(update_limits()));
  triangles_->setMin(1000);
  budget_ = new rviz::FloatProperty(
      "Time per Frame", 20,
      "At most so many milliseconds of each frame go into building blocks that changed.", this);
  budget_->setMin(1);
  budget_->setMax(1000);
  fit_view_ = new rviz::BoolProperty(
      "Fit View", false,
      "Show the whole of each terrain that comes, if the view has a focal point and a distance.", this);
}

TerrainDisplay::~TerrainDisplay() {
  if (!initialized()) return;
  unsubscribe();
  plants_view_.reset();
  wind_view_.reset();
  ripples_view_.reset();
  scene_.reset();
  sky_.reset();
}

// ---- what rviz calls ----

void TerrainDisplay::onInitialize() {
  scene_ = std::make_unique<TerrainScene>(scene_node_);
  ripples_view_ = std::make_unique<RipplesView>(scene_->ground_material());
  level_node_ = scene_node_->createChildSceneNode();
  plants_view_ = std::make_unique<PlantsView>(level_node_);
  wind_view_ = std::make_unique<WindView>(scene_->node());
  legend_ = std::make_unique<Legend>();
  sky_ = std::make_unique<Sky>(scene_manager_->getRootSceneNode());
  update_look();
  update_limits();
}

void TerrainDisplay::onEnable() { subscribe(); }

void TerrainDisplay::onDisable() {
  unsubscribe();
  sky_->hide();
  counts_ = scene_->counts();
}

void TerrainDisplay::reset() {
  Display::reset();
  statuses_.clear();
  if (isEnabled()) subscribe();
}

void TerrainDisplay::setTopic(const QString& topic, const QString&) { topic_->setString(topic); }

void TerrainDisplay::update(float, float) {
  const double begin = render::RebuildQueue::steady_seconds(), begin_of_work = processor_seconds();
  frame_messages_ = 0;
  const bool incomplete = take_changes();
  rviz::ViewManager* const views = context_->getViewManager();
  if (maps_.count("elevation") && place() && views->getCurrent()) {
    update_views();
    if (fit_pending_ && fit_view_->getBool()) fit_view();
    fit_pending_ = false;
    const Ogre::Camera* const camera = views->getCurrent()->getCamera();
    if (camera && sky_shown_->getBool())
      sky_->show(*camera);
    else
      sky_->hide();
    const Ogre::Viewport* const viewport = camera ? camera->getViewport() : nullptr;
    const double spent = render::RebuildQueue::steady_seconds() - begin;
    const double budget = 1e-3 * static_cast<double>(budget_->getFloat());
    if (viewport) scene_->update(*camera, viewport->getActualHeight(), budget - spent, incomplete);
  }
  counts_ = scene_->counts();
  report();
  frame_milliseconds_ = 1e3 * (processor_seconds() - begin_of_work);
  if (counts_.waiting > 0) context_->queueRender();
}

// ---- properties ----

std::string TerrainDisplay::node() const { return source_ ? source_->node() : ""; }

double TerrainDisplay::vertical_exaggeration() const {
  return static_cast<double>(exaggeration_->getFloat());
}

void TerrainDisplay::subscribe() {
  if (!initialized() || !isEnabled()) return;
  unsubscribe();
  clearStatuses();
  statuses_.clear();
  try {
    source_ = std::make_unique<TerrainSource>(topic_->getTopicStd());
  } catch (const ConfigError& error) {
    set_status(
        {StatusProperty::Error, "Topic", std::string(error.what()) + ". Choose another Elevation Topic."});
    return;
  }
  update_look();
  subscribe_views();
}

void TerrainDisplay::unsubscribe() {
  source_.reset();
  maps_.clear();
  overlay_->clear();
  scene_->clear();
  legend_->hide();
  plants_view_->subscribe(threaded_nh_, "");
  wind_view_->subscribe(threaded_nh_, "");
  ripples_view_->subscribe(threaded_nh_, "");
}

void TerrainDisplay::subscribe_views() {
  if (!source_) return;
  const std::string node = source_->node();
  plants_view_->subscribe(threaded_nh_, plants_->getBool() ? node + "/plants" : "");
  wind_view_->subscribe(threaded_nh_, wind_->getBool() ? node + "/wind" : "");
  ripples_view_->subscribe(threaded_nh_, ripples_->getBool() ? node + "/micro_relief" : "");
}

void TerrainDisplay::update_look() {
  if (!scene_) return;
  render::TerrainLook look;
  look.overlay = overlay_->overlay();
  look.materials = materials_->getBool();
  look.water = water_->getBool();
  look.shadows = shadows_->getBool();
  look.ripples = true;
  look.vertical_exaggeration = static_cast<double>(exaggeration_->getFloat());
  look.contour_interval = static_cast<double>(contours_->getFloat());
  scene_->set_look(look);
  counts_ = scene_->counts();  // blocks wait from now on, not from the next frame on
  if (!source_) return;
  std::vector<std::string> layers = layers_for(look);
  std::replace(layers.begin(), layers.end(), std::string(cost_layer), source_of_layer(cost_layer));
  source_->set_layers(layers);
  keep_layers(layers, maps_);
  scene_->set_window(windows_of(maps_, overlay_->reference()));
  if (look.overlay.active() && overlay_->legend())
    legend_->show(overlay_->title(), look.overlay);
  else
    legend_->hide();
}

void TerrainDisplay::update_limits() {
  if (scene_) scene_->set_limits({static_cast<double>(quad_pixels_->getFloat()), triangles_->getInt()});
}

// ---- the terrain ----

/// True if layers of the newest elevation are still on their way. They come in messages of their own, a
/// moment later; the scene waits a frame for them rather than build everything twice, and never two in a
/// row.
bool TerrainDisplay::take_changes() {
  if (!source_) return false;
  const std::vector<CollectedChange> changes = source_->take();
  for (const CollectedChange& one : changes) {
    const std::string& layer = one.map->info().layer;
    frame_messages_ += one.messages;
    maps_[layer] = one.map;
    if (layer == "elevation") {
      take_elevation(one);
    } else {
      overlay_->see(*one.map);
      for (const render::CellRectangle& cells : one.changed) scene_->touch(cells);
    }
  }
  if (changes.empty()) return held_ = false;
  scene_->set_window(windows_of(maps_, overlay_->reference()));
  const auto elevation = maps_.find("elevation"), sand = maps_.find("sand_depth");
  const bool behind = elevation != maps_.end() && sand != maps_.end() &&
                      sand->second->info().step < elevation->second->info().step;
  return held_ = behind && !held_;
}

void TerrainDisplay::take_elevation(const CollectedChange& change_of_elevation) {
  const LayerMap::Info& info = change_of_elevation.map->info();
  if (change_of_elevation.replaced) {
    overlay_->clear();
    fit_pending_ = true;
    scene_->set_grid(static_cast<int>(info.width), static_cast<int>(info.height), info.cell_size,
                     windows_of(maps_, overlay_->reference()));
  }
  for (const render::CellRectangle& cells : change_of_elevation.changed) scene_->touch(cells);
  overlay_->see_elevation(change_of_elevation.map);
}

/// Moves the terrain to where tf says that its frame is; false and a status if tf does not know.
bool TerrainDisplay::place() {
  const LayerMap::Info& info = maps_.at("elevation")->info();
  const std::optional<Placement> corner = corner_of(info, *context_);
  scene_node_->setVisible(corner.has_value());
  if (!corner) {
    set_status({StatusProperty::Error, "Transform", missing_transform(info, *context_)});
    return false;
  }
  set_status({StatusProperty::Ok, "Transform", "[" + info.frame + "]"});
  scene_node_->setPosition(corner->position);
  scene_node_->setOrientation(corner->orientation);
  return true;
}

void TerrainDisplay::fit_view() {
  const LayerMap& elevation = *maps_.at("elevation");
  const LayerMap::Info& info = elevation.info();
  const double width = info.width * info.cell_size, height = info.height * info.cell_size;
  const double diagonal = std::hypot(width, height);
  constexpr double below = 0.06;  // Perspective makes the near corner large: it reaches the lower edge first.
  const double focus =
      static_cast<double>(usual_height(elevation) * exaggeration_->getFloat()) - below * diagonal;
  const Ogre::Vector3 from_corner(static_cast<Ogre::Real>(width / 2), static_cast<Ogre::Real>(height / 2),
                                  static_cast<Ogre::Real>(focus));
  show_in_view(*context_, scene_node_->getPosition() + scene_node_->getOrientation() * from_corner, diagonal);
}

void TerrainDisplay::update_views() {
  const LayerMap& elevation = *maps_.at("elevation");
  const LayerMap::Info& info = elevation.info();
  plants_view_->update(info.origin_x, info.origin_y, static_cast<double>(exaggeration_->getFloat()),
                       most_plants_->getInt());
  wind_view_->update(elevation, most_arrows_->getInt());
  ripples_view_->update();
}

// ---- status ----

void TerrainDisplay::report() {
#ifndef __OPTIMIZE__
  set_status({StatusProperty::Warn, "Build",
              "The plugin was built without optimisation and is slow: build with "
              "-DCMAKE_BUILD_TYPE=Release."});
#endif
  if (!source_) return;
  const std::string& layer = scene_->look().overlay.layer;
  set_status(status_of_topic(topic_->getTopicStd(), source_->client(), maps_));
  set_status(status_of_overlay(layer, overlay_->title(), maps_));
  const auto elevation = maps_.find("elevation");
  if (elevation == maps_.end()) return;
  set_status(status_of_terrain(elevation->second->info(), counts_));
  set_status(status_of_blocks(counts_));
}

/// Qt's model of the statuses is told only what has changed.
void TerrainDisplay::set_status(const DisplayStatus& status) {
  std::string& shown = statuses_[status.name];
  if (shown == status.text) return;
  shown = status.text;
  setStatus(status.level, status.name, QString::fromStdString(status.text));
}

// ---- finding it ----

namespace {

TerrainDisplay* terrain_display_in(rviz::DisplayGroup* group, const std::string& node) {
  for (int n = 0; group && n < group->numDisplays(); ++n) {
    rviz::Display* const display = group->getDisplayAt(n);
    if (!display->isEnabled()) continue;
    auto* found = dynamic_cast<TerrainDisplay*>(display);
    if (found && found->node() == node) return found;
    found = terrain_display_in(dynamic_cast<rviz::DisplayGroup*>(display), node);
    if (found) return found;
  }
  return nullptr;
}

}  // namespace

TerrainDisplay* terrain_display(const rviz::DisplayContext& context, const std::string& node) {
  return terrain_display_in(context.getRootDisplayGroup(), node);
}

}  // namespace desert_sim

PLUGINLIB_EXPORT_CLASS(desert_sim::TerrainDisplay, rviz::Display)
