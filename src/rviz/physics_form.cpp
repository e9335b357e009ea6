#include "src/rviz/physics_form.hpp"

#include <desert_sim/ApplySettings.h>
#include <yaml-cpp/yaml.h>

#include <QCheckBox>
#include <QComboBox>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QLineEdit>
#include <QVBoxLayout>

#include "src/rviz/fields.hpp"

namespace desert_sim {

namespace {

constexpr std::size_t most_found = 60;  // rows of a search: who finds more searches on

}  // namespace

PhysicsForm::PhysicsForm(NodeLink& link, QWidget* parent) : QWidget(parent), link_(link) {
  section_ = new QComboBox;
  section_->setObjectName("physics_section");
  section_->setToolTip("A section of the scenario (config/parameters.md)");
  search_ = new QLineEdit;
  search_->setObjectName("physics_search");
  search_->setPlaceholderText("or search in all");
  search_->setClearButtonEnabled(true);
  ramp_ = number_field("physics_ramp", 0, 1e12, 0, 1, " s",
                       "Simulated time in which numbers reach what is set; 0: at once");
  auto* const reset =
      button("reset_section", "Reset", "Set what is shown back to what the scenario had at its start");
  error_ = new ErrorLine("physics_error");
  rows_ = new QWidget;
  form_ = new QFormLayout(rows_);
  auto* const choice = new QHBoxLayout;
  choice->addWidget(section_, 1);
  choice->addWidget(search_, 1);
  auto* const actions = new QHBoxLayout;
  actions->addWidget(new QLabel("change within"));
  actions->addWidget(ramp_);
  actions->addStretch();
  actions->addWidget(reset);
  auto* const all = new QVBoxLayout(this);
  all->addLayout(choice);
  all->addLayout(actions);
  all->addWidget(error_);
  all->addWidget(rows_);
  all->addStretch();
  connect(section_, qOverload<int>(&QComboBox::currentIndexChanged), this, &PhysicsForm::choose);
  connect(search_, &QLineEdit::textChanged, this, &PhysicsForm::choose);
  connect(reset, &QPushButton::clicked, this, &PhysicsForm::reset_section);
}

void PhysicsForm::describe(const dynamic_reconfigure::ConfigDescription& description) {
  const QString chosen = section_->currentText();
  parameters_ = list_live_parameters(description);
  QStringList sections;
  for (const LiveParameter& parameter : parameters_) sections << QString::fromStdString(parameter.section);
  sections.removeDuplicates();
  const QSignalBlocker quiet(section_);
  section_->clear();
  section_->addItems(sections);
  section_->setCurrentIndex(std::max(0, section_->findText(chosen)));
  values_ = live_values(description.dflt);
  choose();
}

void PhysicsForm::choose() {
  fields_.clear();
  while (form_->rowCount() > 0) form_->removeRow(0);
  const QString wanted = search_->text().trimmed(), section = section_->currentText();
  for (const LiveParameter& parameter : parameters_) {
    const QString path = QString::fromStdString(parameter.path());
    const bool found = wanted.isEmpty() ? QString::fromStdString(parameter.section) == section
                                        : (path + " " + parameter.text).contains(wanted, Qt::CaseInsensitive);
    if (!found || fields_.size() >= most_found) continue;
    auto* const label = new QLabel(wanted.isEmpty() ? QString::fromStdString(parameter.name) : path);
    QWidget* const field = make_field(parameter);
    const QString tip = parameter.tip();
    label->setToolTip(tip);
    field->setToolTip(tip);
    field->setObjectName("physics_" + path);
    auto* const row = new QHBoxLayout;
    row->addWidget(field, 1);
    row->addWidget(new QLabel(parameter.unit));
    form_->addRow(label, row);
    fields_[parameter.path()] = field;
  }
  show_values();
}

QWidget* PhysicsForm::make_field(const LiveParameter& parameter) {
  if (parameter.is_switch) {
    auto* const box = new QCheckBox;
    connect(box, &QCheckBox::clicked, this,
            [this, parameter](bool on) { set(parameter, on ? "true" : "false"); });
    return box;
  }
  if (!parameter.choices.isEmpty()) {
    auto* const list = new QComboBox;
    list->addItems(parameter.choices);
    list->setFocusPolicy(Qt::StrongFocus);
    connect(list, qOverload<int>(&QComboBox::activated), this,
            [this, parameter](int n) { set(parameter, parameter.choices.at(n)); });
    return list;
  }
  auto* const line = new QLineEdit;
  connect(line, &QLineEdit::editingFinished, this, [this, parameter, line] {
    if (line->isModified()) set(parameter, line->text().trimmed());
    line->setModified(false);
  });
  return line;
}

void PhysicsForm::show_parameters(const dynamic_reconfigure::Config& parameters) {
  values_ = live_values(parameters);
  show_values();
}

void PhysicsForm::show_values() {
  for (const auto& [path, field] : fields_) {
    const auto value = values_.find(path);
    if (value == values_.end()) continue;
    if (auto* const box = qobject_cast<QCheckBox*>(field)) box->setChecked(value->second == "true");
    if (auto* const list = qobject_cast<QComboBox*>(field)) list->setCurrentText(value->second);
    if (auto* const line = qobject_cast<QLineEdit*>(field); line && !line->isModified())
      line->setText(value->second);  // else somebody types
  }
}

void PhysicsForm::set(const LiveParameter& parameter, const QString& value) {
  ApplySettingsRequest request;
  request.settings = {parameter.path() + "=" + value.toStdString()};
  request.ramp = ramp_->value();
  link_.call<ApplySettings>(error_, "apply_settings", request);  // what is refused stays, to be corrected
}

void PhysicsForm::reset_section() {
  GetScenarioRequest request;
  request.start = 1;
  link_.call<GetScenario>(error_, "get_scenario", request,
                          [this](const GetScenarioResponse& start) { reset_to(start); });
}

void PhysicsForm::reset_to(const GetScenarioResponse& start) {
  ApplySettingsRequest request;
  request.ramp = ramp_->value();
  std::map<std::string, QString> values;
  const YAML::Node scenario = YAML::Load(start.yaml);
  for (const LiveParameter& parameter : parameters_) {
    const YAML::Node value = scenario[parameter.section][parameter.name];
    if (fields_.count(parameter.path()) == 0 || !value) continue;
    YAML::Emitter text;
    text << YAML::Flow << value;
    request.settings.push_back(parameter.path() + "=" + text.c_str());
    values[parameter.path()] = text.c_str();
  }
  if (request.settings.empty()) return;
  // Also where the node had the value of the start all the time, and something that it refused is shown.
  link_.call<ApplySettings>(error_, "apply_settings", request, [this, values](const ApplySettingsResponse&) {
    for (const auto& [path, value] : values) values_[path] = value;
    show_values();
  });
}

}  // namespace desert_sim
