#include "src/rviz/drive_pad.hpp"

#include <QKeyEvent>
#include <QPainter>
#include <algorithm>
#include <cmath>

#include "src/rviz/mouse_position.hpp"

namespace desert_sim {

namespace {

constexpr int period = 100;         // [ms]
constexpr double still = 0.08;      // so near to the middle is the middle, as a share of the radius
constexpr double knob_share = 0.2;  // of the radius
constexpr int margin = 6;           // [pixels]

bool is_arrow(int key) {
  return key == Qt::Key_Up || key == Qt::Key_Down || key == Qt::Key_Left || key == Qt::Key_Right;
}

}  // namespace

DrivePad::DrivePad(QWidget* parent) : QWidget(parent) {
  setFocusPolicy(Qt::StrongFocus);
  setCursor(Qt::PointingHandCursor);
  setToolTip("Drag: up is forward, left and right turn; it stops when let go. Or hold the arrow keys.");
  timer_.setInterval(period);
  connect(&timer_, &QTimer::timeout, this, [this] { Q_EMIT driven(stick_.y(), -stick_.x()); });
}

DrivePad::~DrivePad() { stop(); }

double DrivePad::radius() const { return 0.5 * std::min(width(), height()) - margin; }

void DrivePad::hold(const QPointF& stick) {
  stick_ = stick;
  update();
  if (held_) return;
  held_ = true;
  Q_EMIT driven(stick_.y(), -stick_.x());
  timer_.start();
}

void DrivePad::stop() {
  keys_.clear();
  dragging_ = false;
  if (!held_) return;
  held_ = false;
  timer_.stop();
  stick_ = QPointF();
  update();
  Q_EMIT driven(0, 0);
}

void DrivePad::drag_to(const QPointF& point) {
  QPointF stick = (point - QPointF(0.5 * width(), 0.5 * height())) / radius();
  stick.setY(-stick.y());
  const double length = std::hypot(stick.x(), stick.y());
  if (length > 1) stick /= length;
  hold(length < still ? QPointF() : stick);
}

void DrivePad::mousePressEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton) return;
  dragging_ = true;
  drag_to(position_of(*event));
}

void DrivePad::mouseMoveEvent(QMouseEvent* event) {
  if (dragging_) drag_to(position_of(*event));
}

void DrivePad::mouseReleaseEvent(QMouseEvent* event) {
  if (event->button() == Qt::LeftButton) stop();
}

void DrivePad::follow_keys() {
  const auto down = [this](int key) { return keys_.contains(key) ? 1.0 : 0.0; };
  if (keys_.empty()) return stop();
  hold({down(Qt::Key_Right) - down(Qt::Key_Left), down(Qt::Key_Up) - down(Qt::Key_Down)});
}

void DrivePad::keyPressEvent(QKeyEvent* event) {
  if (!is_arrow(event->key())) return QWidget::keyPressEvent(event);
  if (event->isAutoRepeat()) return;
  keys_.insert(event->key());
  follow_keys();
}

void DrivePad::keyReleaseEvent(QKeyEvent* event) {
  if (!is_arrow(event->key())) return QWidget::keyReleaseEvent(event);
  if (event->isAutoRepeat()) return;
  keys_.remove(event->key());
  follow_keys();
}

void DrivePad::focusOutEvent(QFocusEvent* event) {
  stop();
  QWidget::focusOutEvent(event);
  update();
}

void DrivePad::hideEvent(QHideEvent* event) {
  stop();
  QWidget::hideEvent(event);
}

void DrivePad::changeEvent(QEvent* event) {
  if (event->type() == QEvent::EnabledChange && !isEnabled()) stop();
  QWidget::changeEvent(event);
}

void DrivePad::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const QPointF centre(0.5 * width(), 0.5 * height());
  const QColor text = palette().color(QPalette::WindowText);
  QColor faint = text;
  faint.setAlpha(60);
  painter.setBrush(palette().color(QPalette::Base));
  painter.setPen(hasFocus() ? QPen(palette().color(QPalette::Highlight), 2) : QPen(faint, 1));
  painter.drawEllipse(centre, radius(), radius());
  painter.setPen(QPen(faint, 1));
  painter.drawLine(centre - QPointF(radius(), 0), centre + QPointF(radius(), 0));
  painter.drawLine(centre - QPointF(0, radius()), centre + QPointF(0, radius()));
  const QPointF knob = centre + radius() * (1 - knob_share) * QPointF(stick_.x(), -stick_.y());
  painter.setPen(Qt::NoPen);
  painter.setBrush(isEnabled() ? QColor(21, 101, 192) : faint);
  painter.drawEllipse(knob, knob_share * radius(), knob_share * radius());
}

}  // namespace desert_sim
