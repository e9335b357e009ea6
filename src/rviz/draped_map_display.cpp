#include "src/rviz/draped_map_display.hpp"

#include <rviz/display_context.h>
#include <rviz/properties/bool_property.h>
#include <rviz/properties/enum_property.h>
#include <rviz/properties/float_property.h>
#include <rviz/properties/ros_topic_property.h>
#include <rviz/properties/string_property.h>

#include <pluginlib/class_list_macros.hpp>

#include "src/core/error.hpp"
#include "src/rviz/names.hpp"
#include "src/rviz/processor_time.hpp"
#include "src/rviz/terrain_display.hpp"

namespace desert_sim {

using render::CostPalette;
using rviz::StatusProperty;

DrapedMapDisplay::DrapedMapDisplay() {
  topic_ = new rviz::RosTopicProperty(
      "Topic", "desert_sim/costmap",
      QString::fromStdString(ros::message_traits::datatype<nav_msgs::OccupancyGrid>()),
      "A map of costs, 0 ... 100. Updates are taken from the topic of the same name with _updates.", this,
      SLOT(subscribe()));
  node_ = new rviz::StringProperty("Node", "desert_sim",
                                   "The map lies on the ground of the display desert_sim/Terrain that shows "
                                   "this simulator's node.",
                                   this);
  alpha_ =
      new rviz::FloatProperty("Alpha", 0.6F, "How much of the ground's own colour the highest costs hide.",
                              this, SLOT(update_look()));
  alpha_->setMin(0);
  alpha_->setMax(1);
  colours_ = new rviz::EnumProperty("Colours", "present",
                                    "Yellow to red for costs of now, teal for those of a forecast.", this,
                                    SLOT(update_look()));
  colours_->addOption("present", static_cast<int>(CostPalette::present));
  colours_->addOption("forecast", static_cast<int>(CostPalette::forecast));
  unknown_ =
      new rviz::BoolProperty("Unknown", true, "Hatch cells of unknown cost.", this, SLOT(update_look()));
  legend_wanted_ = new rviz::BoolProperty("Legend", true, "Show the colours in the picture.", this);
}

DrapedMapDisplay::~DrapedMapDisplay() { inbox_.unsubscribe(); }

// ---- what rviz calls ----

void DrapedMapDisplay::onInitialize() {
  coat_ = std::make_unique<GroundCoat>();
  legend_ = std::make_unique<Legend>();
}

void DrapedMapDisplay::onEnable() { subscribe(); }
void DrapedMapDisplay::onDisable() { unsubscribe(); }

void DrapedMapDisplay::reset() {
  Display::reset();
  if (isEnabled()) subscribe();
}

void DrapedMapDisplay::setTopic(const QString& topic, const QString&) { topic_->setString(topic); }

void DrapedMapDisplay::update(float, float) {
  const double begin = processor_seconds();
  take_changes();
  if (place() && legend_wanted_->getBool())
    legend_->show(getNameStd(), static_cast<CostPalette>(colours_->getOptionInt()));
  else
    legend_->hide();
  report();
  frame_milliseconds_ = 1e3 * (processor_seconds() - begin);
}

// ---- the map ----

void DrapedMapDisplay::subscribe() {
  if (!initialized() || !isEnabled()) return;
  unsubscribe();
  clearStatuses();
  statuses_.clear();
  try {
    inbox_.subscribe(threaded_nh_, full_name(topic_->getTopicStd(), "topic"));
  } catch (const ConfigError& error) {
    statuses_.set(StatusProperty::Error, "Topic", std::string(error.what()) + ". Choose another Topic.");
  }
}

void DrapedMapDisplay::unsubscribe() {
  inbox_.unsubscribe();
  map_ = {};
  if (coat_) coat_->hide();
  if (legend_) legend_->hide();
}

void DrapedMapDisplay::update_look() {
  if (map_.costs.empty()) return;
  paint_cells(map_.all());
  context_->queueRender();
}

void DrapedMapDisplay::take_changes() {
  inbox_.take([this](const CostMap& map, const render::CellRectangle& changed, bool replaced) {
    map_ = map;
    if (replaced) coat_->set_grid(map.width, map.height, map.cell_size);
    paint_cells(changed);
    context_->queueRender();
  });
}

/// The outermost cells stay free: the ground beyond them, and the walls at the edges of a terrain, have their
/// colour.
void DrapedMapDisplay::paint_cells(const render::CellRectangle& cells) {
  const auto palette = static_cast<CostPalette>(colours_->getOptionInt());
  const float alpha = alpha_->getFloat();
  const bool unknown = unknown_->getBool();
  const render::CellRectangle inner = map_.all().grown(-1);
  const render::PackedColour free = render::cost_pixel(palette, render::free_cost, alpha, 0, 0);
  std::vector<render::PackedColour> pixels;
  pixels.reserve(static_cast<std::size_t>(cells.width) * static_cast<std::size_t>(cells.height));
  for (int y = cells.y; y < cells.top(); ++y)
    for (int x = cells.x; x < cells.right(); ++x) {
      const std::int8_t cost = map_.at(x, y);
      const bool drawn = inner.contains(x, y) && (unknown || (cost >= 0 && cost <= render::lethal_cost));
      pixels.push_back(drawn ? render::cost_pixel(palette, cost, alpha, x, y) : free);
    }
  coat_->write(cells, pixels);
}

/// Lays the map where tf says that its frame is. False if nothing is shown: a status says why.
bool DrapedMapDisplay::place() {
  const TerrainDisplay* const terrain = ground();
  std::optional<Placement> corner;
  if (!map_.costs.empty()) {
    corner = placement_of(map_.frame, map_.corner, *context_);
    if (corner)
      statuses_.set(StatusProperty::Ok, "Transform", "[" + map_.frame + "]");
    else
      statuses_.set(StatusProperty::Error, "Transform", missing_transform("map", map_.frame, *context_));
  }
  if (terrain && corner)
    coat_->show(*terrain, *corner);
  else
    coat_->hide();
  return terrain && corner;
}

/// The display of the node's terrain; null and a status if there is none.
const TerrainDisplay* DrapedMapDisplay::ground() {
  try {
    const std::string node = full_name(node_->getStdString(), "node");
    const TerrainDisplay* const terrain = terrain_display(*context_, node);
    if (terrain)
      statuses_.set(StatusProperty::Ok, "Ground", "of " + node);
    else
      statuses_.set(StatusProperty::Error, "Ground",
                    "No enabled display desert_sim/Terrain shows the terrain of " + node +
                        ", on which the map could lie: add one.");
    return terrain;
  } catch (const ConfigError& error) {
    statuses_.set(StatusProperty::Error, "Ground", std::string(error.what()) + ". Choose another Node.");
    return nullptr;
  }
}

// ---- status ----

void DrapedMapDisplay::report() {
  if (!inbox_.subscribed()) return;
  const CostMapInbox::Report report = inbox_.report();
  const std::string topic = topic_->getTopicStd();
  if (!report.problem.empty())
    statuses_.set(StatusProperty::Error, "Topic", "A message was refused: " + report.problem + ".");
  else if (report.maps > 0)
    statuses_.set(StatusProperty::Ok, "Topic",
                  std::to_string(report.maps) + " maps, " + std::to_string(report.updates) + " updates");
  else if (inbox_.connected())
    statuses_.set(StatusProperty::Warn, "Topic", "Waiting for the first map of " + topic + ".");
  else
    statuses_.set(StatusProperty::Warn, "Topic", "Nobody publishes " + topic + " yet.");
}

}  // namespace desert_sim

PLUGINLIB_EXPORT_CLASS(desert_sim::DrapedMapDisplay, rviz::Display)
