#include "src/rviz/wind_dial.hpp"

#include <QPainter>
#include <algorithm>
#include <cmath>

#include "src/core/constants.hpp"
#include "src/rviz/mouse_position.hpp"

namespace desert_sim {

namespace {

constexpr double shortest_scale = 10, fastest = 100;  // [m/s]; ~set_wind takes no more than the latter
constexpr int margin = 16;                            // for the letters of the compass [pixels]

/// Between two rings [m/s]; the scale is a multiple of it.
double ring_step(double scale) { return scale > 30 ? 20 : 5; }

void draw_needle(QPainter& painter, const QPointF& from, const QPointF& to, const QColor& colour,
                 double width) {
  const QPointF along = to - from;
  const double length = std::hypot(along.x(), along.y());
  painter.setPen(QPen(colour, width, Qt::SolidLine, Qt::RoundCap));
  painter.drawLine(from, to);
  if (length < 1) return;
  const QPointF unit = along / length, across(-unit.y(), unit.x());
  const double head = std::min(length, 4 + 3 * width);
  painter.setBrush(colour);
  painter.drawPolygon(
      QPolygonF({to, to - head * unit + 0.45 * head * across, to - head * unit - 0.45 * head * across}));
}

}  // namespace

WindDial::WindDial(QWidget* parent) : QWidget(parent) {
  setSizePolicy(QSizePolicy::Preferred, QSizePolicy::Fixed);
  setCursor(Qt::PointingHandCursor);
  setToolTip("Drag the needle to where the wind is to blow, as far as it is to be fast.");
}

double WindDial::radius() const { return 0.5 * std::min(width(), height()) - margin; }

DialWind WindDial::wind_at(const QPointF& point) const {
  const QPointF offset = point - QPointF(0.5 * width(), 0.5 * height());
  const double length = std::min(1.0, std::hypot(offset.x(), offset.y()) / radius());
  const double angle = std::atan2(-offset.y(), offset.x()) * 180 / pi;
  return {angle < 0 ? angle + 360 : angle, length * scale_};
}

QPointF WindDial::point_of(const DialWind& wind) const {
  const double angle = wind.direction_deg * pi / 180, length = std::min(1.0, wind.speed / scale_) * radius();
  return {0.5 * width() + length * std::cos(angle), 0.5 * height() - length * std::sin(angle)};
}

void WindDial::set_wanted(const DialWind& wind) {
  wanted_ = wind;
  fit_scale();
  update();
}

void WindDial::set_present(const DialWind& wind) {
  present_ = wind;
  fit_scale();
  update();
}

void WindDial::fit_scale() {
  if (dragging_) return;  // the pointer would mean another speed
  const double needed = 1.2 * std::max(wanted_.speed, present_.speed);
  const double step = ring_step(needed);
  scale_ = std::min(fastest, std::max(shortest_scale, step * std::ceil(needed / step)));
}

void WindDial::drag_to(const QPointF& point) {
  wanted_ = wind_at(point);
  // Whole degrees and tenths are what a pointer can tell.
  wanted_.direction_deg = std::fmod(std::round(wanted_.direction_deg), 360);
  wanted_.speed = std::round(10 * wanted_.speed) / 10;
  update();
  Q_EMIT dragged();
}

void WindDial::mousePressEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton) return;
  dragging_ = true;
  drag_to(position_of(*event));
}

void WindDial::mouseMoveEvent(QMouseEvent* event) {
  if (dragging_) drag_to(position_of(*event));
}

void WindDial::mouseReleaseEvent(QMouseEvent* event) {
  if (!dragging_ || event->button() != Qt::LeftButton) return;
  drag_to(position_of(*event));
  dragging_ = false;
  fit_scale();
  Q_EMIT released();
}

void WindDial::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const QPointF centre(0.5 * width(), 0.5 * height());
  const QColor text = palette().color(QPalette::WindowText);
  QColor faint = text;
  faint.setAlpha(60);
  painter.setBrush(palette().color(QPalette::Base));
  const int rings = static_cast<int>(std::lround(scale_ / ring_step(scale_)));
  for (int n = rings; n > 0; --n) {
    painter.setPen(QPen(faint, 1));
    painter.drawEllipse(centre, radius() * n / rings, radius() * n / rings);
    painter.setBrush(Qt::NoBrush);
  }
  painter.setPen(text);
  const char* const letters[] = {"E", "N", "W", "S"};
  for (int n = 0; n < 4; ++n) {
    const QPointF at =
        centre + (radius() + 0.5 * margin) * QPointF(std::cos(n * pi / 2), -std::sin(n * pi / 2));
    painter.drawText(QRectF(at.x() - margin, at.y() - margin, 2 * margin, 2 * margin), Qt::AlignCenter,
                     letters[n]);
  }
  QFont small = font();
  small.setPointSizeF(0.8 * small.pointSizeF());
  painter.setFont(small);
  for (int n = 1; n <= rings; ++n) {
    const QPointF at = centre + radius() * n / rings * QPointF(std::cos(-pi / 4), -std::sin(-pi / 4));
    painter.drawText(at + QPointF(-12, -1), QString::number(scale_ * n / rings));
  }
  draw_needle(painter, centre, point_of(present_), QColor(130, 130, 130), 5);
  draw_needle(painter, centre, point_of(wanted_), QColor(21, 101, 192), 2.5);
}

}  // namespace desert_sim
