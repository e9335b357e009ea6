#include "src/rviz/timeline_form.hpp"

#include <desert_sim/ApplySettings.h>
#include <desert_sim/GetScenario.h>

#include <QGroupBox>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QTableWidget>
#include <QTimer>
#include <QVBoxLayout>
#include <algorithm>
#include <utility>

#include "src/core/error.hpp"
#include "src/rviz/fields.hpp"
#include "src/rviz/settings_news.hpp"
#include "src/rviz/timeline_entry_form.hpp"

namespace desert_sim {

namespace {

constexpr int most_entries_seen = 8, steps_ahead = 10, width_of_when = 115;

/// Where the entries have this one. Throws ConfigError if they do not.
TimelineEntries::iterator find_entry(TimelineEntries& entries, const std::string& entry) {
  const auto found = std::find(entries.begin(), entries.end(), entry);
  if (found == entries.end())
    throw ConfigError("the node has no such entry any more; the list is shown anew");
  return found;
}

}  // namespace

TimelineForm::TimelineForm(NodeLink& link, QWidget* parent) : QWidget(parent), link_(link) {
  none_ = new QLabel("Nothing. The tool Brush, too, makes entries: set its When.");
  none_->setWordWrap(true);
  make_table();
  list_error_ = new ErrorLine("timeline_error");
  remove_ = button("remove_entry", "Remove", "Removes the chosen entries");
  auto* const again = button("refresh_timeline", "Look again", "Ask the node for its timeline");
  form_ = new TimelineEntryForm;
  auto* const add_button = button("add_entry", "Add", "A further entry, as the fields say");
  change_ = button("change_entry", "Change", "Puts what the fields say in the place of the chosen entry");
  error_ = new ErrorLine("entry_error");
  const auto row_of = [](QPushButton* first, QPushButton* second) {
    auto* const row = new QHBoxLayout;
    row->addWidget(first);
    row->addWidget(second);
    row->addStretch();
    return row;
  };
  auto* const list = new QGroupBox("What happens when (run.timeline)");
  list->setSizePolicy(QSizePolicy::Preferred, QSizePolicy::Maximum);
  auto* const list_rows = new QVBoxLayout(list);
  list_rows->addWidget(none_);
  list_rows->addWidget(table_);
  list_rows->addWidget(list_error_);
  list_rows->addLayout(row_of(remove_, again));
  auto* const entry = new QGroupBox("An entry");
  auto* const entry_rows = new QVBoxLayout(entry);
  entry_rows->addWidget(form_);
  entry_rows->addLayout(row_of(add_button, change_));
  entry_rows->addWidget(error_);
  auto* const all = new QVBoxLayout(this);
  all->addWidget(list);
  all->addWidget(entry);
  all->addStretch();

  connect(table_, &QTableWidget::itemSelectionChanged, this, [this] {
    show_choice();
    if (const auto entries = chosen(); entries.size() == 1) form_->show_entry(entries.front());
  });
  connect(again, &QPushButton::clicked, this, [this] { refresh(); });
  connect(add_button, &QPushButton::clicked, this, &TimelineForm::add);
  connect(change_, &QPushButton::clicked, this, &TimelineForm::change);
  connect(remove_, &QPushButton::clicked, this, &TimelineForm::remove);
  connect(&SettingsNews::instance(), &SettingsNews::changed, this, [this](const QString& node) {
    if (node.toStdString() == link_.node()) refresh();
  });
  connect(&link_.watch(), &NodeWatch::presence_changed, this, [this] {
    const NodeWatch::Presence presence = link_.watch().presence();
    if (presence == NodeWatch::Presence::searching) show_entries({}, -1);  // of another node
    if (presence == NodeWatch::Presence::alive) refresh();
  });
  show_entries({}, -1);
}

void TimelineForm::make_table() {
  table_ = new QTableWidget(0, 2);
  table_->setObjectName("timeline_table");
  table_->setHorizontalHeaderLabels({"when", "what"});
  table_->horizontalHeader()->setSectionResizeMode(1, QHeaderView::Stretch);
  table_->horizontalHeader()->resizeSection(0, width_of_when);
  table_->horizontalHeader()->setHighlightSections(false);
  table_->verticalHeader()->hide();
  table_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  table_->setEditTriggers(QAbstractItemView::NoEditTriggers);
  table_->setSelectionBehavior(QAbstractItemView::SelectRows);
  table_->setSelectionMode(QAbstractItemView::ExtendedSelection);
  // Not while it is being laid out, which would not be laid out again.
  connect(table_->horizontalHeader(), &QHeaderView::sectionResized, this,
          [this] { QTimer::singleShot(0, this, &TimelineForm::fit_height); });
}

void TimelineForm::describe(const dynamic_reconfigure::ConfigDescription& description) {
  form_->describe(description);
}

// ---- The list.

void TimelineForm::show_status(const SimulationStatus& status) {
  const bool other =
      status.scenario != scenario_ || status.changes != changes_ || status.step < step_;  // or a reset
  scenario_ = status.scenario;
  changes_ = status.changes;
  step_ = status.step;
  if (std::exchange(now_, status.sim_time) != status.sim_time) show_past();
  form_->suggest(steps_ahead * status.time_step);
  if (other) refresh();
}

void TimelineForm::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  if (stale_) refresh();
}

void TimelineForm::refresh(int choose) {
  stale_ = !isVisible();
  if (stale_ || link_.watch().presence() != NodeWatch::Presence::alive) return;
  // Not by NodeLink::call(), whose note would come and go at each entry that happens.
  link_.caller().call<GetScenario>(
      link_.node() + "/get_scenario", {},
      [this, choose](const CallOutcome& outcome, const GetScenarioResponse& answer) {
        if (!outcome.success) return list_error_->show_error(outcome.message);
        list_error_->show_nothing();
        show_entries(timeline_entries(answer.yaml), choose);
      });
}

void TimelineForm::show_entries(const TimelineEntries& entries, int choose) {
  const std::vector<std::string> kept = chosen();
  {
    const QSignalBlocker quiet(table_);  // what is typed in the fields stays
    const auto mode = table_->selectionMode();
    table_->setSelectionMode(QAbstractItemView::MultiSelection);
    table_->clearSelection();
    table_->setRowCount(static_cast<int>(entries.size()));
    rows_.clear();
    for (int row = 0; row < table_->rowCount(); ++row) {
      const std::string& entry = entries[static_cast<std::size_t>(row)];
      const EntryWords words = words_of(entry);
      rows_.push_back({entry, words.end});
      table_->setItem(row, 0, new QTableWidgetItem(QString::fromStdString(words.when)));
      table_->setItem(row, 1, new QTableWidgetItem(QString::fromStdString(words.what)));
      const bool again = choose == keep_choice && std::count(kept.begin(), kept.end(), entry) > 0;
      if (again || row == choose) table_->selectRow(row);
    }
    table_->setSelectionMode(mode);
  }
  table_->setVisible(!entries.empty());
  none_->setVisible(entries.empty());
  show_past();
  fit_height();
  show_choice();
}

void TimelineForm::show_past() {
  for (int row = 0; row < table_->rowCount(); ++row) {
    const bool past = rows_[static_cast<std::size_t>(row)].end < now_;
    QTableWidgetItem *const when = table_->item(row, 0), *const what = table_->item(row, 1);
    const QString mark = " (past)";
    if (when->text().endsWith(mark) == past) continue;
    when->setText(past ? when->text() + mark : when->text().chopped(mark.size()));
    const auto group = past ? QPalette::Disabled : QPalette::Active;
    for (QTableWidgetItem* const item : {when, what})
      item->setForeground(table_->palette().brush(group, QPalette::Text));
  }
}

void TimelineForm::fit_height() {
  table_->resizeRowsToContents();
  int height = table_->horizontalHeader()->sizeHint().height() + 2 * table_->frameWidth() + 2;
  for (int row = 0; row < std::min(table_->rowCount(), most_entries_seen); ++row)
    height += table_->rowHeight(row);
  table_->setFixedHeight(height);
}

std::vector<std::string> TimelineForm::chosen() const {
  std::vector<std::string> entries;
  for (int row = 0; row < table_->rowCount(); ++row)
    if (table_->item(row, 0)->isSelected()) entries.push_back(rows_[static_cast<std::size_t>(row)].entry);
  return entries;
}

void TimelineForm::show_choice() {
  const std::size_t count = chosen().size();
  remove_->setEnabled(count > 0);
  change_->setEnabled(count == 1);
}

// ---- What is changed.

void TimelineForm::add() {
  edit([this, now = now_](TimelineEntries& entries) {
    return static_cast<int>(insert_entry(entries, form_->entry(now)));
  });
}

void TimelineForm::change() {
  edit([this, now = now_, old = chosen()](TimelineEntries& entries) {
    entries.erase(find_entry(entries, old.at(0)));
    return static_cast<int>(insert_entry(entries, form_->entry(now)));
  });
}

void TimelineForm::remove() {
  edit([old = chosen()](TimelineEntries& entries) {
    for (const std::string& entry : old) entries.erase(find_entry(entries, entry));
    return -1;
  });
}

void TimelineForm::edit(const Edit& edit) {
  link_.call<GetScenario>(error_, "get_scenario", {}, [this, edit](const GetScenarioResponse& answer) {
    TimelineEntries entries = timeline_entries(answer.yaml);
    int choose = -1;
    try {
      choose = edit(entries);
    } catch (const ConfigError& e) {
      error_->show_error(e.what());
      return refresh();
    }
    ApplySettingsRequest request;
    request.settings = {timeline_setting(entries)};
    link_.call<ApplySettings>(error_, "apply_settings", request,
                              [this, choose](const ApplySettingsResponse&) { refresh(choose); });
  });
}

}  // namespace desert_sim
