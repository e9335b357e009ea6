#pragma once
/// The display desert_sim/Terrain of rviz.

#include <OgreSceneNode.h>
#include <rviz/display.h>

#include <memory>

#include "src/rviz/legend.hpp"
#include "src/rviz/map_windows.hpp"
#include "src/rviz/near_ground_view.hpp"
#include "src/rviz/placement.hpp"
#include "src/rviz/plants_view.hpp"
#include "src/rviz/ripples_view.hpp"
#include "src/rviz/sky.hpp"
#include "src/rviz/terrain_properties.hpp"
#include "src/rviz/terrain_scene.hpp"
#include "src/rviz/terrain_source.hpp"
#include "src/rviz/terrain_status.hpp"
#include "src/rviz/topic_inbox.hpp"
#include "src/rviz/wind_view.hpp"

namespace desert_sim {

class TerrainDisplay : public rviz::Display {
  Q_OBJECT
  // What the last call of update() did, for tests and benchmarks, which know a plugin only as a QObject.
  Q_PROPERTY(double frame_milliseconds READ frame_milliseconds)  ///< of this thread's processor time
  Q_PROPERTY(int frame_messages READ frame_messages)             ///< keyframes and updates that it took over
  Q_PROPERTY(int blocks READ blocks)
  Q_PROPERTY(int waiting_blocks READ waiting_blocks)
  Q_PROPERTY(qulonglong built_blocks READ built_blocks)     ///< since the start
  Q_PROPERTY(qlonglong triangles READ triangles)            ///< of the ground
  Q_PROPERTY(qlonglong near_triangles READ near_triangles)  ///< of the ground with micro-relief
  Q_PROPERTY(qlonglong plants READ plants)                  ///< that are drawn as shapes
  Q_PROPERTY(qlonglong known_plants READ known_plants)
  Q_PROPERTY(int waiting_plants READ waiting_plants)  ///< tiles and strips of them that are not shown yet

 public:
  TerrainDisplay();
  ~TerrainDisplay() override;

  void update(float wall_dt, float ros_dt) override;
  void reset() override;
  void setTopic(const QString& topic, const QString& datatype) override;

  /// What tools need to know to draw on the terrain that is shown.
  std::string node() const;  ///< full name of the node that is shown; empty: none
  double vertical_exaggeration() const;
  /// The material of the ground, whose first texture coordinates are metres east and north of the corner.
  Ogre::MaterialPtr ground_material() const { return scene_->ground_material(); }
  /// Where the corner of the grid is drawn in the fixed frame.
  Placement corner() const { return {scene_node_->getPosition(), scene_node_->getOrientation()}; }

  double frame_milliseconds() const { return frame_milliseconds_; }
  int frame_messages() const { return frame_messages_; }
  int blocks() const { return counts_.blocks; }
  int waiting_blocks() const { return counts_.waiting; }
  qulonglong built_blocks() const { return counts_.built; }
  qlonglong triangles() const { return counts_.triangles; }
  qlonglong near_triangles() const { return counts_.near_triangles; }
  qlonglong plants() const { return plants_view_ ? static_cast<qlonglong>(plants_view_->shown()) : 0; }
  qlonglong known_plants() const { return plants_view_ ? static_cast<qlonglong>(plants_view_->total()) : 0; }
  int waiting_plants() const { return plants_view_ ? static_cast<int>(plants_view_->waiting()) : 0; }

 protected:
  void onInitialize() override;
  void onEnable() override;
  void onDisable() override;

 private Q_SLOTS:
  void subscribe();
  void subscribe_views();
  void update_look();
  void update_limits();

 private:
  void unsubscribe();
  bool take_changes();
  void take_elevation(const CollectedChange& change);
  bool place();
  void fit_view();
  void update_views();
  void update_plants(const Ogre::Camera& camera, int viewport_height);
  void report();
  void set_status(const DisplayStatus& status);

  std::unique_ptr<TerrainProperties> properties_;
  bool fit_pending_ = false;  ///< there is another terrain, which the view was not fitted to

  TopicInbox<Appearance> appearance_;
  std::unique_ptr<RipplesView> ripples_view_;
  std::unique_ptr<TerrainScene> scene_;
  std::unique_ptr<NearGroundView> near_ground_;
  Ogre::SceneNode* level_node_ = nullptr;  ///< at the grid's corner, without exaggeration
  std::unique_ptr<PlantsView> plants_view_;
  std::unique_ptr<WindView> wind_view_;
  std::unique_ptr<Legend> legend_, second_legend_;
  std::unique_ptr<Sky> sky_;
  std::unique_ptr<TerrainSource> source_;
  LayerMaps maps_;  ///< the elevation decides the grid
  double frame_milliseconds_ = 0;
  int frame_messages_ = 0;
  bool held_ = false;  ///< the last frame waited for layers of the newest elevation
  TerrainScene::Counts counts_;
  std::map<std::string, std::string> statuses_;  ///< the texts that are shown
};

/// The first enabled display of the terrain of this node, by its full name; null if there is none.
TerrainDisplay* terrain_display(const rviz::DisplayContext& context, const std::string& node);

}  // namespace desert_sim
