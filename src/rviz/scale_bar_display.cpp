#include "src/rviz/scale_bar_display.hpp"

#include <OgreCamera.h>
#include <OgreViewport.h>
#include <rviz/display_context.h>
#include <rviz/properties/tf_frame_property.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>

#include <QPainter>
#include <cmath>
#include <pluginlib/class_list_macros.hpp>

#include "src/rviz/placement.hpp"
#include "src/rviz/view_scale.hpp"

namespace desert_sim {

namespace {

constexpr double longest_bar = 160;                  // [pixels]
constexpr int scale_width = 250, scale_height = 72;  // of the picture [pixels]
constexpr int north_x = scale_width - 40, north_y = scale_height / 2;
constexpr double degrees_of_radian = 180 / 3.14159265358979323846;

void draw_scale(QPainter& painter, const render::ScaleBar& bar) {
  const int left = 12, bottom = scale_height - 12, pixels = static_cast<int>(std::lround(bar.pixels));
  painter.drawText(QRect(left, 22, pixels, 22), Qt::AlignCenter | Qt::TextDontClip,
                   QString::fromStdString(render::length_text(bar.metres)));
  painter.fillRect(left, bottom - 6, pixels, 6, Qt::white);
  painter.fillRect(left + pixels / 2, bottom - 5, pixels - pixels / 2 - 1, 4, QColor(30, 30, 30));
}

void draw_north(QPainter& painter, double clockwise) {
  painter.setRenderHint(QPainter::Antialiasing);
  painter.translate(north_x, north_y);
  painter.rotate(clockwise);
  painter.setPen(Qt::NoPen);
  painter.setBrush(QColor(225, 60, 50));
  const QPointF to_north[] = {{0, -18}, {-8, 9}, {0, 4}}, to_north_too[] = {{0, -18}, {8, 9}, {0, 4}};
  painter.drawPolygon(to_north, 3);
  painter.setBrush(Qt::white);
  painter.drawPolygon(to_north_too, 3);
  painter.resetTransform();
  constexpr double beyond = 27;  // the letter stands beyond the tip, and upright
  const double angle = clockwise / degrees_of_radian;
  const QPointF letter(north_x + beyond * std::sin(angle), north_y - beyond * std::cos(angle));
  painter.setPen(Qt::white);
  painter.drawText(QRectF(letter.x() - 8, letter.y() - 8, 16, 16), Qt::AlignCenter, "N");
}

}  // namespace

ScaleBarDisplay::ScaleBarDisplay() {
  north_frame_ = new rviz::TfFrameProperty("North Frame", rviz::TfFrameProperty::FIXED_FRAME_STRING,
                                           "Its y axis points to the north, as those of terrains do.", this,
                                           nullptr, true);
}

ScaleBarDisplay::~ScaleBarDisplay() = default;

void ScaleBarDisplay::onInitialize() {
  north_frame_->setFrameManager(context_->getFrameManager());
  picture_ = std::make_unique<CornerPicture>(CornerPicture::Corner::right);
}

void ScaleBarDisplay::onDisable() { picture_->hide(); }

QString ScaleBarDisplay::length() const {
  return bar_ ? QString::fromStdString(render::length_text(bar_->metres)) : QString();
}

void ScaleBarDisplay::update(float, float) {
  if (!look()) return picture_->hide();
  draw();
  picture_->show();
}

/// Finds out what is to be shown; false if the view or tf does not say it.
bool ScaleBarDisplay::look() {
  bar_.reset();
  const rviz::ViewController* const view = context_->getViewManager()->getCurrent();
  const Ogre::Camera* const camera = view ? view->getCamera() : nullptr;
  const Ogre::Viewport* const viewport = camera ? camera->getViewport() : nullptr;
  if (!viewport) return false;
  const std::string frame = north_frame_->getFrameStd();
  const std::optional<Placement> north = placement_of(frame, tf2::Transform::getIdentity(), *context_);
  if (!north) {
    statuses_.set(rviz::StatusProperty::Error, "Transform", missing_transform("north", frame, *context_));
    return false;
  }
  statuses_.set(rviz::StatusProperty::Ok, "Transform", "[" + frame + "]");
  const Ogre::Vector3 right = north->orientation.Inverse() * camera->getDerivedRight();
  north_degrees_ = std::round(degrees_of_radian *
                              render::north_angle({static_cast<double>(right.x), static_cast<double>(right.y),
                                                   static_cast<double>(right.z)}));
  if (const std::optional<Ogre::Vector3> focus = focus_of(*view))
    bar_ = render::scale_bar(static_cast<double>(metres_per_pixel(*viewport, *focus)), longest_bar);
  return true;
}

void ScaleBarDisplay::draw() {
  const std::string now = std::to_string(north_degrees_) + ' ' + length().toStdString() + ' ' +
                          std::to_string(std::lround(bar_pixels()));
  if (now == drawn_) return;
  drawn_ = now;
  QImage picture(scale_width, scale_height, QImage::Format_ARGB32);
  picture.fill(QColor(20, 20, 20, 160));
  QPainter painter(&picture);
  painter.setPen(Qt::white);
  painter.setFont(QFont("Sans", 10, QFont::Bold));
  if (bar_) draw_scale(painter, *bar_);
  draw_north(painter, north_degrees_);
  painter.end();
  picture_->draw(picture);
}

}  // namespace desert_sim

PLUGINLIB_EXPORT_CLASS(desert_sim::ScaleBarDisplay, rviz::Display)
