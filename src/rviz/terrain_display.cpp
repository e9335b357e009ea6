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

#include <chrono>
#include <pluginlib/class_list_macros.hpp>

#include "src/core/error.hpp"

namespace desert_sim {

using rviz::StatusProperty;

TerrainDisplay::TerrainDisplay() {
  topic_ = new rviz::RosTopicProperty(
      "Elevation Topic", "/desert_sim/elevation",
      QString::fromStdString(ros::message_traits::datatype<ElevationGrid>()),
      "Keyframes of the terrain. Updates and layers are taken from the same node.", this, SLOT(subscribe()));
  exaggeration_ =
      new rviz::FloatProperty("Vertical Exaggeration", 1, "Heights are drawn so many times as high.", this,
                              SLOT(update_exaggeration()));
  exaggeration_->setMin(0.01F);
  exaggeration_->setMax(100);
  water_ =
      new rviz::BoolProperty("Water", true, "Show water, if the terrain has it.", this, SLOT(update_look()));
  contours_ = new rviz::FloatProperty(
      "Contour Interval", 0, "Contour lines are so many metres apart; 0: none.", this, SLOT(update_look()));
  contours_->setMin(0);
  quad_pixels_ = new rviz::FloatProperty(
      "Quad Size", 4, "A quad of the mesh takes about so many pixels, if the terrain has cells enough.", this,
      SLOT(update_limits()));
  quad_pixels_->setMin(1);
  quad_pixels_->setMax(64);
  triangles_ = new rviz::IntProperty("Most Triangles", 100000,
                                     "At most so many triangles of ground are in the picture.", this,
                                     SLOT(update_limits()));
  triangles_->setMin(1000);
  budget_ = new rviz::FloatProperty(
      "Time per Frame", 20,
      "At most so many milliseconds of each frame go into building blocks that changed.", this);
  budget_->setMin(1);
  budget_->setMax(1000);
}

TerrainDisplay::~TerrainDisplay() {
  source_.reset();
  scene_.reset();
}

// ---- what rviz calls ----

void TerrainDisplay::onInitialize() {
  scene_ = std::make_unique<TerrainScene>(scene_node_);
  update_look();
  update_limits();
  update_exaggeration();
}

void TerrainDisplay::onEnable() { subscribe(); }

void TerrainDisplay::onDisable() {
  source_.reset();
  map_.reset();
  scene_->clear();
}

void TerrainDisplay::reset() {
  Display::reset();
  statuses_.clear();
  if (isEnabled()) subscribe();
}

void TerrainDisplay::setTopic(const QString& topic, const QString&) { topic_->setString(topic); }

void TerrainDisplay::update(float, float) {
  const auto begin = std::chrono::steady_clock::now();
  last_frame_ = {};
  take_changes();
  rviz::ViewManager* const views = context_->getViewManager();
  if (map_ && place() && views && views->getCurrent() && views->getRenderPanel()) {
    const Ogre::Viewport* const viewport = views->getRenderPanel()->getViewport();
    if (const Ogre::Camera* const camera = views->getCurrent()->getCamera(); camera && viewport) {
      const double spent = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      scene_->update(*camera, viewport->getActualHeight(), 1e-3 * budget_->getFloat() - spent);
    }
  }
  report();
  last_frame_.blocks = scene_->counts();
  last_frame_.milliseconds =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  if (last_frame_.blocks.waiting > 0) context_->queueRender();
}

// ---- properties ----

void TerrainDisplay::subscribe() {
  if (!initialized() || !isEnabled()) return;
  source_.reset();
  map_.reset();
  scene_->clear();
  try {
    source_ = std::make_unique<TerrainSource>(topic_->getTopicStd());
  } catch (const ConfigError& error) {
    set_status(StatusProperty::Error, "Topic",
               std::string(error.what()) + ". Choose another Elevation Topic.");
  }
}

void TerrainDisplay::update_look() {
  if (!scene_) return;
  render::TerrainLook look = scene_->look();
  look.water = water_->getBool();
  look.contour_interval = static_cast<double>(contours_->getFloat());
  scene_->set_look(look);
}

void TerrainDisplay::update_limits() {
  if (scene_) scene_->set_limits({static_cast<double>(quad_pixels_->getFloat()), triangles_->getInt()});
}

void TerrainDisplay::update_exaggeration() {
  if (scene_) scene_->set_vertical_exaggeration(static_cast<double>(exaggeration_->getFloat()));
}

// ---- the terrain ----

void TerrainDisplay::take_changes() {
  if (!source_) return;
  const TerrainChange change = source_->take();
  if (!change.map) return;
  map_ = change.map;
  last_frame_.messages = change.messages;
  const render::LayerWindow window = [map = map_](const std::string& layer, const render::CellRectangle& r) {
    if (layer != "elevation") return render::CellWindow();
    return render::CellWindow(
        r, map->elevations({static_cast<std::uint32_t>(r.x), static_cast<std::uint32_t>(r.y),
                            static_cast<std::uint32_t>(r.width), static_cast<std::uint32_t>(r.height)}));
  };
  const ElevationMap::Info& info = map_->info();
  if (change.replaced) {
    scene_->set_grid(static_cast<int>(info.width), static_cast<int>(info.height), info.cell_size, window);
    return;
  }
  scene_->set_window(window);
  for (const render::CellRectangle& cells : change.changed) scene_->touch(cells);
}

/// Moves the terrain to where tf says that its frame is; false and a status if tf does not know.
bool TerrainDisplay::place() {
  const ElevationMap::Info& info = map_->info();
  Ogre::Vector3 position;
  Ogre::Quaternion orientation;
  if (!context_->getFrameManager()->getTransform(info.frame, ros::Time(), position, orientation)) {
    set_status(StatusProperty::Error, "Transform",
               "No transform from the terrain's frame [" + info.frame + "] to the fixed frame [" +
                   fixed_frame_.toStdString() + "]: choose [" + info.frame +
                   "] as Fixed Frame, or let a node publish the transform.");
    scene_node_->setVisible(false);
    return false;
  }
  set_status(StatusProperty::Ok, "Transform", "[" + info.frame + "]");
  const Ogre::Vector3 corner(static_cast<Ogre::Real>(info.origin_x), static_cast<Ogre::Real>(info.origin_y),
                             0);
  scene_->set_pose(position + orientation * corner, orientation);
  return true;
}

// ---- status ----

void TerrainDisplay::report() {
#ifndef __OPTIMIZE__
  set_status(StatusProperty::Warn, "Build",
             "The plugin was built without optimisation and is slow: build with -DCMAKE_BUILD_TYPE=Release.");
#endif
  if (!source_) return;
  const std::string topic = topic_->getTopicStd();
  if (!source_->connected()) {
    set_status(
        map_ ? StatusProperty::Warn : StatusProperty::Error, "Topic",
        "Nobody publishes " + topic +
            (map_ ? ": the node has ended; what is shown is its last terrain, of step " +
                        std::to_string(map_->info().step) + "."
                  : ": start the node (roslaunch desert_sim desert_sim.launch), or choose another Elevation "
                    "Topic."));
  } else if (!map_) {
    set_status(StatusProperty::Warn, "Topic", "Waiting for the first keyframe of " + topic + ".");
  } else if (!source_->up_to_date()) {
    set_status(StatusProperty::Warn, "Topic",
               "Messages were lost (" + source_->statistics().last_gap + "); waiting for a keyframe of " +
                   topic + ".");
  } else {
    set_status(StatusProperty::Ok, "Topic",
               std::to_string(source_->statistics().keyframes) + " keyframes, " +
                   std::to_string(source_->statistics().updates) + " updates");
  }
  if (!map_) return;
  const ElevationMap::Info& info = map_->info();
  const TerrainScene::Counts counts = scene_->counts();
  const std::string size = std::to_string(info.width) + " x " + std::to_string(info.height) + " cells";
  if (counts.blocks == 0)
    set_status(StatusProperty::Error, "Terrain",
               "A terrain of " + size + " has no surface to draw: at least 2 x 2 cells are needed.");
  else
    set_status(StatusProperty::Ok, "Terrain", size + ", step " + std::to_string(info.step));
  set_status(StatusProperty::Ok, "Blocks",
             std::to_string(counts.waiting) + " of " + std::to_string(counts.blocks) + " wait, " +
                 std::to_string(counts.triangles) + " triangles");
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
