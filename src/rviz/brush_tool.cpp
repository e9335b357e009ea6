#include "src/rviz/brush_tool.hpp"

#include <desert_sim/GetScenario.h>
#include <rviz/display_context.h>
#include <rviz/properties/editable_enum_property.h>
#include <rviz/properties/enum_property.h>
#include <rviz/properties/float_property.h>
#include <rviz/properties/string_property.h>
#include <rviz/tool_manager.h>
#include <rviz/viewport_mouse_event.h>
#include <yaml-cpp/yaml.h>

#include <QKeyEvent>
#include <cmath>
#include <pluginlib/class_list_macros.hpp>

#include "src/core/error.hpp"
#include "src/core/shortest_decimal.hpp"
#include "src/rviz/names.hpp"

namespace desert_sim {

namespace {

rviz::FloatProperty* number(const char* name, float value, float least, float most, const char* text,
                            rviz::Property* parent) {
  auto* const property = new rviz::FloatProperty(name, value, text, parent);
  property->setMin(least);
  property->setMax(most);
  return property;
}

/// What a time's property says [s].
double seconds_of(const rviz::FloatProperty* property) { return shortest_decimal(property->getFloat()); }

render::PackedColour colour_of(const Brush& brush) {
  if (brush.later) return render::pack({1, 0.85f, 0.2f});
  switch (brush.operation) {
    case Brush::Operation::add:
      return render::pack({0.25f, 1, 0.35f});
    case Brush::Operation::remove:
      return render::pack({1, 0.35f, 0.25f});
    default:
      return render::pack({0.35f, 0.75f, 1});
  }
}

}  // namespace

BrushTool::BrushTool() {
  shortcut_key_ = 'b';
  rviz::Property* const parent = getPropertyContainer();
  node_ = new rviz::StringProperty("Node", "desert_sim", "The simulator's node whose terrain is painted.",
                                   parent, SLOT(choose_node()), this);
  material_ = new rviz::EnumProperty("Material", "Sand", "What is painted.", parent);
  int option = 0;
  for (const char* const name : brush_materials()) material_->addOption(name, option++);
  operation_ = new rviz::EnumProperty(
      "Operation", "Add", "Flatten makes the layer as deep (rock: as high) as where the stroke began.",
      parent);
  option = 0;
  for (const char* const name : {"Add", "Remove", "Flatten", "Smooth"}) operation_->addOption(name, option++);
  radius_ = number("Radius", 5, 0.01f, 1e4f, "Radius of the brush [m]; the wheel changes it.", parent);
  strength_ =
      number("Strength", 0.5f, 1e-4f, 1e3f,
             "What one pass of the brush adds or removes in its middle: a depth [m], or a number in the "
             "unit of the layer, such as 0 ... 1 of vegetation; Ctrl and the wheel change it.",
             parent);
  inner_ = number("Inner Fraction", 0.5f, 0, 1,
                  "Full strength up to this fraction of the radius, from where it falls to 0.", parent);
  mask_ = new rviz::StringProperty("Mask File", "",
                                   "A raster below the node's ~data_dir: a click stamps its square, full "
                                   "strength where the raster is highest, "
                                   "none where it is lowest. Empty: a round brush that paints.",
                                   parent);
  species_ = new rviz::EditableEnumProperty(
      "Species", "", "Of plants: what is planted, or removed (empty: all); the node's species are listed.",
      parent);
  density_ = number("Plant Density", 0.1f, 1e-4f, 1000,
                    "Plants that one pass puts on a square metre; Ctrl and the wheel change it.", parent);
  size_ = number("Plant Size", 0.5f, 0.001f, 1,
                 "Their radius relative to the largest for which there is room.", parent);
  make_times(parent);
}

void BrushTool::make_times(rviz::Property* parent) {
  when_ = new rviz::EnumProperty("When", "Now",
                                 "Now, or later: a stroke becomes an entry of the scenario's timeline, which "
                                 "the panel's tab Timeline lists.",
                                 parent, SLOT(show_times()), this);
  int option = 0;
  for (const char* const name : {"Now", "From Now", "At Time"}) when_->addOption(name, option++);
  constexpr float longest = 1e12f;
  time_ = number("Time", 10, 0, longest, "Simulated time at which it is painted, or from now until then [s].",
                 when_);
  every_ = number("Every", 0, 0, longest, "Painted again each time after so long [s]; 0: once.", when_);
  until_ = number("Until", 0, 0, longest, "Simulated time of the last repetition [s]; 0: for ever.", when_);
  show_times();
}

void BrushTool::show_times() {
  for (rviz::Property* const property : {time_, every_, until_})
    property->setHidden(when_->getOptionInt() == 0);
}

BrushTool::~BrushTool() = default;

void BrushTool::onInitialize() {
  terrain_ = std::make_unique<TerrainPicker>(*context_);
  marks_ = std::make_unique<SurfaceMarks>(*scene_manager_);
  choose_node();
}

void BrushTool::choose_node() {
  if (!terrain_) return;
  release();
  client_ = std::make_unique<EditClient>(node_->getStdString());
  if (context_->getToolManager()->getCurrentTool() == this) terrain_->follow(node_->getStdString());
}

void BrushTool::activate() {
  terrain_->follow(node_->getStdString());
  ask_for_species();
}

void BrushTool::ask_for_species() {
  std::string service;
  try {
    service = full_name(node_->getStdString(), "node") + "/get_scenario";
  } catch (const ConfigError&) {
    return;  // the client tells it
  }
  caller_.call<GetScenario>(service, {},
                            [this](const CallOutcome& outcome, const GetScenarioResponse& answer) {
                              if (!outcome.success) return;  // there is no node yet; a stroke would say so
                              species_->clearOptions();
                              species_->addOption("");
                              for (const YAML::Node& species : YAML::Load(answer.yaml)["species"])
                                species_->addOptionStd(species["name"].as<std::string>());
                            });
}

void BrushTool::deactivate() {
  release();
  hovered_.reset();
  marks_->hide();
  terrain_->follow("");
}

Brush BrushTool::brush(bool shift) const {
  Brush result;
  result.material = static_cast<Brush::Material>(material_->getOptionInt());
  result.operation =
      shift ? Brush::Operation::remove : static_cast<Brush::Operation>(operation_->getOptionInt());
  result.radius = static_cast<double>(radius_->getFloat());
  result.strength = static_cast<double>(strength_->getFloat());
  result.inner = static_cast<double>(inner_->getFloat());
  result.mask = mask_->getStdString();
  result.species = species_->getStdString();
  result.density = static_cast<double>(density_->getFloat());
  result.size = static_cast<double>(size_->getFloat());
  if (when_->getOptionInt() != 0)
    result.later =
        Brush::Later{seconds_of(time_), when_->getOptionInt() == 1, seconds_of(every_), seconds_of(until_)};
  return result;
}

// ---- mouse and keys ----

int BrushTool::processMouseEvent(rviz::ViewportMouseEvent& event) {
  viewport_ = event.viewport;
  shift_ = event.shift();
  const bool camera = !painting_ && TerrainPicker::turns_view(event);
  if (camera)
    terrain_->give_to_view(event);
  else if (event.wheel_delta != 0)
    turn_wheel(event);
  hovered_ = terrain_->hover(event);
  if (event.leftDown() && !camera) press(event.shift());
  if (painting_) {
    if (hovered_)
      client_->move(terrain_->in_terrain_frame(*hovered_));
    else
      client_->lift();
  }
  if (event.leftUp()) release();
  draw();
  show_status();
  return Render;
}

void BrushTool::turn_wheel(rviz::ViewportMouseEvent& event) {
  rviz::FloatProperty* property = radius_;
  if (event.control())
    property = material_->getOptionInt() == static_cast<int>(Brush::Material::plants) ? density_ : strength_;
  const float notches = static_cast<float>(event.wheel_delta) / 120;
  property->setFloat(property->getFloat() * std::pow(1.1f, notches));
}

void BrushTool::press(bool shift) {
  const Brush chosen = brush(shift);
  const std::string problem = terrain_->problem().empty() ? problem_of(chosen) : terrain_->problem();
  failed_ = !problem.empty();
  report_ = problem;
  if (failed_ || !hovered_) return;
  client_->begin(chosen);
  painting_ = chosen.mask.empty();
  if (painting_) return;
  client_->move(terrain_->in_terrain_frame(*hovered_));
  client_->end();
}

void BrushTool::release() {
  if (painting_) client_->end();
  painting_ = false;
}

int BrushTool::processKeyEvent(QKeyEvent* event, rviz::RenderPanel*) {
  const bool control = event->modifiers() & Qt::ControlModifier,
             shift = event->modifiers() & Qt::ShiftModifier;
  const bool redo = control && (event->key() == Qt::Key_Y || (event->key() == Qt::Key_Z && shift));
  const bool undo = event->key() == Qt::Key_Z && !shift;
  if (!redo && !undo) return 0;
  release();
  if (redo)
    client_->redo();
  else
    client_->undo();
  return Render;
}

// ---- what is seen ----

void BrushTool::update(float, float) {
  if (const std::optional<EditClient::Report> report = client_->take_report()) {
    report_ = report->text;
    failed_ = !report->success;
    show_status();
  }
  if (!hovered_ || !viewport_ || !terrain_->update()) return;
  hovered_->z() = terrain_->field().height_at({hovered_->x(), hovered_->y()});  // the ground may have moved
  draw();
}

void BrushTool::draw() {
  if (!hovered_ || std::isnan(hovered_->z())) return marks_->hide();
  const Brush now = brush(shift_);
  const render::Place centre{hovered_->x(), hovered_->y()};
  const render::PackedColour colour = colour_of(now);
  const auto ring = [&](double radius) {
    return SurfaceMarks::Line{render::drape(terrain_->field(), render::circle(centre, radius)), colour};
  };
  std::vector<SurfaceMarks::Line> lines = {ring(now.radius)};
  if (!now.mask.empty()) {
    const double r = now.radius, x = centre.x, y = centre.y;
    lines = {{render::drape(terrain_->field(),
                            {{x - r, y - r}, {x + r, y - r}, {x + r, y + r}, {x - r, y + r}, {x - r, y - r}}),
              colour}};
  }
  const bool fades = now.mask.empty() && now.material != Brush::Material::plants &&
                     now.material != Brush::Material::obstacle;
  if (fades && now.inner > 0 && now.inner < 1) {
    lines.push_back(ring(now.inner * now.radius));
    lines.back().colour = (colour & 0xffffffu) | 0x70000000u;
  }
  marks_->show(*terrain_, lines);
  marks_->show_text(*terrain_, failed_ ? report_ : "", *hovered_, *viewport_);
}

void BrushTool::show_status() {
  const std::string& problem = terrain_->problem();
  const std::string text = !problem.empty() ? problem : report_;
  setStatus(QString::fromStdString((text.empty() ? "" : "<b>" + text + "</b> ") + "<b>Left:</b> paint" +
                                   (when_->getOptionInt() == 0 ? "" : " later") +
                                   ". <b>Shift:</b> remove. <b>Wheel:</b> radius. "
                                   "<b>Ctrl+Wheel:</b> strength. <b>Z:</b> undo. "
                                   "<b>Ctrl+Y:</b> redo. <b>Middle, Right, Alt+Left:</b> camera."));
}

}  // namespace desert_sim

PLUGINLIB_EXPORT_CLASS(desert_sim::BrushTool, rviz::Tool)
