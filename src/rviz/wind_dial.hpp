#pragma once
/// A dial for the wind: the needle points to where it blows, and is as long as it is fast.

#include <QWidget>

namespace desert_sim {

/// A wind in the frame of the terrain.
struct DialWind {
  double direction_deg = 0;  ///< where it blows to, counter-clockwise from +x (east), 0 ... 360
  double speed = 0;          ///< [m/s]
};

/// East is on the right, north at the top. The wanted wind is dragged; the present one is drawn behind it.
/// The property `wanted_speed` is for tests.
class WindDial : public QWidget {
  Q_OBJECT
  Q_PROPERTY(double wanted_speed READ wanted_speed)

 public:
  explicit WindDial(QWidget* parent = nullptr);

  DialWind wanted() const { return wanted_; }
  double wanted_speed() const { return wanted_.speed; }  ///< [m/s]
  /// A speed beyond the scale makes the scale longer.
  void set_wanted(const DialWind& wind);
  void set_present(const DialWind& wind);
  bool dragging() const { return dragging_; }
  double scale() const { return scale_; }  ///< the speed at the rim [m/s]

  /// The wind at a point of the widget, and the point of a wind.
  DialWind wind_at(const QPointF& point) const;
  QPointF point_of(const DialWind& wind) const;

  QSize sizeHint() const override { return {170, 170}; }
  QSize minimumSizeHint() const override { return {120, 120}; }

 Q_SIGNALS:
  void dragged();   ///< the wanted wind follows the pointer
  void released();  ///< the pointer was let go: this is what is wanted

 protected:
  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;

 private:
  double radius() const;  ///< [pixels]
  void drag_to(const QPointF& point);
  void fit_scale();

  DialWind wanted_, present_;
  double scale_ = 10;
  bool dragging_ = false;
};

}  // namespace desert_sim
