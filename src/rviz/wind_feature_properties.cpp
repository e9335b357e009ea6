#include "src/rviz/wind_feature_properties.hpp"

#include <rviz/properties/enum_property.h>
#include <rviz/properties/float_property.h>
#include <rviz/properties/int_property.h>

#include <cmath>
#include <limits>

namespace desert_sim {

namespace {

struct Kind {
  const char* label;
  std::string name;  ///< of ~edit_wind
};
const Kind kinds[] = {{"Vortex", EditWind::Request::VORTEX},
                      {"Jet", EditWind::Request::JET},
                      {"Turbulence", EditWind::Request::TURBULENCE},
                      {"Sink", EditWind::Request::SINK}};

double value_of(const rviz::FloatProperty* property) { return static_cast<double>(property->getFloat()); }

void scale(rviz::FloatProperty* property, double notches) {
  property->setFloat(static_cast<float>(value_of(property) * std::pow(1.1, notches)));
}

}  // namespace

WindFeatureProperties::WindFeatureProperties(rviz::Property* parent) {
  const auto number = [&](const char* name, float value, float low, float high, const char* text) {
    auto* const property = new rviz::FloatProperty(name, value, text, parent);
    property->setMin(low);
    property->setMax(high);
    return property;
  };
  kind_ = new rviz::EnumProperty("Kind", "Vortex", "What a press places.", parent, SLOT(choose_kind()), this);
  int option = 0;
  for (const Kind& kind : kinds) kind_->addOption(kind.label, option++);
  speed_ = number("Speed", 5, -100, 100,
                  "Largest speed that it adds [m/s]; below 0 a vortex turns clockwise, and a sink blows "
                  "outwards. Ctrl and the wheel change it.");
  radius_ = number("Radius", 15, 0.1f, 1e5f,
                   "Radius; of a jet half its width [m]. The wheel changes it, and a drag, but for a jet.");
  direction_ = number("Direction", 0, -360, 360,
                      "Where a jet blows to, counter-clockwise from east [deg]. A drag sets it.");
  length_ = number("Length", 40, 0.1f, 1e5f, "Half the length of a jet [m]. A drag sets it.");
  scale_ = number("Eddy Size", 8, 0.1f, 1e5f, "Size of the eddies of turbulence [m].");
  life_time_ = number("Life Time", 20, 0.01f, 1e6f, "Simulated time in which turbulence renews itself [s].");
  seed_ = new rviz::IntProperty("Seed", 1, "Of turbulence; each patch that is placed raises it.", parent);
  seed_->setMin(0);
  choose_kind();
}

WindFeatureItem WindFeatureProperties::feature() const {
  WindFeatureItem f;
  f.kind = kinds[kind_->getOptionInt()].name;
  f.speed = value_of(speed_);
  f.radius = value_of(radius_);
  f.direction_deg = value_of(direction_);
  f.length = value_of(length_);
  f.scale = value_of(scale_);
  f.life_time = value_of(life_time_);
  f.seed = seed_->getInt();
  return f;
}

void WindFeatureProperties::take_size(const WindFeatureItem& feature) {
  if (!has_direction(feature)) return void(radius_->setFloat(static_cast<float>(feature.radius)));
  direction_->setFloat(static_cast<float>(feature.direction_deg));
  length_->setFloat(static_cast<float>(feature.length));
}

void WindFeatureProperties::next_seed() {
  seed_->setInt(seed_->getInt() < std::numeric_limits<int>::max() ? seed_->getInt() + 1 : 0);
}

void WindFeatureProperties::scale_radius(double notches) { scale(radius_, notches); }
void WindFeatureProperties::scale_speed(double notches) { scale(speed_, notches); }

void WindFeatureProperties::choose_kind() {
  const WindFeatureItem now = feature();
  direction_->setHidden(!has_direction(now));
  length_->setHidden(!has_direction(now));
  scale_->setHidden(!has_eddies(now));
  life_time_->setHidden(!has_eddies(now));
  seed_->setHidden(!has_eddies(now));
}

}  // namespace desert_sim
