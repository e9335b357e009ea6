#include "src/rviz/status_view.hpp"

#include <ros/names.h>

#include <QLabel>
#include <QTimer>
#include <QVBoxLayout>
#include <cmath>
#include <cstdio>

namespace desert_sim {

namespace {

using Presence = NodeWatch::Presence;

constexpr double long_lag = 1;              // [s]; /diagnostics warns of it, too
constexpr qint64 old_status = 5000;         // [ms]
constexpr double slow_wind = 0.1;           // [m/s]
constexpr int refresh_period = 1000;        // [ms]
constexpr const char* good = "#2e7d32";     // green
constexpr const char* bad = "#c62828";      // red
constexpr const char* neutral = "#757575";  // grey

template <class... Values>
std::string format(const char* pattern, Values... values) {
  char text[200];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

QLabel* line(const char* name, QVBoxLayout& layout) {
  auto* const label = new QLabel;
  label->setObjectName(name);
  label->setTextFormat(Qt::PlainText);
  label->setWordWrap(true);
  layout.addWidget(label);
  return label;
}

void set(QLabel* label, const std::string& text, const char* colour = nullptr) {
  label->setStyleSheet(colour ? QStringLiteral("color: %1").arg(colour) : QString());
  label->setText(QString::fromStdString(text));
  label->setVisible(!text.empty());
}

std::string state_text(Presence presence, const SimulationStatus* status, const std::string& node) {
  switch (presence) {
    case Presence::no_master:
      return "no ROS master";
    case Presence::no_node:
      return node + " is not there";
    case Presence::searching:
      return "looking for " + node + " ...";
    case Presence::alive:
      return status ? status->scenario + ": " + status->state : node + " has sent no status yet";
  }
  return "";
}

}  // namespace

double worst_residual(const SimulationStatus& status) {
  double worst = 0;
  for (const MaterialVolume& volume : status.volumes)
    if (!(std::abs(volume.residual) <= std::abs(worst))) worst = volume.residual;
  return worst;
}

std::string duration_text(double seconds) {
  constexpr double longest = 1e15;  // which is a whole number of seconds
  if (!(std::abs(seconds) <= longest)) return format("%g s", seconds);
  if (seconds < 60) return format("%.1f s", seconds);
  const auto whole = static_cast<long long>(seconds);
  if (whole < 3600) return format("%lld min %02lld s", whole / 60, whole % 60);
  if (whole < 86400) return format("%lld h %02lld min", whole / 3600, whole / 60 % 60);
  return format("%lld d %02lld h", whole / 86400, whole / 3600 % 24);
}

std::string hint(Presence presence, const SimulationStatus* status, const std::string& node) {
  if (presence == Presence::no_master)
    return "Start roscore or a launch file, and see that ROS_MASTER_URI is that of the node.";
  const bool failed = status && status->state == SimulationStatus::ERROR;
  if (failed && (presence == Presence::no_node || presence == Presence::alive))
    return node + " has failed: " + status->message;
  if (presence == Presence::no_node)
    return "Start it (roslaunch desert_sim desert_sim.launch), or write another name above. Names of nodes: "
           "rosnode "
           "list.";
  if (presence != Presence::alive || !status) return "";
  if (worst_residual(*status) != 0)
    return "Material was lost or gained, which must never happen: save a checkpoint and report it.";
  if (status->state == SimulationStatus::WAITING)
    return "It waits for /clock: play the bag, or start the simulator.";
  if (status->lag > long_lag) return "It is late: choose a lower rate, a smaller grid, or a GPU.";
  if (status->state == SimulationStatus::PAUSED)
    return status->undoable > 0 ? "Paused: undo takes back the last change exactly."
                                : "Paused: press Run, or make single steps.";
  if (std::hypot(status->wind_above.x, status->wind_above.y) < slow_wind)
    return "There is no wind: drag the needle of the dial.";
  if (!status->changes.empty()) return "Changing: " + status->changes;
  return "Turn the wind with the dial, let it rain, or load another scenario.";
}

std::string planner_text(const PlannerStatus& status) {
  std::string text = status.state;
  if (status.state == PlannerStatus::DRIVING || status.state == PlannerStatus::WAITING ||
      status.state == PlannerStatus::RECOVERING)
    text += format(", %.1f m to go", status.remaining);
  const bool waits = status.forecast_progress >= 0;
  const std::string progress = format("%.0f %%", 100 * status.forecast_progress);
  if (status.forecast_age >= 0)
    text +=
        format(", forecast of %.0f s ago", status.forecast_age) + (waits ? ", the next one " + progress : "");
  else if (waits)
    text += ", no forecast yet (" + progress + ")";
  return text;
}

StatusView::StatusView(QWidget* parent) : QWidget(parent) {
  auto* const rows = new QVBoxLayout(this);
  rows->setContentsMargins(0, 0, 0, 0);
  rows->setSpacing(2);
  state_ = line("state", *rows);
  QFont bold = state_->font();
  bold.setBold(true);
  state_->setFont(bold);
  progress_ = line("progress", *rows);
  rate_ = line("rate_line", *rows);
  balance_ = line("balance", *rows);
  planners_line_ = line("planners", *rows);
  hint_ = line("hint", *rows);
  QFont italic = hint_->font();
  italic.setItalic(true);
  hint_->setFont(italic);
  auto* const timer = new QTimer(this);
  connect(timer, &QTimer::timeout, this, &StatusView::refresh);
  timer->start(refresh_period);
}

void StatusView::show_presence(Presence presence, const std::string& node) {
  presence_ = presence;
  node_ = node;
  refresh();
}

void StatusView::show_status(const SimulationStatusConstPtr& status) {
  status_ = status;
  age_.restart();
  refresh();
}

void StatusView::show_planners(const PlannerStatuses& planners) {
  std::string lines;
  for (const auto& [name, status] : planners)
    lines += (lines.empty() ? "" : "\n") + ros::names::parentNamespace(name) + ": " + planner_text(*status);
  set(planners_line_, lines);
}

void StatusView::forget() {
  status_.reset();
  refresh();
}

void StatusView::refresh() {
  const bool alive = presence_ == Presence::alive;
  const SimulationStatus* const s = alive ? status_.get() : nullptr;
  const bool failed = s && s->state == SimulationStatus::ERROR;
  set(state_, state_text(presence_, s, node_),
      failed || presence_ == Presence::no_node || presence_ == Presence::no_master ? bad : nullptr);
  set(hint_, hint(presence_, status_.get(), node_), neutral);
  if (!s) {
    for (QLabel* const label : {progress_, rate_, balance_}) set(label, "");
    return;
  }
  const std::string age = age_.elapsed() > old_status
                              ? format("; heard %lld s ago", static_cast<long long>(age_.elapsed() / 1000))
                              : "";
  set(progress_, format("step %llu, %s simulated, on %s", static_cast<unsigned long long>(s->step),
                        duration_text(s->sim_time).c_str(), s->backend.c_str()) +
                     age);
  progress_->setToolTip(QString::fromStdString(s->device + ": " + s->message));
  const std::string wanted = s->step_rate > 0 ? format(" of %g", s->step_rate) : "";
  set(rate_, format("%.1f%s steps/s, lag %.1f s", s->steps_per_second, wanted.c_str(), s->lag),
      s->lag > long_lag ? bad : nullptr);
  const double residual = worst_residual(*s);
  set(balance_, residual == 0 ? "mass residual 0" : format("mass residual %g", residual),
      residual == 0 ? good : bad);
}

}  // namespace desert_sim
