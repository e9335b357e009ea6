#pragma once
/// A drawing of a wind schedule: a petal for each direction in which the wind blows.

#include <QWidget>
#include <vector>

namespace desert_sim {

/// East is on the right, north at the top, as on the dial: a petal points to where the wind blows, and is as
/// long as that wind's share of the time. Winds of one direction are one petal; the faster, the darker. The
/// property `petals`, their number, is for tests.
class WindRose : public QWidget {
  Q_OBJECT
  Q_PROPERTY(int petals READ petals)

 public:
  struct Petal {
    double direction_deg;  ///< where it blows to, 0 ... 360
    double speed;          ///< mean [m/s]
    double share;          ///< of the time, 0 ... 1
  };

  explicit WindRose(QWidget* parent = nullptr);

  /// Winds with shares that need not add up to 1. Those that never blow, or are calm, are left out.
  void set_winds(const std::vector<Petal>& winds);
  int petals() const { return static_cast<int>(petals_.size()); }

  QSize sizeHint() const override { return {110, 110}; }
  QSize minimumSizeHint() const override { return {90, 90}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  std::vector<Petal> petals_;
};

}  // namespace desert_sim
