#include "src/rviz/wind_tool.hpp"

#include <rviz/display_context.h>
#include <rviz/properties/string_property.h>
#include <rviz/tool_manager.h>
#include <rviz/viewport_mouse_event.h>

#include <algorithm>
#include <cmath>
#include <pluginlib/class_list_macros.hpp>

#include "src/core/constants.hpp"
#include "src/core/error.hpp"
#include "src/rviz/names.hpp"
#include "src/rviz/view_scale.hpp"

namespace desert_sim {

namespace {

constexpr int click_pixels = 4;            // a shorter drag is a click
constexpr double pointing_pixels = 15;     // so near a centre is at it
constexpr double least = 0.1, most = 1e5;  // of ~edit_wind [m]

}  // namespace

WindTool::WindTool() {
  shortcut_key_ = 'w';
  node_ = new rviz::StringProperty("Node", "desert_sim", "The simulator's node whose wind is changed.",
                                   getPropertyContainer(), SLOT(choose_node()), this);
  next_ = std::make_unique<WindFeatureProperties>(getPropertyContainer());
}

WindTool::~WindTool() = default;

void WindTool::onInitialize() {
  terrain_ = std::make_unique<TerrainPicker>(*context_);
  marks_ = std::make_unique<SurfaceMarks>(*scene_manager_);
  feature_marks_ = std::make_unique<SurfaceMarks>(*scene_manager_);
  nodes_.setCallbackQueue(context_->getThreadedQueue());
}

void WindTool::choose_node() {
  if (!terrain_ || context_->getToolManager()->getCurrentTool() != this) return;
  deactivate();
  activate();
}

void WindTool::activate() { follow(node_->getStdString()); }

void WindTool::deactivate() {
  follow("");
  action_ = Action::none;
  hovered_.reset();
  marks_->hide();
  feature_marks_->hide();
}

void WindTool::follow(const std::string& node) {
  caller_.cancel();
  waiting_ = 0;
  features_.clear();
  features_changed_ = true;
  failed_ = false;
  report_.clear();
  terrain_->follow(node);
  list_.subscribe(nodes_, "");
  if (node.empty()) return;
  try {
    list_.subscribe(nodes_, full_name(node, "node") + "/wind_features");
  } catch (const ConfigError& error) {
    tell(false, error.what());
  }
}

WindFeatureItem WindTool::feature_here() const {
  WindFeatureItem f = next_->feature();
  const render::Place place = terrain_->in_terrain_frame(*hovered_);
  f.center.x = place.x;
  f.center.y = place.y;
  return f;
}

const WindFeatureItem* WindTool::pointed_at() const {
  if (!hovered_ || !viewport_) return nullptr;
  const render::Place mouse = terrain_->in_terrain_frame(*hovered_);
  const Ogre::Vector3 point(static_cast<float>(hovered_->x()), static_cast<float>(hovered_->y()),
                            static_cast<float>(terrain_->exaggeration() * hovered_->z()));
  const double pixel = static_cast<double>(
      metres_per_pixel(*viewport_, terrain_->corner().position + terrain_->corner().orientation * point));
  const WindFeatureItem* nearest = nullptr;
  double nearest_distance = 0;
  for (const WindFeatureItem& f : features_) {
    const double away = render::distance(mouse, centre_at(f, time_));
    if (away > std::max(cross_of(f), pointing_pixels * pixel)) continue;
    if (nearest && away >= nearest_distance) continue;
    nearest = &f;
    nearest_distance = away;
  }
  return nearest;
}

// ---- the mouse ----

int WindTool::processMouseEvent(rviz::ViewportMouseEvent& event) {
  viewport_ = event.viewport;
  modified_ = event.shift() || event.control();
  const bool camera = action_ == Action::none && TerrainPicker::turns_view(event);
  if (camera)
    terrain_->give_to_view(event);
  else if (event.wheel_delta != 0)
    turn_wheel(event);
  hovered_ = terrain_->hover(event);
  if (event.leftDown() && !camera) press(event);
  drag(event);
  if (event.leftUp()) release();
  draw();
  show_status();
  return Render;
}

void WindTool::turn_wheel(rviz::ViewportMouseEvent& event) {
  const double notches = event.wheel_delta / 120.0;
  if (event.control())
    next_->scale_speed(notches);
  else
    next_->scale_radius(notches);
  if (action_ != Action::place) return;
  made_.speed = next_->feature().speed;
  made_.radius = next_->feature().radius;
}

void WindTool::press(rviz::ViewportMouseEvent& event) {
  tell(terrain_->problem().empty(), terrain_->problem());
  if (failed_ || !hovered_) return;
  if (event.shift()) return remove();
  dragged_ = false;
  press_x_ = event.x;
  press_y_ = event.y;
  if (!event.control()) {
    made_ = feature_here();
    action_ = Action::place;
    return;
  }
  const WindFeatureItem* const found = pointed_at();
  if (!found) return tell(false, "There is no feature's centre: its cross can be dragged.");
  if (found->id == 0) return tell(false, "It has no id in the scenario, so that it cannot be moved.");
  made_ = *found;
  action_ = Action::move;
}

void WindTool::drag(rviz::ViewportMouseEvent& event) {
  if (action_ == Action::none || !hovered_) return;
  dragged_ = dragged_ || std::hypot(event.x - press_x_, event.y - press_y_) > click_pixels;
  if (!dragged_) return;
  const render::Place mouse = terrain_->in_terrain_frame(*hovered_);
  if (action_ == Action::move) {
    put_at(made_, mouse, time_);
    return;
  }
  const double away = std::clamp(render::distance(mouse, {made_.center.x, made_.center.y}), least, most);
  if (!has_direction(made_)) {
    made_.radius = away;
    return;
  }
  made_.length = away;
  made_.direction_deg = std::atan2(mouse.y - made_.center.y, mouse.x - made_.center.x) * 180 / pi;
}

void WindTool::release() {
  const Action action = std::exchange(action_, Action::none);
  if (action == Action::none || (action == Action::move && !dragged_)) return;
  if (action == Action::move) return send(wind_request(EditWind::Request::CHANGE, made_), "moved");
  if (dragged_) next_->take_size(made_);
  if (has_eddies(made_)) next_->next_seed();
  made_.id = last_id_ = free_id(features_, last_id_);
  send(wind_request(EditWind::Request::ADD, made_), "placed");
}

void WindTool::remove() {
  const WindFeatureItem* const found = pointed_at();
  if (!found) return tell(false, "There is no feature's centre: Shift and a click on its cross remove it.");
  if (found->id == 0)
    return tell(false, "It has no id in the scenario: only the panel's Delete all removes it.");
  send(wind_removal(found->id), "removed");
}

void WindTool::send(const EditWind::Request& request, const std::string& done) {
  ++waiting_;
  caller_.call<EditWind>(full_name(node_->getStdString(), "node") + "/edit_wind", request,
                         [this, request, done](const CallOutcome& outcome, const EditWind::Response&) {
                           --waiting_;
                           if (outcome.success) apply_to(features_, request);
                           features_changed_ = true;
                           tell(outcome.success, outcome.success
                                                     ? (request.kind.empty() ? "feature" : request.kind) +
                                                           " " + std::to_string(request.id) + " " + done
                                                     : outcome.message);
                           show_status();
                         });
}

void WindTool::tell(bool success, const std::string& text) {
  failed_ = !success;
  report_ = text;
}

// ---- what is seen ----

void WindTool::update(float, float) {
  if (const WindFeatureListConstPtr list = list_.take()) {
    features_ = list->features;
    time_ = list->sim_time;
    features_changed_ = true;
  }
  if (!terrain_->update()) return;
  if (hovered_)  // the ground may have moved
    hovered_->z() = terrain_->field().height_at({hovered_->x(), hovered_->y()});
  draw();
}

std::vector<SurfaceMarks::Line> WindTool::draped(const WindFeatureItem& feature, unsigned alpha) const {
  const render::Place corner = terrain_->in_terrain_frame({0, 0, 0});
  std::vector<SurfaceMarks::Line> lines;
  for (std::vector<render::Place> line : outline(feature, time_)) {
    for (render::Place& place : line) place = {place.x - corner.x, place.y - corner.y};
    lines.push_back({render::drape(terrain_->field(), line),
                     (feature_colour(feature) & 0xffffffu) | static_cast<render::PackedColour>(alpha) << 24});
  }
  return lines;
}

void WindTool::draw_features() {
  const WindFeatureItem* const pointed = action_ == Action::none ? pointed_at() : nullptr;
  const Drawn now{terrain_->map(), terrain_->corner(), terrain_->exaggeration(), pointed ? pointed->id : 0,
                  action_ == Action::move ? made_.id : 0};
  const bool same =
      !features_changed_ && now.map == drawn_.map && now.corner.position == drawn_.corner.position &&
      now.corner.orientation == drawn_.corner.orientation && now.exaggeration == drawn_.exaggeration &&
      now.pointed == drawn_.pointed && now.moved == drawn_.moved;
  if (same) return;
  std::vector<SurfaceMarks::Line> all;
  for (const WindFeatureItem& f : features_) {
    const bool faint = (f.id != 0 && f.id == now.moved) || !is_there(f, time_);
    for (SurfaceMarks::Line& line : draped(f, faint ? 0x50 : 0xff)) {
      if (&f == pointed) line.colour = render::pack({1, 1, 1});
      all.push_back(std::move(line));
    }
  }
  feature_marks_->show(*terrain_, all);
  drawn_ = now;
  features_changed_ = false;
}

void WindTool::draw() {
  if (terrain_->field().empty()) {
    feature_marks_->hide();
    return marks_->hide();
  }
  draw_features();
  const bool acts = action_ != Action::none;
  if (!viewport_ || !hovered_ || std::isnan(hovered_->z())) return marks_->hide();
  const WindFeatureItem* const pointed = pointed_at();
  std::vector<SurfaceMarks::Line> lines;
  if (acts)
    lines = draped(made_, 0xff);
  else if (!modified_ && !pointed)
    lines = draped(feature_here(), 0x70);
  marks_->show(*terrain_, lines);
  const std::string words = acts ? words_of(made_) : pointed ? words_of(*pointed) : "";
  marks_->show_text(*terrain_, failed_ && !acts ? report_ : words, *hovered_, *viewport_);
}

void WindTool::show_status() {
  const std::string& problem = terrain_->problem();
  const std::string text = !problem.empty() ? problem : report_;
  const bool jet = has_direction(next_->feature());
  setStatus(QString::fromStdString(
      (text.empty() ? "" : "<b>" + text + "</b> ") + "<b>Left:</b> place; drag for " +
      (jet ? "direction and length" : "the radius") +
      ". <b>Ctrl+Left:</b> move. <b>Shift+Left:</b> remove. <b>Wheel:</b> " + (jet ? "width" : "radius") +
      ". <b>Ctrl+Wheel:</b> speed. <b>Middle, Right, Alt+Left:</b> camera."));
}

}  // namespace desert_sim

PLUGINLIB_EXPORT_CLASS(desert_sim::WindTool, rviz::Tool)
