#pragma once
/// A pad that one drags to drive.

#include <QSet>
#include <QTimer>
#include <QWidget>

namespace desert_sim {

/// Dragged away from its middle, or with arrow keys held while it has the focus, it tells 10 times a second
/// where to; let go, it tells once that all stops. It stops, too, when it loses the focus, is hidden or
/// disabled, or goes.
class DrivePad : public QWidget {
  Q_OBJECT

 public:
  explicit DrivePad(QWidget* parent = nullptr);
  ~DrivePad() override;

  QSize sizeHint() const override { return {170, 170}; }
  QSize minimumSizeHint() const override { return {120, 120}; }

 Q_SIGNALS:
  /// Shares of the highest speed: `forward` -1 ... 1, `left` -1 ... 1 (counter-clockwise). 0, 0: stop.
  void driven(double forward, double left);

 protected:
  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void keyReleaseEvent(QKeyEvent* event) override;
  void focusOutEvent(QFocusEvent* event) override;
  void hideEvent(QHideEvent* event) override;
  void changeEvent(QEvent* event) override;

 private:
  double radius() const;  ///< [pixels]
  void drag_to(const QPointF& point);
  void follow_keys();
  void hold(const QPointF& stick);  ///< from now on, until the next call
  void stop();

  QPointF stick_;  ///< to the right and up, each -1 ... 1
  bool held_ = false, dragging_ = false;
  QSet<int> keys_;  ///< the arrow keys that are down
  QTimer timer_;
};

}  // namespace desert_sim
