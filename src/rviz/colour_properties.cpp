#include "src/rviz/colour_properties.hpp"

#include <rviz/properties/bool_property.h>
#include <rviz/properties/color_property.h>

#include <QColor>
#include <algorithm>

namespace desert_sim {

namespace {

/// "weak_rock" as "Weak Rock".
QString title_of(const char* name) {
  QString title = QString(name).replace('_', ' ');
  for (int n = 0; n < title.size(); ++n)
    if (n == 0 || title[n - 1] == ' ') title[n] = title[n].toUpper();
  return title;
}

render::Colour colour_of(const std_msgs::ColorRGBA& m) {
  const auto channel = [](float value) { return value >= 0 ? std::min(value, 1.0F) : 0.0F; };  // also NaN
  return {channel(m.r), channel(m.g), channel(m.b)};
}

QColor shown_colour(const render::Colour& c) {
  return QColor::fromRgbF(static_cast<qreal>(c.r), static_cast<qreal>(c.g), static_cast<qreal>(c.b));
}

}  // namespace

ColourProperties::ColourProperties(rviz::Property* parent) {
  by_scenario_ = new rviz::BoolProperty(
      "Scenario Colours", true,
      "Colours of materials as the scenario says (section appearance), else those below.", parent,
      SLOT(choose_source()), this);
  by_scenario_->setDisableChildrenIfFalse(false);
  const render::Palette palette;
  for (const render::NamedColour& one : render::palette_colours)
    colours_.push_back(new rviz::ColorProperty(title_of(one.name), shown_colour(palette.*one.colour),
                                               "Colour without light.", by_scenario_, SLOT(choose_colour()),
                                               this));
  choose_source();
}

render::Palette ColourProperties::palette() const {
  if (by_scenario_->getBool()) return of_scenario_;
  render::Palette palette;
  auto property = colours_.begin();
  for (const render::NamedColour& one : render::palette_colours) {
    const QColor colour = (*property++)->getColor();
    palette.*one.colour = {static_cast<float>(colour.redF()), static_cast<float>(colour.greenF()),
                           static_cast<float>(colour.blueF())};
  }
  return palette;
}

void ColourProperties::see(const Appearance& m) {
  render::Palette said;
  said.sand = colour_of(m.sand);
  said.soil = colour_of(m.soil);
  said.weak_rock = colour_of(m.weak_rock);
  said.hard_rock = colour_of(m.hard_rock);
  said.obstacle = colour_of(m.obstacle);
  said.vegetation = colour_of(m.vegetation);
  said.shallow_water = colour_of(m.shallow_water);
  said.deep_water = colour_of(m.deep_water);
  const bool same = std::all_of(
      std::begin(render::palette_colours), std::end(render::palette_colours),
      [&](const render::NamedColour& one) { return said.*one.colour == of_scenario_.*one.colour; });
  if (same) return;
  of_scenario_ = said;
  if (!by_scenario_->getBool()) return;
  show(of_scenario_);
  Q_EMIT changed();
}

void ColourProperties::show(const render::Palette& palette) {
  showing_ = true;
  auto property = colours_.begin();
  for (const render::NamedColour& one : render::palette_colours)
    (*property++)->setColor(shown_colour(palette.*one.colour));
  showing_ = false;
}

void ColourProperties::choose_source() {
  const bool by_scenario = by_scenario_->getBool();
  for (rviz::ColorProperty* const property : colours_) property->setReadOnly(by_scenario);
  if (by_scenario) show(of_scenario_);
  Q_EMIT changed();
}

void ColourProperties::choose_colour() {
  if (!showing_) Q_EMIT changed();
}

}  // namespace desert_sim
