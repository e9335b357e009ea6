#pragma once
/// The properties of a display's colours of materials: as the scenario says (~appearance), or a user's own.

#include <desert_sim/Appearance.h>
#include <rviz/properties/property.h>

#include <QObject>
#include <vector>

#include "src/render/palette.hpp"

namespace rviz {
class BoolProperty;
class ColorProperty;
}  // namespace rviz

namespace desert_sim {

class ColourProperties : public QObject {
  Q_OBJECT

 public:
  /// Below `parent`, which owns the properties.
  explicit ColourProperties(rviz::Property* parent);

  render::Palette palette() const;
  /// Takes over the colours of a scenario, unless the user has chosen others.
  void see(const Appearance& appearance);

 Q_SIGNALS:
  /// Something has another colour now.
  void changed();

 private Q_SLOTS:
  void choose_source();
  void choose_colour();

 private:
  void show(const render::Palette& palette);

  rviz::BoolProperty* by_scenario_;
  std::vector<rviz::ColorProperty*> colours_;  ///< in the order of render::palette_colours
  render::Palette of_scenario_;
  bool showing_ = false;  ///< the properties are being set to the scenario's colours
};

}  // namespace desert_sim
