#include "src/rviz/overlay_properties.hpp"

#include <rviz/properties/bool_property.h>
#include <rviz/properties/editable_enum_property.h>
#include <rviz/properties/enum_property.h>
#include <rviz/properties/float_property.h>

#include "include/desert_sim/client/terrain_client.hpp"

namespace desert_sim {

namespace {

constexpr const char* none = "none";
constexpr int by_layer = -1;

/// The values of some cells, evenly spread: enough for a range, and quick on any grid.
std::vector<float> some_values(const LayerMap& map) {
  constexpr std::uint32_t across = 200;
  const LayerMap::Info& info = map.info();
  const std::uint32_t step_x = info.width / across + 1, step_y = info.height / across + 1;
  std::vector<float> values;
  for (std::uint32_t y = step_y / 2; y < info.height; y += step_y)
    for (std::uint32_t x = step_x / 2; x < info.width; x += step_x) values.push_back(map.at(x, y));
  return values;
}

}  // namespace

OverlayProperties::OverlayProperties(const QString& name, const QString& what, rviz::Property* parent) {
  layer_ = new rviz::EditableEnumProperty(name, none, what, parent, SLOT(choose_layer()), this);
  layer_->addOption(none);
  for (const render::LayerStyle& style : render::layer_styles())
    layer_->addOption(QString::fromStdString(style.layer));
  automatic_ =
      new rviz::BoolProperty("Automatic Range", true, "From the smallest to the largest value of the layer.",
                             layer_, SLOT(choose_range()), this);
  low_ = new rviz::FloatProperty("Minimum", 0, "The value with the first colour.", layer_, SIGNAL(changed()),
                                 this);
  high_ = new rviz::FloatProperty("Maximum", 1, "The value with the last colour.", layer_, SIGNAL(changed()),
                                  this);
  colours_ = new rviz::EnumProperty("Colours", "by layer", "The colours of the range.", layer_,
                                    SIGNAL(changed()), this);
  colours_->addOption("by layer", by_layer);
  colours_->addOption("sequential", static_cast<int>(render::ColourMap::sequential));
  colours_->addOption("diverging", static_cast<int>(render::ColourMap::diverging));
  colours_->addOption("signal", static_cast<int>(render::ColourMap::signal));
  opacity_ =
      new rviz::FloatProperty("Opacity", 0.7F, "How much of the ground's own colour the overlay hides.",
                              layer_, SIGNAL(changed()), this);
  opacity_->setMin(0);
  opacity_->setMax(1);
  legend_ = new rviz::BoolProperty("Legend", true, "Show colours and range in the picture.", layer_,
                                   SIGNAL(changed()), this);
  period_ =
      new rviz::FloatProperty("Change Over", 0,
                              "For the overlay 'change': since so many simulated seconds ago; 0: since the "
                              "moment of 'Mark Now', or since the first map.",
                              layer_, SLOT(choose_period()), this);
  period_->setMin(0);
  mark_ =
      new rviz::BoolProperty("Mark Now", false, "For the overlay 'change': compare with the present terrain.",
                             layer_, SLOT(mark()), this);
}

render::Overlay OverlayProperties::overlay() const {
  render::Overlay overlay;
  const std::string layer = layer_->getStdString();
  if (layer.empty() || layer == none) return overlay;
  overlay.layer = layer;
  overlay.low = low_->getFloat();
  overlay.high = high_->getFloat();
  const int map = colours_->getOptionInt();
  overlay.map = map == by_layer ? render::layer_style(layer).map : static_cast<render::ColourMap>(map);
  overlay.opacity = opacity_->getFloat();
  return overlay;
}

rviz::Property* OverlayProperties::property() const { return layer_; }

bool OverlayProperties::shows_change() const { return layer_->getStdString() == render::change_layer; }

bool OverlayProperties::legend() const { return legend_->getBool(); }

std::string OverlayProperties::title() const {
  const std::string layer = layer_->getStdString(), unit = render::layer_style(layer).unit;
  std::string title = layer;
  if (layer == render::change_layer && shown_reference_)
    title += " since step " + std::to_string(shown_reference_->info().step);
  return unit == "1" ? title : title + " [" + unit + "]";
}

// ---- maps ----

void OverlayProperties::see(const LayerMap& map) {
  if (!range_wanted_ || map.info().layer != layer_->getStdString()) return;
  const render::ValueRange range = render::range_of(some_values(map));
  // A style whose range goes down (traversability, whose 0 is the warning) keeps its direction.
  const bool down = render::layer_style(map.info().layer).low > render::layer_style(map.info().layer).high;
  down ? set_range(range.high, range.low) : set_range(range.low, range.high);
}

void OverlayProperties::see_elevation(const std::shared_ptr<const LayerMap>& map) {
  see(*map);
  history_.add(map->info().sim_time, map);
  compare_again();
}

void OverlayProperties::clear() {
  history_.clear();
  shown_reference_.reset();
  range_wanted_ = automatic_->getBool();
}

void OverlayProperties::compare_again() {
  if (history_.reference() == shown_reference_) return;
  shown_reference_ = history_.reference();
  if (shows_change()) Q_EMIT changed();
}

void OverlayProperties::set_range(float low, float high) {
  range_wanted_ = false;
  low_->setFloat(low);
  high_->setFloat(high);
}

// ---- what a user changes ----

void OverlayProperties::choose_layer() {
  choose_range();
  Q_EMIT changed();
}

void OverlayProperties::choose_range() {
  if (!automatic_->getBool()) return;
  const render::LayerStyle style = render::layer_style(layer_->getStdString());
  set_range(style.low, style.high);
  range_wanted_ = true;  // until a map says more
}

void OverlayProperties::choose_period() {
  history_.set_seconds(static_cast<double>(period_->getFloat()));
  compare_again();
}

void OverlayProperties::mark() {
  if (!mark_->getBool()) return;
  history_.mark();
  mark_->setBool(false);
  compare_again();
}

}  // namespace desert_sim
