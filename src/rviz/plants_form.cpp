#include "src/rviz/plants_form.hpp"

#include <desert_sim/ApplySettings.h>
#include <yaml-cpp/yaml.h>

#include <QColor>
#include <QComboBox>
#include <QFormLayout>
#include <QGroupBox>
#include <QHBoxLayout>
#include <QLineEdit>
#include <QVBoxLayout>

#include "src/core/shortest_decimal.hpp"
#include "src/rviz/fields.hpp"
#include "src/rviz/scene_lists.hpp"
#include "src/scenario/species.hpp"

namespace desert_sim {

namespace {

/// Calls visit(row) for each number of a species.
template <class Visit>
void for_each_trait(const Visit& visit) {
  SpeciesTraits traits;
  SpeciesAppearance appearance;
  for_each_parameter(traits, [&](const ParameterRow& row, const auto&) { visit(row); });
  for_each_parameter(appearance, [&](const ParameterRow& row, const auto&) { visit(row); });
}

std::string quoted(const std::string& text) {
  YAML::Emitter out;
  out << YAML::DoubleQuoted << text;
  return out.c_str();
}

}  // namespace

PlantsForm::PlantsForm(NodeLink& link, QWidget* parent) : QWidget(parent), link_(link) {
  live_ =
      button("let_live", "Let plants live", "Plants grow, spread and die from now on (vegetation.enabled)");
  list_error_ = new ErrorLine("species_error");
  error_ = new ErrorLine("plants_error");
  auto* const all = new QVBoxLayout(this);
  all->addWidget(live_);
  all->addWidget(list_error_);
  all->addWidget(error_);
  all->addWidget(make_addition());
  all->addWidget(make_traits());
  all->addStretch();
  connect(live_, &QPushButton::clicked, this, &PlantsForm::let_live);
}

QWidget* PlantsForm::make_addition() {
  preset_ = new QComboBox;
  preset_->setObjectName("species_preset");
  preset_->setToolTip("A species of config/species, whose traits it starts with");
  preset_->addItems(list_species());
  new_name_ = new QLineEdit;
  new_name_->setObjectName("species_name");
  new_name_->setPlaceholderText("name, if another");
  auto* const add = button("add_species", "Add", "A further species, which competes with the others by 1");
  auto* const group = new QGroupBox("Another species");
  auto* const row = new QHBoxLayout(group);
  row->addWidget(preset_, 1);
  row->addWidget(new_name_, 1);
  row->addWidget(add);
  connect(add, &QPushButton::clicked, this, &PlantsForm::add_species);
  return group;
}

QWidget* PlantsForm::make_traits() {
  name_ = new QComboBox;
  name_->setObjectName("species");
  colour_ = new QLabel;
  colour_->setObjectName("species_colour");
  colour_->setFixedSize(28, 18);
  auto* const apply = button("set_traits", "Set", "Let the species have these traits from now on");
  auto* const again = button("refresh_species", "Look again", "Ask the node for its species");
  auto* const head = new QHBoxLayout;
  head->addWidget(name_, 1);
  head->addWidget(colour_);
  head->addWidget(apply);
  head->addWidget(again);
  auto* const form = new QFormLayout;
  for_each_trait([&](const ParameterRow& row) {
    auto* const field = new QLineEdit;
    field->setObjectName(QStringLiteral("trait_") + row.name);
    const QString unit = std::string(row.unit) == "1" ? QString() : QString(row.unit);
    field->setToolTip(
        QStringLiteral("%1\nallowed: %2 … %3 %4").arg(row.doc).arg(row.lowest).arg(row.highest).arg(unit));
    auto* const line = new QHBoxLayout;
    line->addWidget(field, 1);
    line->addWidget(new QLabel(unit));
    form->addRow(row.name, line);
    fields_[row.name] = field;
  });
  auto* const group = new QGroupBox("Species");
  auto* const rows = new QVBoxLayout(group);
  rows->addLayout(head);
  rows->addLayout(form);
  connect(name_, qOverload<int>(&QComboBox::currentIndexChanged), this, [this] { show_traits(false); });
  connect(apply, &QPushButton::clicked, this, &PlantsForm::apply_traits);
  connect(again, &QPushButton::clicked, this, &PlantsForm::refresh);
  connect(fields_.at("hue"), &QLineEdit::textChanged, this, [this](const QString& hue) {
    const double angle = hue.toDouble();
    const QColor colour = QColor::fromHsvF(angle >= 0 && angle < 360 ? angle / 360 : 0, 0.75, 0.6);
    colour_->setStyleSheet("background: " + colour.name());
  });
  return group;
}

void PlantsForm::refresh() {
  link_.call<GetScenario>(list_error_, "get_scenario", {},
                          [this](const GetScenarioResponse& answer) { show(answer); });
}

void PlantsForm::show(const GetScenarioResponse& answer) {
  const YAML::Node scenario = YAML::Load(answer.yaml);
  const int chosen = name_->currentIndex();
  const QSignalBlocker quiet(name_);
  species_.clear();
  name_->clear();
  for (const YAML::Node& species : scenario["species"]) {
    Traits traits;
    for (const auto& [trait, field] : fields_)
      if (species[trait])
        traits[trait] = QString::number(shortest_decimal(species[trait].as<float>()), 'g', 9);
    name_->addItem(QString::fromStdString(species["name"].as<std::string>()));
    species_.push_back(std::move(traits));
  }
  live_->setVisible(!scenario["vegetation"]["enabled"].as<bool>());
  if (name_->count() > 0) name_->setCurrentIndex(std::max(0, std::min(chosen, name_->count() - 1)));
  show_traits(name_->currentIndex() == chosen);
}

void PlantsForm::show_traits(bool keep_typed) {
  const int n = name_->currentIndex();
  for (const auto& [trait, field] : fields_) {
    field->setEnabled(n >= 0);
    if (keep_typed && field->isModified()) continue;
    field->setText(n >= 0 ? species_[static_cast<std::size_t>(n)].at(trait) : QString());
  }
}

void PlantsForm::apply_traits() {
  const int n = name_->currentIndex();
  std::vector<std::string> settings;
  for (const auto& [trait, field] : fields_)
    if (n >= 0 && field->text().trimmed() != species_[static_cast<std::size_t>(n)].at(trait)) {
      settings.push_back("species." + std::to_string(n) + "." + trait + "=" +
                         field->text().trimmed().toStdString());
      field->setModified(false);
    }
  if (settings.empty())
    error_->show_note("nothing is otherwise than the node has it");
  else
    apply(settings);
}

void PlantsForm::add_species() {
  const std::string name = new_name_->text().trimmed().toStdString(),
                    preset = preset_->currentText().toStdString();
  apply({"species." + std::to_string(name_->count()) + "={preset: " + quoted(preset) +
         (name.empty() ? "" : ", name: " + quoted(name)) + "}"});
}

void PlantsForm::let_live() { apply({"vegetation.enabled=true"}); }

void PlantsForm::apply(const std::vector<std::string>& settings) {
  ApplySettingsRequest request;
  request.settings = settings;
  link_.call<ApplySettings>(error_, "apply_settings", request,
                            [this](const ApplySettingsResponse&) { refresh(); });
}

}  // namespace desert_sim
