#pragma once
/// The display desert_sim/DrapedMap of rviz: a map of costs on the ground.

#include <rviz/display.h>

#include <memory>
#include <string>

#include "src/rviz/cost_map.hpp"
#include "src/rviz/display_statuses.hpp"
#include "src/rviz/ground_coat.hpp"
#include "src/rviz/legend.hpp"

namespace rviz {
class BoolProperty;
class EnumProperty;
class FloatProperty;
class RosTopicProperty;
class StringProperty;
}  // namespace rviz

namespace desert_sim {

class TerrainDisplay;

class DrapedMapDisplay : public rviz::Display {
  Q_OBJECT
  // For tests and benchmarks, which know a plugin only as a QObject.
  Q_PROPERTY(qulonglong maps READ maps)        ///< whole maps that it has taken over
  Q_PROPERTY(qulonglong updates READ updates)  ///< and updates of parts
  Q_PROPERTY(double frame_milliseconds READ frame_milliseconds)

 public:
  DrapedMapDisplay();
  ~DrapedMapDisplay() override;

  void update(float wall_dt, float ros_dt) override;
  void reset() override;
  void setTopic(const QString& topic, const QString& datatype) override;

  qulonglong maps() const { return inbox_.report().maps; }
  qulonglong updates() const { return inbox_.report().updates; }
  double frame_milliseconds() const { return frame_milliseconds_; }

 protected:
  void onInitialize() override;
  void onEnable() override;
  void onDisable() override;

 private Q_SLOTS:
  void subscribe();
  void update_look();

 private:
  void unsubscribe();
  void take_changes();
  void paint_cells(const render::CellRectangle& cells);
  bool place();
  const TerrainDisplay* ground();
  void report();

  rviz::RosTopicProperty* topic_;
  rviz::StringProperty* node_;
  rviz::FloatProperty* alpha_;
  rviz::EnumProperty* colours_;
  rviz::BoolProperty *unknown_, *legend_wanted_;

  CostMapInbox inbox_;
  CostMap map_;  ///< what is shown; empty before there is one
  std::unique_ptr<GroundCoat> coat_;
  std::unique_ptr<Legend> legend_;
  double frame_milliseconds_ = 0;
  DisplayStatuses statuses_{*this};
};

}  // namespace desert_sim
