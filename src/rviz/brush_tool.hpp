#pragma once
/// The tool desert_sim/Brush of rviz: paints materials, plants and obstacles on a node's terrain.

#include <rviz/tool.h>

#include <memory>
#include <optional>
#include <string>

#include "src/rviz/edit_client.hpp"
#include "src/rviz/service_caller.hpp"
#include "src/rviz/surface_marks.hpp"
#include "src/rviz/terrain_picker.hpp"

namespace rviz {
class EditableEnumProperty;
class EnumProperty;
class FloatProperty;
class StringProperty;
}  // namespace rviz

namespace desert_sim {

class BrushTool : public rviz::Tool {
  Q_OBJECT
  // For tests, which know a plugin only as a QObject.
  Q_PROPERTY(bool idle READ idle)          ///< everything that was painted is sent and answered
  Q_PROPERTY(qulonglong calls READ calls)  ///< calls of services since the node was chosen
  Q_PROPERTY(QString report READ last_report)
  Q_PROPERTY(bool over_terrain READ over_terrain)

 public:
  BrushTool();
  ~BrushTool() override;

  void activate() override;
  void deactivate() override;
  void update(float wall_dt, float ros_dt) override;
  int processMouseEvent(rviz::ViewportMouseEvent& event) override;
  int processKeyEvent(QKeyEvent* event, rviz::RenderPanel* panel) override;

  bool idle() const { return !client_ || client_->idle(); }
  qulonglong calls() const { return client_ ? client_->calls() : 0; }
  QString last_report() const { return QString::fromStdString(report_); }
  bool over_terrain() const { return hovered_.has_value(); }

 protected:
  void onInitialize() override;

 private Q_SLOTS:
  void choose_node();
  void show_times();

 private:
  /// Makes the properties that say when it is painted.
  void make_times(rviz::Property* parent);
  Brush brush(bool shift) const;
  void turn_wheel(rviz::ViewportMouseEvent& event);
  void press(bool shift);
  void release();
  void draw();
  void show_status();

  /// Asks the node for the names of its species.
  void ask_for_species();

  rviz::StringProperty *node_, *mask_;
  rviz::EditableEnumProperty* species_;
  rviz::EnumProperty *material_, *operation_, *when_;
  rviz::FloatProperty *radius_, *strength_, *inner_, *density_, *size_;
  rviz::FloatProperty *time_, *every_, *until_;  ///< of when_

  std::unique_ptr<EditClient> client_;
  ServiceCaller caller_;  ///< for questions, which strokes do not wait for
  std::unique_ptr<TerrainPicker> terrain_;
  std::unique_ptr<SurfaceMarks> marks_;
  std::optional<render::Point> hovered_;  ///< what the mouse points at
  Ogre::Viewport* viewport_ = nullptr;    ///< in which the mouse was last
  bool painting_ = false, shift_ = false, failed_ = false;
  std::string report_;  ///< the last one of the client, or why nothing is painted
};

}  // namespace desert_sim
