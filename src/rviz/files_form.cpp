#include "src/rviz/files_form.hpp"

#include <desert_sim/LoadCheckpoint.h>
#include <desert_sim/LoadScenario.h>
#include <desert_sim/LoadTerrain.h>
#include <desert_sim/SaveCheckpoint.h>
#include <desert_sim/SaveScenario.h>
#include <desert_sim/SaveTerrain.h>

#include <QComboBox>
#include <QGroupBox>
#include <QHBoxLayout>
#include <QLineEdit>
#include <QVBoxLayout>

#include "src/rviz/export_form.hpp"
#include "src/rviz/fields.hpp"
#include "src/rviz/new_scene_form.hpp"

namespace desert_sim {

namespace {

/// A list of names to choose from, into which others can be written.
QComboBox* name_field(const QString& name, const QString& tip) {
  auto* const field = new QComboBox;
  field->setObjectName(name);
  field->setToolTip(tip);
  field->setEditable(true);
  field->lineEdit()->setPlaceholderText("choose or write a name");
  field->setInsertPolicy(QComboBox::NoInsert);
  field->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  field->setMinimumContentsLength(9);
  return field;
}

std::string text(const QComboBox* field) { return field->currentText().trimmed().toStdString(); }

/// Other names to choose from; what is written stays.
void set_names(QComboBox* field, const QStringList& names, const QStringList& more = {}) {
  const QString written = field->currentText();
  field->clear();
  field->addItems(names);
  if (!names.isEmpty() && !more.isEmpty()) field->insertSeparator(names.size());
  field->addItems(more);
  field->setCurrentIndex(field->findText(written));
  field->setEditText(written);
}

/// A group of a row of widgets above an error line.
QGroupBox* group_of(const QString& title, std::initializer_list<QWidget*> row, ErrorLine* error) {
  auto* const group = new QGroupBox(title);
  auto* const layout = new QHBoxLayout;
  for (QWidget* const widget : row) layout->addWidget(widget, qobject_cast<QComboBox*>(widget) ? 1 : 0);
  auto* const rows = new QVBoxLayout(group);
  rows->addLayout(layout);
  rows->addWidget(error);
  return group;
}

}  // namespace

FilesForm::FilesForm(NodeLink& link, QWidget* parent) : QWidget(parent), link_(link) {
  auto* const all = new QVBoxLayout(this);
  all->addWidget(make_scenario());
  all->addWidget(make_terrain());
  all->addWidget(make_checkpoint());
  all->addWidget(new ExportForm(link));
  all->addWidget(new NewSceneForm(link));
  auto* const again =
      button("refresh", "Look for files again", "List what config/scenarios and ~data_dir have now");
  all->addWidget(again, 0, Qt::AlignLeft);
  all->addStretch();
  connect(again, &QPushButton::clicked, this, &FilesForm::refresh);
}

QGroupBox* FilesForm::make_scenario() {
  scenario_ = name_field(
      "scenario", "An installed scenario, or a YAML file or saved scenario below the node's ~data_dir");
  settings_ = new QLineEdit;
  settings_->setObjectName("scenario_settings");
  settings_->setPlaceholderText("settings, such as grid.width=512; seed=7");
  settings_->setToolTip("Keys of the scenario that are otherwise than in its file, parted by ;");
  scenario_error_ = new ErrorLine("scenario_error");
  auto* const load = button("load_scenario", "Load", "Start this scenario; it replaces the present terrain");
  auto* const save = button("save_scenario", "Save",
                            "Save the scenario as it is now, with all of its state, under this name");
  connect(load, &QPushButton::clicked, this, &FilesForm::load_scenario);
  connect(save, &QPushButton::clicked, this, &FilesForm::save_scenario);
  QGroupBox* const group = group_of("Scenario", {scenario_, save, load}, scenario_error_);
  qobject_cast<QVBoxLayout*>(group->layout())->insertWidget(1, settings_);
  return group;
}

QGroupBox* FilesForm::make_terrain() {
  terrain_ = name_field("terrain", "A folder below the node's ~data_dir; to load, also a bag with a GridMap");
  terrain_error_ = new ErrorLine("terrain_error");
  format_ = new QComboBox;
  format_->setObjectName("terrain_format");
  for (const std::string& format :
       {SaveTerrainRequest::GEOTIFF, SaveTerrainRequest::PNG16, SaveTerrainRequest::ROSBAG})
    format_->addItem(QString::fromStdString(format));
  format_->setToolTip("What it is saved as");
  auto* const save = button("save_terrain", "Save", "Save the present terrain under this name");
  auto* const load = button("load_terrain", "Load", "Replace the terrain; physics and wind stay");
  connect(save, &QPushButton::clicked, this, &FilesForm::save_terrain);
  connect(load, &QPushButton::clicked, this, &FilesForm::load_terrain);
  QGroupBox* const group = group_of("Terrain", {terrain_, save, load}, terrain_error_);
  auto* const row = new QHBoxLayout;
  row->addWidget(new QLabel("saved as"));
  row->addWidget(format_);
  row->addStretch();
  qobject_cast<QVBoxLayout*>(group->layout())->insertLayout(1, row);
  return group;
}

QGroupBox* FilesForm::make_checkpoint() {
  checkpoint_ =
      name_field("checkpoint", "A file below the node's ~data_dir; those that end in .ckpt are listed");
  checkpoint_error_ = new ErrorLine("checkpoint_error");
  auto* const save = button("save_checkpoint", "Save", "Save every bit of the state under this name");
  auto* const load = button("load_checkpoint", "Load", "Continue from this checkpoint");
  connect(save, &QPushButton::clicked, this, &FilesForm::save_checkpoint);
  connect(load, &QPushButton::clicked, this, &FilesForm::load_checkpoint);
  return group_of("Checkpoint", {checkpoint_, save, load}, checkpoint_error_);
}

void FilesForm::refresh() {
  link_.caller().work([this, node = link_.node()]() -> std::function<void()> {
    const SceneLists lists = list_scenes(node);
    return [this, lists] { show(lists); };
  });
}

void FilesForm::show(const SceneLists& lists) {
  set_names(scenario_, lists.installed, lists.scenarios);
  set_names(terrain_, lists.terrains);
  set_names(checkpoint_, lists.checkpoints);
}

void FilesForm::load_scenario() {
  LoadScenarioRequest request;
  request.name = text(scenario_);
  for (const QString& setting : settings_->text().split(';'))
    if (!setting.trimmed().isEmpty()) request.settings.push_back(setting.trimmed().toStdString());
  link_.call<LoadScenario>(scenario_error_, "load_scenario", request);
}

void FilesForm::save_scenario() {
  SaveScenarioRequest request;
  request.name = text(scenario_);
  link_.call<SaveScenario>(scenario_error_, "save_scenario", request,
                           [this](const SaveScenarioResponse& answer) {
                             scenario_error_->show_note("saved: " + answer.path);
                             refresh();
                           });
}

void FilesForm::save_terrain() {
  SaveTerrainRequest request;
  request.name = text(terrain_);
  request.format = format_->currentText().toStdString();
  link_.call<SaveTerrain>(terrain_error_, "save_terrain", request, [this](const SaveTerrainResponse& answer) {
    terrain_error_->show_note("saved: " + answer.path);
    refresh();
  });
}

void FilesForm::load_terrain() {
  LoadTerrainRequest request;
  request.name = text(terrain_);
  link_.call<LoadTerrain>(terrain_error_, "load_terrain", request);
}

void FilesForm::save_checkpoint() {
  SaveCheckpointRequest request;
  request.name = text(checkpoint_);
  link_.call<SaveCheckpoint>(checkpoint_error_, "save_checkpoint", request,
                             [this](const SaveCheckpointResponse& answer) {
                               checkpoint_error_->show_note("saved: " + answer.path);
                               refresh();
                             });
}

void FilesForm::load_checkpoint() {
  LoadCheckpointRequest request;
  request.name = text(checkpoint_);
  link_.call<LoadCheckpoint>(checkpoint_error_, "load_checkpoint", request);
}

}  // namespace desert_sim
