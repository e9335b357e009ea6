#include "src/rviz/terrain_display.hpp"

#include <OgreSceneNode.h>
#include <OgreViewport.h>
#include <rviz/display_context.h>
#include <rviz/display_group.h>
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

void show_legend(Legend& legend, const OverlayProperties& properties, const render::Overlay& overlay) {
  if (overlay.active() && properties.legend())
    legend.show(properties.title(), overlay);
  else
    legend.hide();
}

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

TerrainDisplay::TerrainDisplay() : properties_(std::make_unique<TerrainProperties>(this)) {
  connect(properties_.get(), SIGNAL(topic_changed()), this, SLOT(subscribe()));
  connect(properties_.get(), SIGNAL(look_changed()), this, SLOT(update_look()));
  connect(properties_.get(), SIGNAL(views_changed()), this, SLOT(subscribe_views()));
  connect(properties_.get(), SIGNAL(limits_changed()), this, SLOT(update_limits()));
}

TerrainDisplay::~TerrainDisplay() {
  if (!initialized()) return;
  unsubscribe();
  plants_view_.reset();
  wind_view_.reset();
  ripples_view_.reset();
  near_ground_.reset();
  scene_.reset();
  sky_.reset();
}

// ---- what rviz calls ----

void TerrainDisplay::onInitialize() {
  scene_ = std::make_unique<TerrainScene>(scene_node_);
  ripples_view_ = std::make_unique<RipplesView>(scene_->ground_material());
  near_ground_ = std::make_unique<NearGroundView>(*scene_);
  level_node_ = scene_node_->createChildSceneNode();
  plants_view_ = std::make_unique<PlantsView>(level_node_, scene_->ground_material());
  wind_view_ = std::make_unique<WindView>(scene_->node());
  legend_ = std::make_unique<Legend>();
  second_legend_ = std::make_unique<Legend>();
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

void TerrainDisplay::setTopic(const QString& topic, const QString&) { properties_->topic().setString(topic); }

void TerrainDisplay::update(float, float) {
  const double begin = render::RebuildQueue::steady_seconds(), begin_of_work = processor_seconds();
  frame_messages_ = 0;
  if (const Appearance::ConstPtr appearance = appearance_.take()) properties_->see(*appearance);
  const bool incomplete = take_changes();
  rviz::ViewManager* const views = context_->getViewManager();
  if (maps_.count("elevation") && place() && views->getCurrent()) {
    update_views();
    if (fit_pending_ && properties_->fit_view()) fit_view();
    fit_pending_ = false;
    const Ogre::Camera* const camera = views->getCurrent()->getCamera();
    if (camera && properties_->sky())
      sky_->show(*camera);
    else
      sky_->hide();
    const Ogre::Viewport* const viewport = camera ? camera->getViewport() : nullptr;
    if (viewport) {
      const int height = viewport->getActualHeight();
      update_plants(*camera, height);
      near_ground_->update(*camera, height, maps_, properties_->limits().pixels, ripples_view_->wavelength());
      const double spent = render::RebuildQueue::steady_seconds() - begin;
      scene_->update(*camera, height, properties_->budget() - spent, incomplete);
    }
  }
  counts_ = scene_->counts();
  report();
  frame_milliseconds_ = 1e3 * (processor_seconds() - begin_of_work);
  if (counts_.waiting > 0 || plants_view_->waiting() > 0) context_->queueRender();
}

// ---- properties ----

std::string TerrainDisplay::node() const { return source_ ? source_->node() : ""; }

double TerrainDisplay::vertical_exaggeration() const { return properties_->vertical_exaggeration(); }

void TerrainDisplay::subscribe() {
  if (!initialized() || !isEnabled()) return;
  unsubscribe();
  clearStatuses();
  statuses_.clear();
  try {
    source_ = std::make_unique<TerrainSource>(properties_->topic().getTopicStd());
  } catch (const ConfigError& error) {
    set_status(
        {StatusProperty::Error, "Topic", std::string(error.what()) + ". Choose another Elevation Topic."});
    return;
  }
  appearance_.subscribe(threaded_nh_, source_->node() + "/appearance");
  update_look();
  subscribe_views();
}

void TerrainDisplay::unsubscribe() {
  source_.reset();
  maps_.clear();
  properties_->forget_maps();
  near_ground_->follow("");
  appearance_.subscribe(threaded_nh_, "");
  scene_->clear();
  legend_->hide();
  second_legend_->hide();
  plants_view_->subscribe(threaded_nh_, "");
  wind_view_->subscribe(threaded_nh_, "");
  ripples_view_->subscribe(threaded_nh_, "");
}

void TerrainDisplay::subscribe_views() {
  if (!source_) return;
  const std::string node = source_->node();
  const TerrainProperties& shown = *properties_;
  plants_view_->subscribe(threaded_nh_, shown.plants() ? node + "/plants" : "");
  wind_view_->subscribe(threaded_nh_, shown.wind() ? node + "/wind" : "");
  ripples_view_->subscribe(threaded_nh_, shown.ripples() ? node + "/micro_relief" : "");
  near_ground_->follow(shown.micro_relief() ? node : "");
}

void TerrainDisplay::update_look() {
  if (!scene_) return;
  const render::TerrainLook look = properties_->look();
  scene_->set_look(look);
  near_ground_->touch();
  counts_ = scene_->counts();  // blocks wait from now on, not from the next frame on
  if (!source_) return;
  std::vector<std::string> layers = layers_for(look);
  std::replace(layers.begin(), layers.end(), std::string(cost_layer), source_of_layer(cost_layer));
  source_->set_layers(layers);
  keep_layers(layers, maps_);
  scene_->set_window(windows_of(maps_, properties_->reference()));
  show_legend(*legend_, properties_->overlay(), look.overlay);
  show_legend(*second_legend_, properties_->second(), look.second);
}

void TerrainDisplay::update_limits() {
  if (scene_) scene_->set_limits(properties_->limits());
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
      properties_->see(*one.map);
      for (const render::CellRectangle& cells : one.changed) scene_->touch(cells);
    }
  }
  if (changes.empty()) return held_ = false;
  scene_->set_window(windows_of(maps_, properties_->reference()));
  const auto elevation = maps_.find("elevation"), sand = maps_.find("sand_depth");
  const bool behind = elevation != maps_.end() && sand != maps_.end() &&
                      sand->second->info().step < elevation->second->info().step;
  return held_ = behind && !held_;
}

void TerrainDisplay::take_elevation(const CollectedChange& change_of_elevation) {
  const LayerMap::Info& info = change_of_elevation.map->info();
  if (change_of_elevation.replaced) {
    properties_->forget_maps();
    near_ground_->forget();
    fit_pending_ = true;
    scene_->set_grid(static_cast<int>(info.width), static_cast<int>(info.height), info.cell_size,
                     windows_of(maps_, properties_->reference()));
  }
  for (const render::CellRectangle& cells : change_of_elevation.changed) scene_->touch(cells);
  properties_->see_elevation(change_of_elevation.map);
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
      static_cast<double>(usual_height(elevation)) * vertical_exaggeration() - below * diagonal;
  const Ogre::Vector3 from_corner(static_cast<Ogre::Real>(width / 2), static_cast<Ogre::Real>(height / 2),
                                  static_cast<Ogre::Real>(focus));
  show_in_view(*context_, scene_node_->getPosition() + scene_node_->getOrientation() * from_corner, diagonal);
}

void TerrainDisplay::update_views() {
  const LayerMap& elevation = *maps_.at("elevation");
  wind_view_->update(elevation, properties_->most_arrows());
  ripples_view_->update();
}

void TerrainDisplay::update_plants(const Ogre::Camera& camera, int viewport_height) {
  constexpr double share = 0.4;  // of the time of a frame
  const LayerMap::Info& info = maps_.at("elevation")->info();
  PlantsView::Settings settings;
  settings.corner_x = info.origin_x;
  settings.corner_y = info.origin_y;
  settings.width = info.width * info.cell_size;
  settings.height = info.height * info.cell_size;
  settings.cell_size = info.cell_size;
  settings.exaggeration = vertical_exaggeration();
  settings.most = static_cast<std::size_t>(properties_->most_plants());
  settings.seconds = share * properties_->budget();
  plants_view_->update(camera, viewport_height, settings);
}

// ---- status ----

void TerrainDisplay::report() {
#ifndef __OPTIMIZE__
  set_status({StatusProperty::Warn, "Build",
              "The plugin was built without optimisation and is slow: build with "
              "-DCMAKE_BUILD_TYPE=Release."});
#endif
  if (!source_) return;
  set_status(status_of_topic(properties_->topic().getTopicStd(), source_->client(), maps_));
  const render::TerrainLook& look = scene_->look();
  set_status(status_of_overlay("Overlay", look.overlay.layer, properties_->overlay().title(), maps_));
  set_status(status_of_overlay("Second Overlay", look.second.layer, properties_->second().title(), maps_));
  if (look.shading != render::Shading::sun)
    set_status(status_of_overlay("Shading", render::illumination_layer, render::illumination_layer, maps_));
  else
    set_status({StatusProperty::Ok, "Shading", "sun"});
  set_status({near_ground_->failed() ? StatusProperty::Warn : StatusProperty::Ok, "Micro Relief",
              near_ground_->status().empty() ? "none: the view is not close to the ground"
                                             : near_ground_->status()});
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
