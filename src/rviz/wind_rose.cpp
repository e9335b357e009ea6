#include "src/rviz/wind_rose.hpp"

#include <QPainter>
#include <algorithm>
#include <cmath>

#include "src/core/constants.hpp"

namespace desert_sim {

namespace {

constexpr double letters = 14, half_petal_deg = 11;  // room for the letters of the compass [pixels]
constexpr double darkest_speed = 15;                 // [m/s]

QColor speed_colour(double speed) {
  const double dark = std::clamp(speed / darkest_speed, 0.0, 1.0);
  const auto between = [&](double light, double full) {
    return static_cast<int>(light + dark * (full - light));
  };
  return {between(187, 13), between(222, 71), between(251, 161)};
}

}  // namespace

WindRose::WindRose(QWidget* parent) : QWidget(parent) {
  setSizePolicy(QSizePolicy::Preferred, QSizePolicy::Fixed);
  setToolTip(
      "The winds of the table: a petal points to where a wind blows, and is as long as its share of the "
      "time; "
      "the faster, the darker.");
}

void WindRose::set_winds(const std::vector<Petal>& winds) {
  petals_.clear();
  double sum = 0;
  for (const Petal& wind : winds) {
    if (!(wind.share > 0) || !(wind.speed > 0)) continue;
    sum += wind.share;
    const double turned = std::fmod(wind.direction_deg, 360), angle = turned < 0 ? turned + 360 : turned;
    const auto same = std::find_if(petals_.begin(), petals_.end(), [&](const Petal& p) {
      return std::abs(std::remainder(p.direction_deg - angle, 360)) < 0.5;
    });
    if (same == petals_.end()) {
      petals_.push_back({angle, wind.speed, wind.share});
      continue;
    }
    same->speed = (same->speed * same->share + wind.speed * wind.share) / (same->share + wind.share);
    same->share += wind.share;
  }
  for (Petal& petal : petals_) petal.share /= sum;
  update();
}

void WindRose::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const QPointF centre(0.5 * width(), 0.5 * height());
  const double radius = 0.5 * std::min(width(), height()) - letters;
  painter.setPen(QPen(palette().color(QPalette::Mid), 1));
  painter.setBrush(palette().brush(QPalette::Base));
  painter.drawEllipse(centre, radius, radius);
  painter.drawLine(centre - QPointF(radius, 0), centre + QPointF(radius, 0));
  painter.drawLine(centre - QPointF(0, radius), centre + QPointF(0, radius));
  double longest = 0;
  for (const Petal& petal : petals_) longest = std::max(longest, petal.share);
  for (const Petal& petal : petals_) {
    const double length = radius * petal.share / longest;
    painter.setPen(QPen(QColor(13, 71, 161), 1));
    painter.setBrush(speed_colour(petal.speed));
    // Sixteenths of a degree, counter-clockwise from the right.
    painter.drawPie(QRectF(centre.x() - length, centre.y() - length, 2 * length, 2 * length),
                    static_cast<int>(std::lround(16 * (petal.direction_deg - half_petal_deg))),
                    static_cast<int>(std::lround(16 * 2 * half_petal_deg)));
  }
  painter.setPen(palette().color(QPalette::WindowText));
  const char* const names[] = {"E", "N", "W", "S"};
  for (int n = 0; n < 4; ++n) {
    const QPointF at =
        centre + (radius + 0.5 * letters) * QPointF(std::cos(n * pi / 2), -std::sin(n * pi / 2));
    painter.drawText(QRectF(at.x() - letters, at.y() - letters, 2 * letters, 2 * letters), Qt::AlignCenter,
                     names[n]);
  }
}

}  // namespace desert_sim
