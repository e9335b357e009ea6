#include "src/rviz/draped_odometry_display.hpp"

#include <rviz/properties/float_property.h>
#include <rviz/properties/int_property.h>

#include <pluginlib/class_list_macros.hpp>

#include "src/render/drawable.hpp"

namespace desert_sim {

namespace {

constexpr double farthest = 5;  // [m] in one message: beyond that somebody has put the robot elsewhere

}  // namespace

DrapedOdometryDisplay::DrapedOdometryDisplay()
    : DrapedLineDisplay("", QString::fromStdString(ros::message_traits::datatype<nav_msgs::Odometry>()),
                        "Poses, whose heights do not count: the way between them is laid on the ground.",
                        QColor(250, 250, 250)) {
  keep_ = new rviz::IntProperty("Keep", 4000, "So many of the last poses.", this, SLOT(limit()));
  keep_->setMin(2);
  spacing_ = new rviz::FloatProperty("Position Tolerance", 0.1F,
                                     "Poses that are nearer to the one before are left out [m].", this,
                                     SLOT(limit()));
  spacing_->setMin(0);
  limit();
}

void DrapedOdometryDisplay::limit() {
  const std::lock_guard<std::mutex> lock(mutex_);
  most_ = static_cast<std::size_t>(keep_->getInt());
  apart_ = static_cast<double>(spacing_->getFloat());
}

void DrapedOdometryDisplay::receive(const std::string& topic) {
  subscriber_.shutdown();  // waits for a callback that runs
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    way_.clear();
    changed_ = false;
  }
  if (topic.empty()) return;
  subscriber_ = threaded_nh_.subscribe<nav_msgs::Odometry>(
      topic, 100, [this](const nav_msgs::OdometryConstPtr& message) { add(*message); });
}

void DrapedOdometryDisplay::add(const nav_msgs::Odometry& message) {
  const render::Place place{message.pose.pose.position.x, message.pose.pose.position.y};
  if (!render::is_drawable(place.x) || !render::is_drawable(place.y)) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!way_.empty()) {
    const double way = distance(way_.back(), place);
    if (message.header.frame_id != frame_ || message.header.stamp < newest_ || way > farthest)
      way_.clear();
    else if (way < apart_)
      return;
  }
  frame_ = message.header.frame_id;
  newest_ = message.header.stamp;
  way_.push_back(place);
  while (way_.size() > most_) way_.pop_front();
  changed_ = true;
}

std::optional<DrapedLineDisplay::Line> DrapedOdometryDisplay::take() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!std::exchange(changed_, false)) return std::nullopt;
  return Line{frame_, {way_.begin(), way_.end()}};
}

}  // namespace desert_sim

PLUGINLIB_EXPORT_CLASS(desert_sim::DrapedOdometryDisplay, rviz::Display)
