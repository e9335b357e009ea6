#include "src/rviz/terrain_properties.hpp"

#include <desert_sim/ElevationGrid.h>
#include <ros/message_traits.h>
#include <rviz/properties/bool_property.h>
#include <rviz/properties/enum_property.h>
#include <rviz/properties/float_property.h>
#include <rviz/properties/int_property.h>
#include <rviz/properties/ros_topic_property.h>

namespace desert_sim {

using render::Shading;
using rviz::BoolProperty;
using rviz::FloatProperty;
using rviz::IntProperty;

TerrainProperties::TerrainProperties(rviz::Property* parent) {
  topic_ = new rviz::RosTopicProperty(
      "Elevation Topic", "desert_sim/elevation",
      QString::fromStdString(ros::message_traits::datatype<ElevationGrid>()),
      "Keyframes of the terrain. Updates, layers, plants and wind are taken from the same node.", parent,
      SIGNAL(topic_changed()), this);
  add_ground(parent);
  add_overlays(parent);
  add_views(parent);
  add_limits(parent);
}

void TerrainProperties::add_ground(rviz::Property* parent) {
  const auto add = [&](const char* name, bool value, const char* what) {
    return new BoolProperty(name, value, what, parent, SIGNAL(look_changed()), this);
  };
  exaggeration_ = new FloatProperty("Vertical Exaggeration", 1,
                                    "Factor by which heights are multiplied when they are drawn.", parent,
                                    SIGNAL(look_changed()), this);
  exaggeration_->setMin(0.01F);
  exaggeration_->setMax(100);
  materials_ = add("Materials", true, "Colour rock, soil, sand, wet ground and plants as such.");
  colours_ = std::make_unique<ColourProperties>(materials_);
  connect(colours_.get(), SIGNAL(changed()), this, SIGNAL(look_changed()));
  water_ = add("Water", true, "Show water, if the terrain has it.");
  shading_ = new rviz::EnumProperty("Shading", "sun", "What brightens and darkens the ground.", parent,
                                    SIGNAL(look_changed()), this);
  shading_->addOption("sun", static_cast<int>(Shading::sun));
  shading_->addOption("illumination", static_cast<int>(Shading::illumination));
  shading_->addOption("sun and illumination", static_cast<int>(Shading::both));
  shadows_ = add("Shadows", true, "Let dunes and hills cast shadows.");
  ripples_ = new BoolProperty("Ripples", true,
                              "Show wind ripples of ~micro_relief as a picture on sand near the camera.",
                              parent, SIGNAL(views_changed()), this);
  micro_relief_ = new BoolProperty(
      "Micro Relief", true,
      "Show ripples and heaps at plants as shapes close to the camera, as wheels and beams feel them.",
      parent, SIGNAL(views_changed()), this);
  sky_ = new BoolProperty("Sky", true, "Show sky and sun behind the terrain, in views with a perspective.",
                          parent);
}

void TerrainProperties::add_overlays(rviz::Property* parent) {
  overlay_ = std::make_unique<OverlayProperties>("Overlay",
                                                 "The layer that is shown as colours on the ground.", parent);
  second_ = std::make_unique<OverlayProperties>("Second Overlay",
                                                "Another layer, on the first one or beside it.", parent);
  for (const OverlayProperties* const overlay : {overlay_.get(), second_.get()})
    connect(overlay, SIGNAL(changed()), this, SIGNAL(look_changed()));
  side_by_side_ = new BoolProperty("Side by Side", false,
                                   "The first overlay in the west, the second one in the east; else the "
                                   "second one lies on the first one, by its opacity.",
                                   second_->property(), SIGNAL(look_changed()), this);
  divide_ = new FloatProperty("Divide", 0.5F, "Side by side: the first one's share of the width.",
                              second_->property(), SIGNAL(look_changed()), this);
  divide_->setMin(0);
  divide_->setMax(1);
  contours_ = new FloatProperty("Contour Interval", 0, "Contour lines are so many metres apart; 0: none.",
                                parent, SIGNAL(look_changed()), this);
  contours_->setMin(0);
}

void TerrainProperties::add_views(rviz::Property* parent) {
  plants_ =
      new BoolProperty("Plants", true, "Show the plants of ~plants.", parent, SIGNAL(views_changed()), this);
  most_plants_ = new IntProperty(
      "Most Plants", 10000,
      "At most so many, the largest in the picture, are shown as shapes; all are a picture on the ground.",
      plants_);
  most_plants_->setMin(1);
  wind_ = new BoolProperty("Wind", false,
                           "Show the wind of ~wind as arrows on the ground. A scenario about wind "
                           "(appearance.wind_arrows) turns it on.",
                           parent, SIGNAL(views_changed()), this);
  most_arrows_ = new IntProperty("Most Arrows", 1000, "At most so many arrows.", wind_);
  most_arrows_->setMin(1);
}

void TerrainProperties::add_limits(rviz::Property* parent) {
  quad_pixels_ = new FloatProperty(
      "Quad Size", 4, "A quad of the mesh takes about so many pixels, if the terrain has cells enough.",
      parent, SIGNAL(limits_changed()), this);
  quad_pixels_->setMin(1);
  quad_pixels_->setMax(64);
  triangles_ =
      new IntProperty("Most Triangles", 40000, "At most so many triangles of ground are in the picture.",
                      parent, SIGNAL(limits_changed()), this);
  triangles_->setMin(1000);
  budget_ = new FloatProperty(
      "Time per Frame", 20,
      "At most so many milliseconds of each frame go into building blocks that changed.", parent);
  budget_->setMin(1);
  budget_->setMax(1000);
  fit_view_ = new BoolProperty(
      "Fit View", false,
      "Show the whole of each terrain that comes, if the view has a focal point and a distance.", parent);
}

// ---- What they say ----

double TerrainProperties::vertical_exaggeration() const {
  return static_cast<double>(exaggeration_->getFloat());
}

render::TerrainLook TerrainProperties::look() const {
  render::TerrainLook look;
  look.overlay = overlay_->overlay();
  look.second = second_->overlay();
  if (side_by_side_->getBool() && look.second.active())
    look.divide = static_cast<double>(divide_->getFloat());
  look.palette = colours_->palette();
  look.shading = static_cast<Shading>(shading_->getOptionInt());
  look.materials = materials_->getBool();
  look.water = water_->getBool();
  look.shadows = shadows_->getBool();
  look.ripples = true;
  look.vertical_exaggeration = vertical_exaggeration();
  look.contour_interval = static_cast<double>(contours_->getFloat());
  return look;
}

render::DetailLimits TerrainProperties::limits() const {
  return {static_cast<double>(quad_pixels_->getFloat()), triangles_->getInt()};
}

double TerrainProperties::budget() const { return 1e-3 * static_cast<double>(budget_->getFloat()); }
bool TerrainProperties::ripples() const { return ripples_->getBool(); }
bool TerrainProperties::micro_relief() const { return micro_relief_->getBool(); }
bool TerrainProperties::sky() const { return sky_->getBool(); }
bool TerrainProperties::plants() const { return plants_->getBool(); }
int TerrainProperties::most_plants() const { return most_plants_->getInt(); }
bool TerrainProperties::wind() const { return wind_->getBool(); }
int TerrainProperties::most_arrows() const { return most_arrows_->getInt(); }
bool TerrainProperties::fit_view() const { return fit_view_->getBool(); }

// ---- Maps and scenarios ----

std::shared_ptr<const LayerMap> TerrainProperties::reference() const {
  return second_->shows_change() && !overlay_->shows_change() ? second_->reference() : overlay_->reference();
}

void TerrainProperties::see(const LayerMap& map) {
  overlay_->see(map);
  second_->see(map);
}

void TerrainProperties::see_elevation(const std::shared_ptr<const LayerMap>& map) {
  overlay_->see_elevation(map);
  // Maps of the past take memory; an overlay that shows something else needs none.
  second_->shows_change() ? second_->see_elevation(map) : second_->see(*map);
}

void TerrainProperties::forget_maps() {
  overlay_->clear();
  second_->clear();
}

void TerrainProperties::see(const Appearance& appearance) {
  colours_->see(appearance);
  const bool wanted = appearance.wind_arrows;
  if (wanted == wind_wanted_) return;
  wind_wanted_ = wanted;
  wind_->setBool(wanted);
}

}  // namespace desert_sim
