#pragma once
/// The tool desert_sim/WindTool of rviz: places, moves and removes local features of a node's wind.

#include <desert_sim/WindFeatureList.h>
#include <ros/node_handle.h>
#include <rviz/tool.h>

#include <memory>
#include <optional>
#include <string>

#include "src/rviz/service_caller.hpp"
#include "src/rviz/surface_marks.hpp"
#include "src/rviz/terrain_picker.hpp"
#include "src/rviz/topic_inbox.hpp"
#include "src/rviz/wind_feature_properties.hpp"
#include "src/rviz/wind_features.hpp"

namespace rviz {
class StringProperty;
}

namespace desert_sim {

class WindTool : public rviz::Tool {
  Q_OBJECT
  // For tests, which know a plugin only as a QObject.
  Q_PROPERTY(bool idle READ idle)  ///< all calls are answered
  Q_PROPERTY(QString report READ last_report)
  Q_PROPERTY(bool over_terrain READ over_terrain)
  Q_PROPERTY(int features READ features)  ///< of the node, as far as known

 public:
  WindTool();
  ~WindTool() override;

  void activate() override;
  void deactivate() override;
  void update(float wall_dt, float ros_dt) override;
  int processMouseEvent(rviz::ViewportMouseEvent& event) override;

  bool idle() const { return waiting_ == 0; }
  QString last_report() const { return QString::fromStdString(report_); }
  bool over_terrain() const { return hovered_.has_value(); }
  int features() const { return static_cast<int>(features_.size()); }

 protected:
  void onInitialize() override;

 private Q_SLOTS:
  void choose_node();

 private:
  enum class Action { none, place, move };

  void follow(const std::string& node);
  /// What a click would place at the mouse.
  WindFeatureItem feature_here() const;
  /// The feature whose centre the mouse points at; null if there is none.
  const WindFeatureItem* pointed_at() const;
  void turn_wheel(rviz::ViewportMouseEvent& event);
  void press(rviz::ViewportMouseEvent& event);
  void drag(rviz::ViewportMouseEvent& event);
  void release();
  void remove();
  void send(const EditWind::Request& request, const std::string& done);
  void tell(bool success, const std::string& text);

  std::vector<SurfaceMarks::Line> draped(const WindFeatureItem& feature, unsigned alpha) const;
  void draw();
  void draw_features();
  void show_status();

  rviz::StringProperty* node_;
  std::unique_ptr<WindFeatureProperties> next_;

  std::unique_ptr<TerrainPicker> terrain_;
  std::unique_ptr<SurfaceMarks> marks_, feature_marks_;
  ros::NodeHandle nodes_;  ///< with rviz's queue for slow work
  TopicInbox<WindFeatureList> list_;
  ServiceCaller caller_;

  WindFeatures features_;
  double time_ = 0;                       ///< simulated time of that list [s]
  int last_id_ = 0, waiting_ = 0;         ///< the id of the last feature placed here; calls without an answer
  std::optional<render::Point> hovered_;  ///< what the mouse points at
  Ogre::Viewport* viewport_ = nullptr;    ///< in which the mouse was last
  Action action_ = Action::none;
  WindFeatureItem made_;  ///< what is being placed or moved
  bool dragged_ = false, modified_ = false, failed_ = false;
  int press_x_ = 0, press_y_ = 0;  ///< [pixels]
  std::string report_;             ///< what the last call did, or why it did not

  /// What the outlines of the features were drawn for: they are draped anew only when it changes.
  struct Drawn {
    std::shared_ptr<const ElevationMap> map;
    Placement corner;
    double exaggeration = 0;
    int pointed = 0, moved = 0;  ///< ids
  };
  Drawn drawn_;
  bool features_changed_ = true;
};

}  // namespace desert_sim
