#pragma once
/// The display desert_sim/ScaleBar of rviz: a bar of a round length and an arrow to the north, in the lower
/// right corner of the view.

#include <rviz/display.h>

#include <memory>
#include <string>

#include "src/render/scale_bar.hpp"
#include "src/rviz/corner_picture.hpp"
#include "src/rviz/display_statuses.hpp"

namespace rviz {
class TfFrameProperty;
}

namespace desert_sim {

class ScaleBarDisplay : public rviz::Display {
  Q_OBJECT
  // What is shown, for tests, which know a plugin only as a QObject.
  Q_PROPERTY(QString length READ length)               ///< such as 20 m; empty if no bar is shown
  Q_PROPERTY(double bar_pixels READ bar_pixels)        ///< of that length
  Q_PROPERTY(double north_degrees READ north_degrees)  ///< from upwards clockwise

 public:
  ScaleBarDisplay();
  ~ScaleBarDisplay() override;

  void update(float wall_dt, float ros_dt) override;

  QString length() const;
  double bar_pixels() const { return bar_ ? bar_->pixels : 0; }
  double north_degrees() const { return north_degrees_; }

 protected:
  void onInitialize() override;
  void onDisable() override;

 private:
  bool look();
  void draw();

  rviz::TfFrameProperty* north_frame_;
  std::unique_ptr<CornerPicture> picture_;
  std::optional<render::ScaleBar> bar_;
  double north_degrees_ = 0;
  std::string drawn_;  ///< what the picture shows
  DisplayStatuses statuses_{*this};
};

}  // namespace desert_sim
