#include "src/rviz/wind_features_form.hpp"

#include <QGridLayout>
#include <QGroupBox>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QLineEdit>
#include <QPushButton>
#include <QSpinBox>
#include <QTableWidget>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>
#include <limits>

#include "src/rviz/fields.hpp"

namespace desert_sim {

namespace {

constexpr int most_rows_seen = 6;

bool all_have(const WindFeatureItem&) { return true; }
bool has_centre(const WindFeatureItem& f) { return f.path.empty(); }

/// Where its centre is at first.
geometry_msgs::Point start_of(const WindFeatureItem& f) {
  geometry_msgs::Point start = f.center;
  if (!f.path.empty()) start.x = f.path.front().x, start.y = f.path.front().y;
  return start;
}

/// What a field says: the number that it was given, which may have more digits, unless somebody has changed
/// it.
double value_of(const QDoubleSpinBox* field, double given) {
  const double half_a_digit = 0.5 * std::pow(10, -field->decimals());
  return std::abs(field->value() - given) <= 1.001 * half_a_digit ? given : field->value();
}

}  // namespace

WindFeaturesForm::WindFeaturesForm(NodeLink& link, QWidget* parent) : QWidget(parent), link_(link) {
  none_ = new QLabel("None. The tool WindTool of rviz places them.");
  none_->setWordWrap(true);
  make_table();
  fields_ = make_fields();
  delete_ = button("delete_feature", "Delete", "Removes the chosen feature");
  delete_all_ =
      button("delete_all_features", "Delete all", "Removes all of them, those of the scenario, too");
  error_ = new ErrorLine("wind_features_error");
  auto* const buttons = new QHBoxLayout;
  buttons->addWidget(delete_);
  buttons->addWidget(delete_all_);
  buttons->addStretch();
  auto* const group = new QGroupBox("Local features: vortices, jets, turbulence, sinks");
  auto* const rows = new QVBoxLayout(group);
  rows->addWidget(none_);
  rows->addWidget(table_);
  rows->addLayout(buttons);
  rows->addWidget(fields_);
  rows->addWidget(error_);
  auto* const all = new QVBoxLayout(this);
  all->setContentsMargins(0, 0, 0, 0);
  all->addWidget(group);

  connect(table_, &QTableWidget::itemSelectionChanged, this, &WindFeaturesForm::show_chosen);
  connect(delete_, &QPushButton::clicked, this, [this] {
    if (chosen()) call(wind_removal(chosen()->id));
  });
  connect(delete_all_, &QPushButton::clicked, this, [this] {
    EditWind::Request request;
    request.operation = EditWind::Request::CLEAR;
    call(request);
  });
  connect(&link_.watch(), &NodeWatch::wind_features_came, this,
          [this](const WindFeatureListConstPtr& list) { show_features(list->features); });
  connect(&link_.watch(), &NodeWatch::presence_changed, this, [this] {
    if (link_.watch().presence() == NodeWatch::Presence::searching) show_features({});  // of another node
  });
  fill_table();
}

void WindFeaturesForm::make_table() {
  const QStringList titles{"id", "kind", "x [m]", "y [m]", "m/s", "R [m]"};
  table_ = new QTableWidget(0, titles.size());
  table_->setObjectName("wind_features_table");
  table_->setHorizontalHeaderLabels(titles);
  table_->horizontalHeader()->setSectionResizeMode(QHeaderView::Stretch);
  for (const int column : {0, 1})
    table_->horizontalHeader()->setSectionResizeMode(column, QHeaderView::ResizeToContents);
  table_->horizontalHeader()->setHighlightSections(false);
  table_->verticalHeader()->hide();
  table_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  table_->setEditTriggers(QAbstractItemView::NoEditTriggers);
  table_->setSelectionBehavior(QAbstractItemView::SelectRows);
  table_->setSelectionMode(QAbstractItemView::SingleSelection);
}

QWidget* WindFeaturesForm::make_fields() {
  auto* const fields = new QWidget;
  auto* const grid = new QGridLayout(fields);
  grid->setContentsMargins(0, 0, 0, 0);
  constexpr int seed_row = 4, path_row = 7, last_row = 8;
  const auto add = [&](const char* name, const char* label, double low, double high, const char* unit,
                       const char* tip, double& (*of)(WindFeatureItem&),
                       bool (*has)(const WindFeatureItem&)) {
    QDoubleSpinBox* const field = number_field(name, low, high, 0, 2, unit, tip);
    auto* const text = new QLabel(label);
    const int n = static_cast<int>(numbers_.size()), row = n / 2 + (n / 2 >= seed_row ? 1 : 0);
    grid->addWidget(text, row, n % 2 * 2);
    grid->addWidget(field, row, n % 2 * 2 + 1);
    numbers_.push_back({text, field, of, has});
  };
  using F = WindFeatureItem;
  const char* const frame = "Centre, in the frame of the terrain";
  add(
      "feature_x", "x", -1e9, 1e9, " m", frame, [](F& f) -> double& { return f.center.x; }, has_centre);
  add(
      "feature_y", "y", -1e9, 1e9, " m", frame, [](F& f) -> double& { return f.center.y; }, has_centre);
  add(
      "feature_speed", "speed", -100, 100, " m/s",
      "Largest speed that it adds; below 0 a vortex turns clockwise, and a jet blows the other way",
      [](F& f) -> double& { return f.speed; }, all_have);
  add(
      "feature_radius", "radius", 0.1, 1e5, " m", "Of a jet half its width",
      [](F& f) -> double& { return f.radius; }, all_have);
  add(
      "feature_direction", "to", -360, 360, " °", "Where it blows to, counter-clockwise from east",
      [](F& f) -> double& { return f.direction_deg; }, has_direction);
  add(
      "feature_length", "½ length", 0.1, 1e5, " m", "Half the length of the jet",
      [](F& f) -> double& { return f.length; }, has_direction);
  add(
      "feature_scale", "eddy size", 0.1, 1e5, " m", "Size of the eddies",
      [](F& f) -> double& { return f.scale; }, has_eddies);
  add(
      "feature_life_time", "life time", 0.01, 1e6, " s", "Simulated time in which the eddies change",
      [](F& f) -> double& { return f.life_time; }, has_eddies);
  add(
      "feature_begin", "begin", 0, 1e12, " s", "Simulated time from which it is there",
      [](F& f) -> double& { return f.begin; }, all_have);
  add(
      "feature_end", "end", 0, 1e12, " s", "Simulated time from which it is gone; 0: never",
      [](F& f) -> double& { return f.end; }, all_have);
  add(
      "feature_velocity_x", "to east", -100, 100, " m/s", "How fast its centre moves, from x, y at `begin`",
      [](F& f) -> double& { return f.velocity.x; }, has_centre);
  add(
      "feature_velocity_y", "to north", -100, 100, " m/s", "How fast its centre moves, from x, y at `begin`",
      [](F& f) -> double& { return f.velocity.y; }, has_centre);
  for (const Number& number : numbers_)
    if (number.field->objectName() == "feature_end") number.field->setSpecialValueText("never");
  seed_ = new QSpinBox;
  seed_->setObjectName("feature_seed");
  seed_->setMaximum(std::numeric_limits<int>::max());
  seed_->setMinimumWidth(numbers_.front().field->minimumWidth());
  seed_label_ = new QLabel("seed");
  grid->addWidget(seed_label_, seed_row, 0);
  grid->addWidget(seed_, seed_row, 1);
  path_ = new QLineEdit;
  path_->setObjectName("feature_path");
  path_->setPlaceholderText("t x y; t x y; … [s, m]");
  path_->setToolTip(
      "In the place of x, y and velocity: where the centre is when, and it moves straight in between");
  grid->addWidget(new QLabel("path"), path_row, 0);
  grid->addWidget(path_, path_row, 1, 1, 3);
  auto* const apply_button = button("apply_feature", "Apply", "Gives the chosen feature these numbers");
  grid->addWidget(apply_button, last_row, 0, 1, 4);
  connect(apply_button, &QPushButton::clicked, this, &WindFeaturesForm::apply);
  return fields;
}

void WindFeaturesForm::show_features(const WindFeatures& features) {
  if (features == features_) return;
  features_ = features;
  fill_table();
}

void WindFeaturesForm::fill_table() {
  const int id = shown_ ? shown_->id : 0;
  {
    const QSignalBlocker quiet(table_);
    table_->clearSelection();
    table_->setRowCount(static_cast<int>(features_.size()));
    for (int row = 0; row < table_->rowCount(); ++row) {
      const WindFeatureItem& f = features_[static_cast<std::size_t>(row)];
      const auto metres = [](double value) { return QString::number(value, 'f', 1); };
      const QStringList texts{f.id ? QString::number(f.id) : "–",
                              QString::fromStdString(f.kind),
                              metres(start_of(f).x),
                              metres(start_of(f).y),
                              QString::number(f.speed, 'g', 4),
                              metres(f.radius)};
      for (int column = 0; column < texts.size(); ++column) {
        auto* const item = new QTableWidgetItem(texts[column]);
        if (f.id == 0) {
          item->setFlags(Qt::NoItemFlags);
          item->setToolTip("The scenario gives it no id: it goes only with all others.");
        }
        table_->setItem(row, column, item);
      }
      if (f.id != 0 && f.id == id) table_->selectRow(row);
    }
  }
  table_->resizeRowsToContents();
  int height = table_->horizontalHeader()->sizeHint().height() + 2 * table_->frameWidth() + 2;
  for (int row = 0; row < std::min(table_->rowCount(), most_rows_seen); ++row)
    height += table_->rowHeight(row);
  table_->setFixedHeight(height);
  table_->setVisible(!features_.empty());
  none_->setVisible(features_.empty());
  delete_all_->setEnabled(!features_.empty());
  show_chosen();
}

const WindFeatureItem* WindFeaturesForm::chosen() const {
  const QList<QTableWidgetItem*> selected = table_->selectedItems();
  return selected.empty() ? nullptr : &features_[static_cast<std::size_t>(selected.front()->row())];
}

void WindFeaturesForm::show_chosen() {
  const WindFeatureItem* const feature = chosen();
  fields_->setVisible(feature);
  delete_->setEnabled(feature);
  if (!feature) return shown_.reset();
  if (shown_ && *shown_ == *feature) return;
  shown_ = *feature;
  for (const Number& number : numbers_) {
    number.label->setVisible(number.has(*feature));
    number.field->setVisible(number.has(*feature));
    number.field->setValue(number.of(*shown_));
  }
  seed_label_->setVisible(has_eddies(*feature));
  seed_->setVisible(has_eddies(*feature));
  seed_->setValue(feature->seed);
  path_->setText(QString::fromStdString(path_text(*feature)));
}

void WindFeaturesForm::apply() {
  if (!shown_) return;
  WindFeatureItem changed = *shown_;
  for (const Number& number : numbers_)
    if (number.has(changed)) number.of(changed) = value_of(number.field, number.of(*shown_));
  changed.seed = seed_->value();
  if (const std::string text = path_->text().toStdString(); text != path_text(*shown_)) {
    const auto path = path_of(text);
    if (!path)
      return error_->show_error("path: '" + text +
                                "' is no path (allowed: time, x and y of each point: t x y; t x y)");
    changed.center = start_of(changed);
    changed.path = *path;
  }
  call(wind_request(EditWind::Request::CHANGE, changed));
}

void WindFeaturesForm::call(const EditWind::Request& request) {
  link_.call<EditWind>(error_, "edit_wind", request);
}

}  // namespace desert_sim
