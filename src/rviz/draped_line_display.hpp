#pragma once
/// Displays of rviz that lay a line on the terrain of a node: desert_sim/DrapedPath and
/// desert_sim/DrapedOdometry.

#include <rviz/display.h>

#include <memory>
#include <string>
#include <vector>

#include "src/render/draped_line.hpp"
#include "src/rviz/display_statuses.hpp"
#include "src/rviz/legend.hpp"
#include "src/rviz/mesh_object.hpp"
#include "src/rviz/terrain_picker.hpp"

namespace rviz {
class BoolProperty;
class ColorProperty;
class FloatProperty;
class IntProperty;
class RosTopicProperty;
class StringProperty;
}  // namespace rviz

namespace desert_sim {

class DrapedLineDisplay : public rviz::Display {
  Q_OBJECT
  // For tests and benchmarks, which know a plugin only as a QObject.
  Q_PROPERTY(int points READ points)            ///< of the line as it was received
  Q_PROPERTY(int built_lines READ built_lines)  ///< since the start
  Q_PROPERTY(double frame_milliseconds READ frame_milliseconds)

 public:
  ~DrapedLineDisplay() override;

  void update(float wall_dt, float ros_dt) override;
  void reset() override;
  void setTopic(const QString& topic, const QString& datatype) override;

  int points() const { return static_cast<int>(line_.points.size()); }
  int built_lines() const { return built_lines_; }
  double frame_milliseconds() const { return frame_milliseconds_; }

  /// A line on the map, in some frame [m].
  struct Line {
    std::string frame;
    std::vector<render::Place> points;
  };

 protected:
  DrapedLineDisplay(const QString& topic, const QString& datatype, const QString& description,
                    const QColor& colour);

  /// Subscribes to this topic; to nothing for an empty name. The line is forgotten.
  virtual void receive(const std::string& topic) = 0;
  virtual bool connected() const = 0;
  /// The newest line, if there is another one since the last call.
  virtual std::optional<Line> take() = 0;

  void onInitialize() override;
  void onEnable() override;
  void onDisable() override;

 private Q_SLOTS:
  void subscribe();
  void update_look();

 private:
  void unsubscribe();
  bool needs_building();
  void build();
  void report();

  rviz::RosTopicProperty* topic_;
  rviz::StringProperty* node_;
  rviz::ColorProperty* colour_;
  rviz::IntProperty* width_;
  rviz::FloatProperty* height_;
  rviz::BoolProperty* legend_wanted_;

  std::unique_ptr<TerrainPicker> terrain_;
  std::unique_ptr<MeshObject> seen_, behind_;  ///< the line, and what is seen of it through the ground
  std::shared_ptr<LineLegend> legend_;
  Line line_;
  tf2::Transform terrain_from_line_;
  std::shared_ptr<const ElevationMap> ground_;  ///< on which the line was laid
  double exaggeration_ = 0;                     ///< with which it was
  bool changed_ = false;                        ///< the line or its look, since then
  bool subscribed_ = false;
  int built_lines_ = 0;
  double frame_milliseconds_ = 0;
  DisplayStatuses statuses_{*this};
};

}  // namespace desert_sim
