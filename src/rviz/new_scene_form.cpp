#include "src/rviz/new_scene_form.hpp"

#include <desert_sim/NewScenario.h>
#include <yaml-cpp/yaml.h>

#include <QComboBox>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QSpinBox>

#include "src/rviz/fields.hpp"
#include "src/scenario/sand_model.hpp"

namespace desert_sim {

namespace {

QSpinBox* whole_field(const QString& name, int low, int high, int value, const QString& tip) {
  auto* const field = new QSpinBox;
  field->setObjectName(name);
  field->setRange(low, high);
  field->setValue(value);
  field->setToolTip(tip);
  field->setFocusPolicy(Qt::StrongFocus);
  return field;
}

QComboBox* list_field(const QString& name, const QStringList& choices, const QString& tip) {
  auto* const field = new QComboBox;
  field->setObjectName(name);
  field->addItems(choices);
  field->setToolTip(tip);
  field->setFocusPolicy(Qt::StrongFocus);
  return field;
}

QHBoxLayout* side_by_side(std::initializer_list<QWidget*> widgets) {
  auto* const row = new QHBoxLayout;
  for (QWidget* const widget : widgets) {
    widget->setMinimumWidth(60);  // ranges are wide, and would make the panel wide
    row->addWidget(widget, 1);
  }
  return row;
}

/// A terrain step of a layer: noise between two heights, or one height.
void emit_ground(YAML::Emitter& out, const char* layer, double low, double high, double scale) {
  out << YAML::BeginMap << YAML::Key << (high > low ? "noise" : "uniform") << YAML::Value << YAML::Flow
      << YAML::BeginMap << YAML::Key << "layer" << YAML::Value << layer;
  if (high > low)
    out << YAML::Key << "low" << YAML::Value << low << YAML::Key << "high" << YAML::Value << high << YAML::Key
        << "scale" << YAML::Value << scale;
  else
    out << YAML::Key << "value" << YAML::Value << low;
  out << YAML::EndMap << YAML::EndMap;
}

/// What random events need beside their model: by the defaults, those of hops, they flatten all dunes.
void emit_desertscape(YAML::Emitter& out) {
  const auto section = [&out](const char* name, const char* key, const char* value) {
    out << YAML::Key << name << YAML::Value << YAML::Flow << YAML::BeginMap << YAML::Key << key << YAML::Value
        << value << YAML::EndMap;
  };
  section("saltation", "lift", "0.1");
  section("reptation", "slab", "0.01");
  section("avalanching", "scheme", "multilevel");
}

}  // namespace

NewSceneForm::NewSceneForm(NodeLink& link, QWidget* parent) : QGroupBox("New scene", parent), link_(link) {
  error_ = new ErrorLine("new_scene_error");
  auto* const begin = button("begin_scene", "Begin", "Start this scene; it replaces the present terrain");
  auto* const rows = new QVBoxLayout(this);
  rows->addLayout(make_grid());
  rows->addWidget(begin, 0, Qt::AlignLeft);
  rows->addWidget(error_);
  connect(begin, &QPushButton::clicked, this, &NewSceneForm::begin);
}

QLayout* NewSceneForm::make_grid() {
  width_ = whole_field("new_width", 1, 65536, 256, "Cells from west to east");
  height_ = whole_field("new_height", 1, 65536, 256, "Cells from south to north");
  cell_size_ = number_field("new_cell_size", 0.001, 1e4, 1, 3, " m", "Width of a cell");
  boundary_ = list_field("new_boundary", {"periodic", "open"},
                         "periodic: what leaves on one side enters on the other; open: sand leaves");
  sand_ = number_field("new_sand", 0, 1e4, 3, 2, " m", "Mean depth of sand");
  relief_ = number_field("new_relief", 0, 1e4, 1, 2, " m",
                         "Height of hills of sand, at most twice its depth; 0: a plain");
  connect(sand_, qOverload<double>(&QDoubleSpinBox::valueChanged), relief_,
          [this](double depth) { relief_->setMaximum(2 * depth); });
  relief_->setMaximum(2 * sand_->value());
  rock_ = number_field("new_rock", 0, 1e4, 0, 2, " m", "Height of hills of bedrock below; 0: a plain");
  scale_ = number_field("new_scale", 0.01, 1e6, 30, 1, " m", "How far apart hills are");
  seed_ = whole_field("new_seed", 0, 2147483647, 1, "Seed of the hills and of all dice");
  direction_ = number_field("new_direction", -360, 360, 0, 0, " °", "Where the wind blows to, from east");
  speed_ = number_field("new_speed", 0, 100, 7, 1, " m/s", "Speed high above the ground");
  QStringList models;
  for (const char* const name : sand_model_names) models << name;
  model_ = list_field("new_model", models, "What moves the sand (sand.model)");
  auto* const form = new QFormLayout;
  form->addRow("cells", side_by_side({width_, height_}));
  form->addRow("cell, edges", side_by_side({cell_size_, boundary_}));
  form->addRow("sand, hills", side_by_side({sand_, relief_}));
  form->addRow("rock hills", side_by_side({rock_}));
  form->addRow("spacing, seed", side_by_side({scale_, seed_}));
  form->addRow("wind to, at", side_by_side({direction_, speed_}));
  form->addRow("model", side_by_side({model_}));
  return form;
}

std::string NewSceneForm::yaml() const {
  YAML::Emitter out;
  out << YAML::BeginMap << YAML::Key << "seed" << YAML::Value << seed_->value();
  out << YAML::Key << "grid" << YAML::Value << YAML::Flow << YAML::BeginMap << YAML::Key << "width"
      << YAML::Value << width_->value() << YAML::Key << "height" << YAML::Value << height_->value()
      << YAML::Key << "cell_size" << YAML::Value << cell_size_->value() << YAML::Key << "boundary"
      << YAML::Value << boundary_->currentText().toStdString() << YAML::EndMap;
  out << YAML::Key << "terrain" << YAML::Value << YAML::BeginSeq;
  emit_ground(out, "bedrock", 0, rock_->value(), scale_->value());
  const double half = 0.5 * relief_->value();
  emit_ground(out, "sand", sand_->value() - half, sand_->value() + half, scale_->value());
  out << YAML::EndSeq << YAML::Key << "wind" << YAML::Value << YAML::Flow << YAML::BeginMap << YAML::Key
      << "speed" << YAML::Value << speed_->value() << YAML::Key << "direction_deg" << YAML::Value
      << direction_->value() << YAML::EndMap;
  out << YAML::Key << "sand" << YAML::Value << YAML::Flow << YAML::BeginMap << YAML::Key << "model"
      << YAML::Value << model_->currentText().toStdString() << YAML::EndMap;
  if (model_->currentIndex() == static_cast<int>(SandModel::desertscape_2019)) emit_desertscape(out);
  out << YAML::EndMap;
  return out.c_str();
}

void NewSceneForm::begin() {
  NewScenarioRequest request;
  request.yaml = yaml();
  link_.call<NewScenario>(error_, "new_scenario", request);
}

}  // namespace desert_sim
