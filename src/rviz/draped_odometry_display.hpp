#pragma once
/// The display desert_sim/DrapedOdometry of rviz: the way that a nav_msgs/Odometry has come, on the ground.

#include <nav_msgs/Odometry.h>

#include <deque>
#include <mutex>

#include "src/rviz/draped_line_display.hpp"

namespace desert_sim {

class DrapedOdometryDisplay : public DrapedLineDisplay {
  Q_OBJECT

 public:
  DrapedOdometryDisplay();
  ~DrapedOdometryDisplay() override { subscriber_.shutdown(); }

 protected:
  void receive(const std::string& topic) override;
  bool connected() const override { return subscriber_.getNumPublishers() > 0; }
  std::optional<Line> take() override;

 private Q_SLOTS:
  void limit();

 private:
  void add(const nav_msgs::Odometry& message);

  rviz::IntProperty* keep_;
  rviz::FloatProperty* spacing_;

  ros::Subscriber subscriber_;
  std::mutex mutex_;  ///< protects all that follows
  std::string frame_;
  std::deque<render::Place> way_;
  ros::Time newest_;
  std::size_t most_ = 0;
  double apart_ = 0;
  bool changed_ = false;
};

}  // namespace desert_sim
