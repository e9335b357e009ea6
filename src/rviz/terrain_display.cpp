#include "src/rviz/terrain_display.hpp"

#include <OgreSceneNode.h>
#include <OgreViewport.h>
#include <rviz/display_context.h>
#include <rviz/frame_manager.h>
#include <rviz/properties/bool_property.h>
#include <rviz/properties/float_property.h>
#include <rviz/properties/int_property.h>
#include <rviz/properties/ros_topic_property.h>
#include <rviz/render_panel.h>
#include <rviz/view_manager.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <pluginlib/class_list_macros.hpp>

#include "kernels/view/held_costs.hpp"
#include "src/core/error.hpp"
#include "src/rviz/placement.hpp"

namespace desert_sim {

using rviz::StatusProperty;

namespace {

constexpr const char* cost_layer = "cost";  // computed from traversability as ~costmap is

/// The processor time of this thread: what a frame costs also where others keep the machine busy.
double processor_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

render::CellWindow copy(const LayerMap& map, const render::CellRectangle& r) {
  return {r, map.values({static_cast<std::uint32_t>(r.x), static_cast<std::uint32_t>(r.y),
                         static_cast<std::uint32_t>(r.width), static_cast<std::uint32_t>(r.height)})};
}

render::CellWindow costs(const LayerMap& traversability, const render::CellRectangle& r) {
  std::vector<float> values = copy(traversability, r).values();
  for (float& value : values)
    if (!std::isnan(value)) value = held_costs::cost_of(value);
  return {r, std::move(values)};
}

render::CellWindow change(const LayerMap& now, const LayerMap& before, const render::CellRectangle& r) {
  std::vector<float> values = copy(now, r).values();
  const std::vector<float> others = copy(before, r).values();
  for (std::size_t n = 0; n < values.size(); ++n) values[n] -= others[n];
  return {r, std::move(values)};
}

}  // namespace

TerrainDisplay::TerrainDisplay() {
  topic_ = new rviz::RosTopicProperty(
      "Elevation Topic", "/desert_sim/elevation",
      QString::fromStdString(ros::message_traits::datatype<ElevationGrid>()),
      "Keyframes of the terrain. Updates, layers, plants and wind are taken from the same node.", this,
      SLOT(subscribe()));
  exaggeration_ = new rviz::FloatProperty(
      "Vertical Exaggeration", 1, "Heights are drawn so many times as high.", this, SLOT(update_look()));
  exaggeration_->setMin(0.01F);
  exaggeration_->setMax(100);
  materials_ =
      new rviz::BoolProperty("Materials", true, "Colour rock, soil, sand, wet ground and plants as such.",
                             this, SLOT(update_look()));
  water_ =
      new rviz::BoolProperty("Water", true, "Show water, if the terrain has it.", this, SLOT(update_look()));
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
  triangles_ = new rviz::IntProperty("Most Triangles", 60000,
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
  scene_.reset();
}

// ---- what rviz calls ----

void TerrainDisplay::onInitialize() {
  scene_ = std::make_unique<TerrainScene>(scene_node_);
  level_node_ = scene_node_->createChildSceneNode();
  plants_view_ = std::make_unique<PlantsView>(level_node_);
  wind_view_ = std::make_unique<WindView>(scene_->node());
  legend_ = std::make_unique<Legend>();
  update_look();
  update_limits();
}

void TerrainDisplay::onEnable() { subscribe(); }

void TerrainDisplay::onDisable() {
  unsubscribe();
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
  take_changes();
  rviz::ViewManager* const views = context_->getViewManager();
  if (maps_.count("elevation") && place() && views->getCurrent()) {
    update_views();
    if (fit_pending_ && fit_view_->getBool()) fit_view();
    fit_pending_ = false;
    const Ogre::Camera* const camera = views->getCurrent()->getCamera();
    const Ogre::Viewport* const viewport = camera ? camera->getViewport() : nullptr;
    const double spent = render::RebuildQueue::steady_seconds() - begin;
    const double budget = 1e-3 * static_cast<double>(budget_->getFloat());
    if (viewport) scene_->update(*camera, viewport->getActualHeight(), budget - spent);
  }
  counts_ = scene_->counts();
  report();
  frame_milliseconds_ = 1e3 * (processor_seconds() - begin_of_work);
  if (counts_.waiting > 0) context_->queueRender();
}

// ---- properties ----

std::string TerrainDisplay::elevation_topic() const { return topic_->getTopicStd(); }

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
    set_status(StatusProperty::Error, "Topic",
               std::string(error.what()) + ". Choose another Elevation Topic.");
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
}

void TerrainDisplay::subscribe_views() {
  if (!source_) return;
  const std::string node = node_of_topic(topic_->getTopicStd());
  plants_view_->subscribe(threaded_nh_, plants_->getBool() ? node + "/plants" : "");
  wind_view_->subscribe(threaded_nh_, wind_->getBool() ? node + "/wind" : "");
}

void TerrainDisplay::update_look() {
  if (!scene_) return;
  render::TerrainLook look;
  look.overlay = overlay_->overlay();
  look.materials = materials_->getBool();
  look.water = water_->getBool();
  look.vertical_exaggeration = static_cast<double>(exaggeration_->getFloat());
  look.contour_interval = static_cast<double>(contours_->getFloat());
  scene_->set_look(look);
  if (!source_) return;
  std::vector<std::string> layers = layers_for(look);
  if (look.overlay.layer == cost_layer) layers.emplace_back("traversability");
  source_->set_layers(layers);
  for (auto map = maps_.begin();
       map != maps_.end();)  // a layer that is chosen again later begins with a new keyframe
    map = std::find(layers.begin(), layers.end(), map->first) == layers.end() ? maps_.erase(map)
                                                                              : std::next(map);
  scene_->set_window(window());
  if (look.overlay.active() && overlay_->legend())
    legend_->show(overlay_->title(), look.overlay);
  else
    legend_->hide();
}

void TerrainDisplay::update_limits() {
  if (scene_) scene_->set_limits({static_cast<double>(quad_pixels_->getFloat()), triangles_->getInt()});
}

// ---- the terrain ----

void TerrainDisplay::take_changes() {
  if (!source_) return;
  const std::vector<LayerChange> changes = source_->take();
  for (const LayerChange& one : changes) {
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
  if (!changes.empty()) scene_->set_window(window());
}

void TerrainDisplay::take_elevation(const LayerChange& change_of_elevation) {
  const LayerMap::Info& info = change_of_elevation.map->info();
  if (change_of_elevation.replaced) {
    overlay_->clear();
    fit_pending_ = true;
    scene_->set_grid(static_cast<int>(info.width), static_cast<int>(info.height), info.cell_size, window());
  }
  for (const render::CellRectangle& cells : change_of_elevation.changed) scene_->touch(cells);
  overlay_->see_elevation(change_of_elevation.map);
}

/// Maps are immutable and live as long as the function does. Those of another grid than the elevation's, for
/// a moment after a terrain was loaded, do not count.
render::LayerWindow TerrainDisplay::window() const {
  return [maps = maps_, reference = overlay_->reference()](const std::string& layer,
                                                           const render::CellRectangle& cells) {
    const auto elevation = maps.find("elevation");
    const auto find = [&](const std::string& name) -> const LayerMap* {
      const auto found = maps.find(name);
      const bool fits =
          found != maps.end() && elevation != maps.end() && found->second->same_geometry(*elevation->second);
      return fits ? found->second.get() : nullptr;
    };
    if (layer == render::change_layer) {
      const bool fits = reference && find("elevation") && reference->same_geometry(*elevation->second);
      return fits ? change(*elevation->second, *reference, cells) : render::CellWindow();
    }
    const LayerMap* const map = find(layer == cost_layer ? "traversability" : layer);
    if (!map) return render::CellWindow();
    return layer == cost_layer ? costs(*map, cells) : copy(*map, cells);
  };
}

/// Moves the terrain to where tf says that its frame is; false and a status if tf does not know.
bool TerrainDisplay::place() {
  const LayerMap::Info& info = maps_.at("elevation")->info();
  tf2::Transform fixed_from_terrain;
  const bool known = transform_to_fixed_frame(*context_, info.frame, fixed_from_terrain);
  scene_node_->setVisible(known);
  if (!known) {
    set_status(StatusProperty::Error, "Transform",
               "No transform from the terrain's frame [" + info.frame + "] to the fixed frame [" +
                   fixed_frame_.toStdString() + "]: choose [" + info.frame +
                   "] as Fixed Frame, or let a node publish the transform.");
    return false;
  }
  set_status(StatusProperty::Ok, "Transform", "[" + info.frame + "]");
  const tf2::Vector3 corner = fixed_from_terrain * tf2::Vector3(info.origin_x, info.origin_y, 0);
  scene_node_->setPosition(to_ogre(corner));
  scene_node_->setOrientation(to_ogre(fixed_from_terrain.getRotation()));
  return true;
}

void TerrainDisplay::fit_view() {
  const LayerMap& elevation = *maps_.at("elevation");
  const LayerMap::Info& info = elevation.info();
  const double width = info.width * info.cell_size, height = info.height * info.cell_size;
  const float middle = elevation.at(info.width / 2, info.height / 2);
  const Ogre::Vector3 from_corner(static_cast<Ogre::Real>(width / 2), static_cast<Ogre::Real>(height / 2),
                                  std::isnan(middle) ? 0 : middle * exaggeration_->getFloat());
  show_in_view(*context_, scene_node_->getPosition() + scene_node_->getOrientation() * from_corner,
               std::hypot(width, height));
}

void TerrainDisplay::update_views() {
  const LayerMap& elevation = *maps_.at("elevation");
  const LayerMap::Info& info = elevation.info();
  plants_view_->update(info.origin_x, info.origin_y, static_cast<double>(exaggeration_->getFloat()),
                       most_plants_->getInt());
  wind_view_->update(elevation, most_arrows_->getInt());
}

// ---- status ----

void TerrainDisplay::report() {
#ifndef __OPTIMIZE__
  set_status(StatusProperty::Warn, "Build",
             "The plugin was built without optimisation and is slow: build with -DCMAKE_BUILD_TYPE=Release.");
#endif
  if (!source_) return;
  report_topic();
  report_overlay();
  const auto elevation = maps_.find("elevation");
  if (elevation == maps_.end()) return;
  const LayerMap::Info& info = elevation->second->info();
  const std::string size = std::to_string(info.width) + " x " + std::to_string(info.height) + " cells";
  if (counts_.blocks == 0)
    set_status(StatusProperty::Error, "Terrain",
               "A terrain of " + size + " has no surface to draw: at least 2 x 2 cells are needed.");
  else
    set_status(StatusProperty::Ok, "Terrain", size + ", step " + std::to_string(info.step));
  set_status(StatusProperty::Ok, "Blocks",
             std::to_string(counts_.waiting) + " of " + std::to_string(counts_.blocks) + " wait, " +
                 std::to_string(counts_.triangles) + " triangles");
}

void TerrainDisplay::report_topic() {
  const std::string topic = topic_->getTopicStd();
  const auto elevation = maps_.find("elevation");
  const TerrainClient& client = source_->client();
  const TerrainClient::Statistics statistics = client.statistics();
  const bool up_to_date = client.up_to_date("elevation");
  if (!client.connected("elevation") && elevation == maps_.end())
    set_status(
        StatusProperty::Error, "Topic",
        "Nobody publishes " + topic +
            ": start the node (roslaunch desert_sim desert_sim.launch), or choose another Elevation Topic.");
  else if (!client.connected("elevation"))
    set_status(StatusProperty::Warn, "Topic",
               "Nobody publishes " + topic +
                   " any more: the node has ended. What is shown is its last terrain, of step " +
                   std::to_string(elevation->second->info().step) + "; start the node again to go on.");
  else if (elevation == maps_.end())
    set_status(StatusProperty::Warn, "Topic", "Waiting for the first keyframe of " + topic + ".");
  else if (!up_to_date)
    set_status(StatusProperty::Warn, "Topic",
               "Messages were lost (" + statistics.last_gap + "); waiting for a keyframe of " + topic + ".");
  else
    set_status(StatusProperty::Ok, "Topic",
               std::to_string(statistics.keyframes) + " keyframes, " + std::to_string(statistics.updates) +
                   " updates");
}

void TerrainDisplay::report_overlay() {
  const std::string layer = scene_->look().overlay.layer;
  const std::string needed = layer == cost_layer ? "traversability" : layer;
  const bool computed = layer == render::slope_layer || layer == render::change_layer;
  if (layer.empty())
    set_status(StatusProperty::Ok, "Overlay", "none");
  else if (!computed && !TerrainSource::is_known(needed)) {
    std::string known;
    for (const std::string& name : TerrainClient::known_layers()) known += (known.empty() ? "" : ", ") + name;
    set_status(StatusProperty::Error, "Overlay",
               "There is no layer '" + layer + "': choose change, cost, or one of " + known + ".");
  } else if (!computed && !maps_.count(needed))
    set_status(StatusProperty::Warn, "Overlay",
               "Waiting for the layer '" + needed + "': the node sends it when it has computed it.");
  else
    set_status(StatusProperty::Ok, "Overlay", overlay_->title());
}

/// Qt's model of the statuses is told only what has changed.
void TerrainDisplay::set_status(StatusProperty::Level level, const char* name, const std::string& text) {
  std::string& shown = statuses_[name];
  if (shown == text) return;
  shown = text;
  setStatus(level, name, QString::fromStdString(text));
}

}  // namespace desert_sim

PLUGINLIB_EXPORT_CLASS(desert_sim::TerrainDisplay, rviz::Display)
