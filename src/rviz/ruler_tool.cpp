#include "src/rviz/ruler_tool.hpp"

#include <rviz/display_context.h>
#include <rviz/properties/string_property.h>
#include <rviz/tool_manager.h>
#include <rviz/viewport_mouse_event.h>

#include <cmath>
#include <cstdio>
#include <pluginlib/class_list_macros.hpp>

namespace desert_sim {

namespace {

constexpr const char* unknown_ground = "no ground known there";

template <class... Numbers>
std::string formatted(const char* format, Numbers... numbers) {
  char text[160];
  std::snprintf(text, sizeof text, format, numbers...);
  return text;
}

std::string text_of(const render::Measurement& m) {
  constexpr double degrees = 180 / 3.14159265358979323846;
  const std::string distance = formatted("%.2f m", m.horizontal);
  if (std::isnan(m.height_difference)) return distance + "\n" + unknown_ground;
  return distance +
         (std::isnan(m.along_surface) ? ", the ground is not known all along"
                                      : formatted(", along the ground %.2f m", m.along_surface)) +
         formatted("\nheight %+.2f m, slope %.1f deg (%.0f %%)", m.height_difference, degrees * m.slope,
                   100 * std::tan(m.slope));
}

/// The known point that is nearest to the middle of a line; empty without any.
std::optional<render::Point> middle_of(const std::vector<render::Point>& line) {
  std::optional<render::Point> found;
  const auto middle = static_cast<std::ptrdiff_t>(line.size() / 2);
  std::ptrdiff_t nearest = static_cast<std::ptrdiff_t>(line.size()) + 1;
  for (std::ptrdiff_t n = 0; n < static_cast<std::ptrdiff_t>(line.size()); ++n) {
    const render::Point& p = line[static_cast<std::size_t>(n)];
    if (std::isnan(p.z()) || std::abs(n - middle) >= nearest) continue;
    nearest = std::abs(n - middle);
    found = p;
  }
  return found;
}

}  // namespace

RulerTool::RulerTool() {
  shortcut_key_ = 'r';
  node_ = new rviz::StringProperty("Node", "desert_sim", "The simulator's node whose terrain is measured.",
                                   getPropertyContainer(), SLOT(choose_node()), this);
}

RulerTool::~RulerTool() = default;

void RulerTool::onInitialize() {
  terrain_ = std::make_unique<TerrainPicker>(*context_);
  marks_ = std::make_unique<SurfaceMarks>(*scene_manager_);
}

void RulerTool::choose_node() {
  if (!terrain_ || context_->getToolManager()->getCurrentTool() != this) return;
  deactivate();
  activate();
}

void RulerTool::activate() { terrain_->follow(node_->getStdString()); }

void RulerTool::deactivate() {
  hovered_.reset();
  pointing_ = false;
  first_.reset();
  second_.reset();
  text_.clear();
  marks_->hide();
  terrain_->follow("");
}

int RulerTool::processMouseEvent(rviz::ViewportMouseEvent& event) {
  viewport_ = event.viewport;
  const bool ruler = !event.alt() && (event.left() || event.leftUp());
  const bool hover = event.type == QEvent::MouseMove && event.buttons_down == Qt::NoButton;
  if (!ruler && !hover) terrain_->give_to_view(event);
  hovered_.reset();
  pointing_ = event.type != QEvent::Leave && terrain_->update();
  if (pointing_) hovered_ = terrain_->pick(event);
  if (event.leftDown() && !event.alt()) click();
  draw();
  return Render;
}

/// The first click begins, the second one ends, a third one begins anew.
void RulerTool::click() {
  if (!hovered_) return;
  if (!first_ || second_) {
    first_ = hovered_;
    second_.reset();
  } else {
    second_ = hovered_;
  }
}

void RulerTool::update(float, float) {
  if (viewport_ && terrain_->update()) draw();
}

void RulerTool::draw() {
  const std::optional<render::Point> end = second_ ? second_ : hovered_;
  std::vector<SurfaceMarks::Line> lines;
  const render::PackedColour colour = render::pack({1, 0.95f, 0.2f});
  const auto cross = [&](const render::Point& p) {
    const double arm = 0.75 * terrain_->field().cell_size;
    lines.push_back({render::drape(terrain_->field(), {{p.x() - arm, p.y()}, {p.x() + arm, p.y()}}), colour});
    lines.push_back({render::drape(terrain_->field(), {{p.x(), p.y() - arm}, {p.x(), p.y() + arm}}), colour});
  };
  if (!terrain_->field().empty()) {
    if (first_) cross(*first_);
    if (end) cross(*end);
  }
  std::optional<render::Point> middle;
  if (first_ && end && !terrain_->field().empty()) {
    lines.push_back(
        {render::drape(terrain_->field(), {{first_->x(), first_->y()}, {end->x(), end->y()}}), colour});
    text_ = text_of(render::measure(lines.back().points));
    middle = middle_of(lines.back().points);
  } else {
    text_ = pointing_ && !end ? unknown_ground : "";
  }
  marks_->show_text(*terrain_, middle ? text_ : "", middle.value_or(render::Point::Zero()), *viewport_);
  marks_->show(*terrain_, lines);
  show_status();
}

void RulerTool::show_status() {
  std::string text = terrain_->problem().empty() ? text_ : terrain_->problem();
  for (char& c : text)
    if (c == '\n') c = ' ';
  setStatus(QString::fromStdString(
      (text.empty() ? "" : "<b>" + text + "</b> ") +
      "<b>Left:</b> begin and end of the line. <b>Middle, Right, Alt+Left:</b> camera."));
}

}  // namespace desert_sim

PLUGINLIB_EXPORT_CLASS(desert_sim::RulerTool, rviz::Tool)
