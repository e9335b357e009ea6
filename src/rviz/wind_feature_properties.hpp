#pragma once
/// The properties of a tool that say what feature of the wind it places next.

#include <QObject>

#include "src/rviz/wind_features.hpp"

namespace rviz {
class EnumProperty;
class FloatProperty;
class IntProperty;
class Property;
}  // namespace rviz

namespace desert_sim {

class WindFeatureProperties : public QObject {
  Q_OBJECT

 public:
  /// Below `parent`, which owns the properties.
  explicit WindFeatureProperties(rviz::Property* parent);

  /// The feature without an id, at the origin.
  WindFeatureItem feature() const;
  /// The next feature is as large as this one, which was dragged.
  void take_size(const WindFeatureItem& feature);
  /// The next patch of turbulence has another seed.
  void next_seed();
  /// By a tenth for each notch of a mouse wheel.
  void scale_radius(double notches);
  void scale_speed(double notches);

 private Q_SLOTS:
  void choose_kind();

 private:
  rviz::EnumProperty* kind_;
  rviz::FloatProperty *speed_, *radius_, *direction_, *length_, *scale_, *life_time_;
  rviz::IntProperty* seed_;
};

}  // namespace desert_sim
