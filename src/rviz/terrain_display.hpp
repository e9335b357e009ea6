#pragma once
/// The display desert_sim/Terrain of rviz.

#include <rviz/display.h>

#include <memory>

#include "src/rviz/terrain_scene.hpp"
#include "src/rviz/terrain_source.hpp"

namespace rviz {
class BoolProperty;
class FloatProperty;
class IntProperty;
class RosTopicProperty;
}  // namespace rviz

namespace desert_sim {

class TerrainDisplay : public rviz::Display {
  Q_OBJECT

 public:
  TerrainDisplay();
  ~TerrainDisplay() override;

  void update(float wall_dt, float ros_dt) override;
  void reset() override;
  void setTopic(const QString& topic, const QString& datatype) override;

  /// What the last call of update() did, for tests and benchmarks.
  struct FrameReport {
    double milliseconds = 0;  ///< that update() took
    int messages = 0;         ///< keyframes and updates that it took over
    TerrainScene::Counts blocks;
  };
  const FrameReport& last_frame() const { return last_frame_; }

 protected:
  void onInitialize() override;
  void onEnable() override;
  void onDisable() override;

 private Q_SLOTS:
  void subscribe();
  void update_look();
  void update_limits();
  void update_exaggeration();

 private:
  void take_changes();
  bool place();
  void report();
  void set_status(rviz::StatusProperty::Level level, const char* name, const std::string& text);

  rviz::RosTopicProperty* topic_;
  rviz::FloatProperty *exaggeration_, *contours_, *budget_, *quad_pixels_;
  rviz::IntProperty* triangles_;
  rviz::BoolProperty* water_;

  std::unique_ptr<TerrainScene> scene_;
  std::unique_ptr<TerrainSource> source_;
  std::shared_ptr<const ElevationMap> map_;
  FrameReport last_frame_;
  std::map<std::string, std::string> statuses_;  ///< the texts that are shown
};

}  // namespace desert_sim
