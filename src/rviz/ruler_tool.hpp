#pragma once
/// The tool desert_sim/Ruler of rviz: distance, height and slope between two clicks on a node's terrain.

#include <rviz/tool.h>

#include <memory>
#include <optional>
#include <string>

#include "src/rviz/surface_marks.hpp"
#include "src/rviz/terrain_picker.hpp"

namespace rviz {
class StringProperty;
}

namespace desert_sim {

class RulerTool : public rviz::Tool {
  Q_OBJECT
  Q_PROPERTY(QString text READ text)  ///< what is measured; for tests, which know a plugin only as a QObject

 public:
  RulerTool();
  ~RulerTool() override;

  void activate() override;
  void deactivate() override;
  void update(float wall_dt, float ros_dt) override;
  int processMouseEvent(rviz::ViewportMouseEvent& event) override;

  QString text() const { return QString::fromStdString(text_); }

 protected:
  void onInitialize() override;

 private Q_SLOTS:
  void choose_node();

 private:
  void click();
  void draw();
  void show_status();

  rviz::StringProperty* node_;
  std::unique_ptr<TerrainPicker> terrain_;
  std::unique_ptr<SurfaceMarks> marks_;
  Ogre::Viewport* viewport_ = nullptr;                     ///< in which the mouse was last
  std::optional<render::Point> hovered_, first_, second_;  ///< what the mouse points at, and the clicks
  bool pointing_ = false;                                  ///< the mouse is in the view of a terrain
  std::string text_;
};

}  // namespace desert_sim
