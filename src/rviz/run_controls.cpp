#include "src/rviz/run_controls.hpp"

#include <desert_sim/Step.h>
#include <desert_sim/Undo.h>
#include <std_srvs/Trigger.h>

#include <QHBoxLayout>
#include <QSpinBox>
#include <QVBoxLayout>
#include <utility>

#include "src/rviz/fields.hpp"
#include "src/rviz/settings_news.hpp"
#include "src/rviz/undo_text.hpp"

namespace desert_sim {

RunControls::RunControls(NodeLink& link, QWidget* parent) : QWidget(parent), link_(link) {
  error_ = new ErrorLine("run_error");
  step_error_ = new ErrorLine("step_error");
  undo_error_ = new ErrorLine("undo_error");
  auto* const all = new QVBoxLayout(this);
  all->setContentsMargins(0, 0, 0, 0);
  all->setSpacing(4);
  all->addWidget(make_run_row());
  all->addWidget(step_error_);
  all->addWidget(make_rate_row());
  pace_ = new QLabel;
  pace_->setObjectName("pace");
  pace_->setWordWrap(true);
  pace_->setTextFormat(Qt::PlainText);
  all->addWidget(pace_);
  all->addWidget(error_);
  all->addWidget(make_undo_row());
  all->addWidget(undo_error_);
}

QWidget* RunControls::make_run_row() {
  run_ = button("run", "Run", "Make steps at the rate below");
  pause_ = button("pause", "Pause", "Stop between two steps");
  step_ = button("step", "Step", "Make exactly so many steps, also while it runs");
  steps_ = new QSpinBox;
  steps_->setObjectName("steps");
  steps_->setRange(1, 1000000000);
  steps_->setMaximumWidth(90);
  reset_ = button("reset", "Reset", "Back to the start of the scenario");
  auto* const row = new QWidget;
  auto* const layout = new QHBoxLayout(row);
  layout->setContentsMargins(0, 0, 0, 0);
  for (QWidget* const widget : std::initializer_list<QWidget*>{run_, pause_, step_, steps_, reset_})
    layout->addWidget(widget);
  for (QPushButton* const narrow : {run_, pause_, step_, reset_}) narrow->setMinimumWidth(50);
  connect(run_, &QPushButton::clicked, this, [this] { link_.call<std_srvs::Trigger>(error_, "resume"); });
  connect(pause_, &QPushButton::clicked, this, [this] { link_.call<std_srvs::Trigger>(error_, "pause"); });
  connect(reset_, &QPushButton::clicked, this, [this] { link_.call<std_srvs::Trigger>(error_, "reset"); });
  connect(step_, &QPushButton::clicked, this, [this] {
    StepRequest request;
    request.steps = static_cast<std::uint32_t>(steps_->value());
    link_.call_apart<Step>(step_error_, "step", request);
  });
  return row;
}

QWidget* RunControls::make_rate_row() {
  rate_ =
      number_field("rate", 0, 1e6, 10, 1, " steps/s", "Steps a second of wall time; 0: as fast as it can");
  rate_->setSpecialValueText("as fast as it can");
  acceleration_ =
      number_field("acceleration", 0, 1e6, 0, 4, "",
                   "Seconds of the desert's time per second (run.acceleration); above 0 it sets the rate");
  acceleration_->setSpecialValueText("not tied");
  acceleration_->setMaximumWidth(QWIDGETSIZE_MAX);
  auto* const row = new QWidget;
  auto* const layout = new QHBoxLayout(row);
  layout->setContentsMargins(0, 0, 0, 0);
  rate_->setMaximumWidth(QWIDGETSIZE_MAX);
  layout->addWidget(new QLabel("rate"));
  layout->addWidget(rate_, 1);
  layout->addWidget(acceleration_, 1);
  layout->addWidget(new QLabel("× real time"));
  connect(rate_, qOverload<double>(&QDoubleSpinBox::valueChanged), this,
          [this](double rate) { link_.set_number(error_, "step_rate", rate); });
  connect(acceleration_, qOverload<double>(&QDoubleSpinBox::valueChanged), this,
          [this](double value) { link_.set_number(error_, "run__acceleration", value); });
  return row;
}

QWidget* RunControls::make_undo_row() {
  undo_ = button("undo", "Undo", "Take back what was painted or set last; then the last reset or load");
  redo_ = button("redo", "Redo", "Give back what was undone last");
  auto* const row = new QWidget;
  auto* const layout = new QHBoxLayout(row);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(undo_);
  layout->addWidget(redo_);
  connect(undo_, &QPushButton::clicked, this, [this] { turn("undo"); });
  connect(redo_, &QPushButton::clicked, this, [this] { turn("redo"); });
  return row;
}

void RunControls::turn(const char* service) {
  link_.call<Undo>(undo_error_, service, {}, [this](const UndoResponse& answer) {
    if (const std::string text = turn_text(answer); !text.empty()) undo_error_->show_note(text);
    if (changes_settings(answer)) SettingsNews::tell(link_.node());
  });
}

void RunControls::show_status(const SimulationStatus& status) {
  const bool paused = status.state == SimulationStatus::PAUSED;
  run_->setEnabled(paused);
  pause_->setEnabled(!paused);
  undo_->setText(QStringLiteral("Undo (%1)").arg(status.undoable));
  undo_->setEnabled(status.undoable > 0);
  redo_->setText(QStringLiteral("Redo (%1)").arg(status.redoable));
  redo_->setEnabled(status.redoable > 0);
  rate_->setEnabled(!(status.acceleration > 0));
  pace_->setText(QString::fromStdString(status.pace));
  for (const auto& [field, value] :
       {std::pair(rate_, status.step_rate), std::pair(acceleration_, status.acceleration)}) {
    if (field->hasFocus()) continue;  // somebody types
    const QSignalBlocker silent(field);
    field->setValue(value);
  }
}

int RunControls::steps() const { return steps_->value(); }
void RunControls::set_steps(int steps) { steps_->setValue(steps); }

}  // namespace desert_sim
