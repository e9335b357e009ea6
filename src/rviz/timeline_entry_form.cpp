#include "src/rviz/timeline_entry_form.hpp"

#include <yaml-cpp/yaml.h>

#include <QCompleter>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPlainTextEdit>
#include <QVBoxLayout>
#include <algorithm>

#include "src/core/error.hpp"
#include "src/rviz/command_keys.hpp"
#include "src/rviz/fields.hpp"
#include "src/rviz/timeline_entries.hpp"
#include "src/scenario/yaml_flow_text.hpp"

namespace desert_sim {

namespace {

constexpr int lines_of_keys = 4;
constexpr std::size_t longest_shown = 400;  // a raster would make the field slow

/// One value that somebody has typed, as YAML in flow style. Throws ConfigError if it is none.
YAML::Node typed_node(const std::string& text, const std::string& what) {
  const char* const last = "end";  // is reached only if the text closes no bracket that it has not opened
  try {
    const YAML::Node list = YAML::Load("[" + text + ", " + last + "]");
    if (list.size() == 2 && list[1].IsScalar() && list[1].Scalar() == last) return list[0];
  } catch (const YAML::Exception& e) {
    throw ConfigError(what + ": '" + text + "' is no YAML: " + e.msg);
  }
  throw ConfigError(what + ": '" + text + "' is not one value");
}

bool is_time_key(const std::string& key) { return key == "time" || key == "every" || key == "until"; }

}  // namespace

TimelineEntryForm::TimelineEntryForm(QWidget* parent) : QWidget(parent) {
  kind_ = new ChoiceField("entry_kind");
  kind_->addItem("parameters");
  kind_->addItems(timed_commands());
  kind_->setToolTip("What happens: parameters change, or a command is given");
  auto* const what = new QHBoxLayout;
  what->addWidget(new QLabel("what"));
  what->addWidget(kind_, 1);
  set_ = make_parameters();
  command_ = make_command();
  auto* const all = new QVBoxLayout(this);
  all->setContentsMargins(0, 0, 0, 0);
  all->addWidget(make_times());
  all->addLayout(what);
  all->addWidget(set_);
  all->addWidget(command_);
  connect(kind_, qOverload<int>(&QComboBox::currentIndexChanged), this, &TimelineEntryForm::show_kind);
  show_kind();
}

QLineEdit* TimelineEntryForm::time_field(const QString& name, const QString& empty, const QString& tip) {
  auto* const field = new QLineEdit;
  field->setObjectName(name);
  field->setPlaceholderText(empty);
  field->setToolTip(tip + ", in seconds or with a unit (10 min)");
  field->setMinimumWidth(60);
  return field;
}

QWidget* TimelineEntryForm::make_times() {
  from_ = new ChoiceField("entry_from");
  from_->addItems({"in [s]", "at [s]"});
  from_->setMinimumContentsLength(5);
  from_->setToolTip("From the present simulated time on, or from the start of the scenario");
  time_ = time_field("entry_time", "", "When it happens");
  every_ = time_field("entry_every", "once", "It happens again each time after so long");
  until_ = time_field("entry_until", "for ever", "Simulated time of the last repetition");
  ramp_ = time_field("entry_ramp", "at once", "Time in which numbers reach their values");
  ramp_label_ = new QLabel("within [s]");
  auto* const times = new QWidget;
  auto* const grid = new QGridLayout(times);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->addWidget(from_, 0, 0);
  grid->addWidget(time_, 0, 1);
  grid->addWidget(ramp_label_, 0, 2);
  grid->addWidget(ramp_, 0, 3);
  grid->addWidget(new QLabel("every [s]"), 1, 0);
  grid->addWidget(every_, 1, 1);
  grid->addWidget(new QLabel("until [s]"), 1, 2);
  grid->addWidget(until_, 1, 3);
  return times;
}

QWidget* TimelineEntryForm::make_parameters() {
  auto* const more = button("entry_more", "Another parameter", "A further row");
  rows_ = new QGridLayout;
  rows_->setColumnStretch(0, 3);
  rows_->setColumnStretch(1, 2);
  auto* const set = new QWidget;
  auto* const all = new QVBoxLayout(set);
  all->setContentsMargins(0, 0, 0, 0);
  all->addLayout(rows_);
  all->addWidget(more, 0, Qt::AlignLeft);
  connect(more, &QPushButton::clicked, this, [this] { add_parameter(); });
  add_parameter();
  return set;
}

QWidget* TimelineEntryForm::make_command() {
  keys_ = new QPlainTextEdit;
  keys_->setObjectName("entry_keys");
  keys_->setTabChangesFocus(true);
  keys_->setFixedHeight(lines_of_keys * keys_->fontMetrics().lineSpacing() + 12);
  keys_label_ = new QLabel;
  kept_label_ = new QLabel;
  for (QLabel* const label : {keys_label_, kept_label_}) {
    label->setWordWrap(true);
    label->setTextFormat(Qt::PlainText);
    label->setStyleSheet("color: #757575");
  }
  kept_label_->hide();
  auto* const command = new QWidget;
  auto* const all = new QVBoxLayout(command);
  all->setContentsMargins(0, 0, 0, 0);
  all->addWidget(keys_);
  all->addWidget(kept_label_);
  all->addWidget(keys_label_);
  return command;
}

void TimelineEntryForm::add_parameter(const QString& path, const QString& value) {
  const int row = static_cast<int>(fields_.size());
  ParameterField field{new ChoiceField(QStringLiteral("entry_path_%1").arg(row)), new QLineEdit};
  field.path->setEditable(true);
  field.path->setInsertPolicy(QComboBox::NoInsert);
  field.path->completer()->setFilterMode(Qt::MatchContains);
  field.path->completer()->setCompletionMode(QCompleter::PopupCompletion);
  for (const LiveParameter& parameter : parameters_)
    field.path->addItem(QString::fromStdString(parameter.path()));
  field.path->setEditText(path);
  field.path->lineEdit()->setPlaceholderText("section.parameter");
  field.value->setObjectName(QStringLiteral("entry_value_%1").arg(row));
  field.value->setText(value);
  rows_->addWidget(field.path, row, 0);
  rows_->addWidget(field.value, row, 1);
  fields_.push_back(field);
  connect(field.path, &QComboBox::editTextChanged, this, [this, field] { explain(field); });
  explain(field);
}

void TimelineEntryForm::explain(const ParameterField& field) const {
  const std::string path = field.path->currentText().trimmed().toStdString();
  const auto found = std::find_if(parameters_.begin(), parameters_.end(),
                                  [&](const LiveParameter& parameter) { return parameter.path() == path; });
  const bool known = found != parameters_.end();
  field.value->setPlaceholderText(!known                      ? QStringLiteral("value")
                                  : !found->choices.isEmpty() ? found->choices.join(", ")
                                  : found->is_switch          ? QStringLiteral("true, false")
                                                              : found->range + " " + found->unit);
  for (QWidget* const widget : {static_cast<QWidget*>(field.path), static_cast<QWidget*>(field.value)})
    widget->setToolTip(known ? found->tip() : QString());
}

void TimelineEntryForm::describe(const dynamic_reconfigure::ConfigDescription& description) {
  parameters_ = list_live_parameters(description);
  QStringList paths;
  for (const LiveParameter& parameter : parameters_) paths << QString::fromStdString(parameter.path());
  for (const ParameterField& field : fields_) {
    const QString typed = field.path->currentText();
    field.path->clear();
    field.path->addItems(paths);
    field.path->setEditText(typed);
    explain(field);
  }
}

void TimelineEntryForm::suggest(double ahead) {
  if (time_->text().isEmpty() && !time_->isModified())
    time_->setText(QString::fromStdString(time_text(ahead)));
}

void TimelineEntryForm::show_kind() {
  const bool is_command = kind_->currentIndex() > 0;
  set_->setVisible(!is_command);
  command_->setVisible(is_command);
  ramp_->setVisible(!is_command);
  ramp_label_->setVisible(!is_command);
  if (!is_command) return;
  const CommandKeys keys = keys_of(kind_->currentText().toStdString());
  keys_label_->setText("keys: " + keys.names);
  for (QWidget* const widget : {static_cast<QWidget*>(keys_label_), static_cast<QWidget*>(keys_)})
    widget->setToolTip(keys.tip);
}

// ---- An entry into the fields, and back.

void TimelineEntryForm::show_time(QLineEdit* field, const std::string& given) {
  double seconds = 0;
  given_[field] = given;
  field->setText(QString::fromStdString(read_entry_time(given, seconds) ? time_text(seconds) : given));
}

std::string TimelineEntryForm::time_said(QLineEdit* field) const {
  const auto given = given_.find(field);
  return field->isModified() || given == given_.end() ? field->text().trimmed().toStdString() : given->second;
}

void TimelineEntryForm::show_entry(const std::string& text) {
  const YAML::Node entry = YAML::Load(text);
  const auto scalar = [&](const char* key) {
    return entry[key] && entry[key].IsScalar() ? entry[key].Scalar() : std::string();
  };
  from_->setCurrentIndex(1);
  show_time(time_, scalar("time"));
  show_time(every_, scalar("every"));
  show_time(until_, scalar("until"));
  const std::string command = scalar("command");
  kept_.clear();
  QStringList keys, kept;
  if (command.empty()) {
    const std::string ramp = scalar("ramp");
    show_time(ramp_, ramp == "0" ? "" : ramp);
    for (const ParameterField& field : fields_) delete field.path, delete field.value;
    fields_.clear();
    for (const auto& setting : entry["set"])
      add_parameter(QString::fromStdString(setting.first.Scalar()),
                    QString::fromStdString(yaml::flow_text(setting.second)));
  } else {
    for (const auto& part : entry) {
      const std::string key = part.first.Scalar(), value = yaml::flow_text(part.second);
      if (is_time_key(key) || key == "command") continue;
      if (value.size() > longest_shown) {
        kept_[key] = value;
        kept << QString::fromStdString(key);
      } else {
        keys << QString::fromStdString(key + ": " + value);
      }
    }
    keys_->setPlainText(keys.join(", "));
  }
  kept_label_->setText("too long to be shown, and kept: " + kept.join(", "));
  kept_label_->setVisible(!kept.isEmpty());
  kind_->setCurrentIndex(command.empty() ? 0 : kind_->findText(QString::fromStdString(command)));
}

std::string TimelineEntryForm::entry(double now) const {
  YAML::Emitter out;
  out << YAML::Flow << YAML::BeginMap;
  const auto emit = [&out](const std::string& key, const YAML::Node& value) {
    out << YAML::Key << key << YAML::Value << YAML::Flow << value;
  };
  const auto emit_time = [&](const char* key, const std::string& text) {
    if (!text.empty()) out << YAML::Key << key << YAML::Value << text;
  };
  std::string time = time_said(time_);
  double ahead = 0;
  if (from_->currentIndex() == 0 && read_entry_time(time, ahead)) time = time_text(now + ahead);
  emit_time("time", time);
  emit_time("every", time_said(every_));
  emit_time("until", time_said(until_));
  if (kind_->currentIndex() == 0) {
    emit_time("ramp", time_said(ramp_));
    out << YAML::Key << "set" << YAML::Value << YAML::BeginMap;
    for (const ParameterField& field : fields_) {
      const std::string path = field.path->currentText().trimmed().toStdString();
      if (!path.empty()) emit(path, typed_node(field.value->text().trimmed().toStdString(), path));
    }
    out << YAML::EndMap;
  } else {
    out << YAML::Key << "command" << YAML::Value << kind_->currentText().toStdString();
    const std::string text = keys_->toPlainText().simplified().toStdString();
    for (const auto& part : typed_node("{" + text + "}", "keys")) {
      if (!part.first.IsScalar()) throw ConfigError("keys: '" + text + "' has a key that is no word");
      const std::string key = part.first.Scalar();
      if (is_time_key(key)) throw ConfigError(key + ": has a field of its own above");
      emit(key, part.second);
    }
    for (const auto& [key, value] : kept_) emit(key, YAML::Load(value));
  }
  out << YAML::EndMap;
  std::string text = out.c_str();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

}  // namespace desert_sim
