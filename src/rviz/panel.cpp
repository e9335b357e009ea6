#include "src/rviz/panel.hpp"

#include <QHBoxLayout>
#include <QLineEdit>
#include <QScrollArea>
#include <QTabWidget>
#include <QVBoxLayout>
#include <pluginlib/class_list_macros.hpp>

#include "src/core/error.hpp"
#include "src/rviz/drive_form.hpp"
#include "src/rviz/files_form.hpp"
#include "src/rviz/physics_form.hpp"
#include "src/rviz/plants_form.hpp"
#include "src/rviz/run_controls.hpp"
#include "src/rviz/settings_news.hpp"
#include "src/rviz/status_view.hpp"
#include "src/rviz/timeline_form.hpp"
#include "src/rviz/weather_form.hpp"
#include "src/rviz/wind_form.hpp"

namespace desert_sim {

namespace {

QScrollArea* scrolled(QWidget* widget) {
  auto* const area = new QScrollArea;
  area->setWidget(widget);
  area->setWidgetResizable(true);
  area->setFrameShape(QFrame::NoFrame);
  area->setHorizontalScrollBarPolicy(Qt::ScrollBarAsNeeded);
  return area;
}

}  // namespace

DesertPanel::DesertPanel(QWidget* parent) : rviz::Panel(parent) {
  node_ = new QLineEdit("desert_sim");
  node_->setObjectName("node");
  node_->setToolTip("Name of the node that this panel steers");
  node_error_ = new ErrorLine("node_error");
  status_ = new StatusView;
  auto* const name_row = new QHBoxLayout;
  name_row->addWidget(new QLabel("Node"));
  name_row->addWidget(node_);
  auto* const all = new QVBoxLayout(this);
  all->setContentsMargins(6, 6, 6, 6);
  all->addLayout(name_row);
  all->addWidget(node_error_);
  all->addWidget(status_);
  all->addWidget(make_controls(), 1);

  connect(node_, &QLineEdit::editingFinished, this, [this] {
    if (node_->text().trimmed().toStdString() == link_.node() && !node_error_->refused()) return;
    choose_node();
    Q_EMIT configChanged();
  });
  connect(&link_, &NodeLink::presence_changed, this, &DesertPanel::show_presence);
  connect(&link_, &NodeLink::status_came, this, &DesertPanel::show_status);
  choose_node();
}

DesertPanel::~DesertPanel() { delete controls_; }  // while there is the link that they use

QWidget* DesertPanel::make_controls() {
  controls_ = new QWidget;
  controls_->setObjectName("controls");
  run_ = new RunControls(link_);
  wind_ = new WindForm(link_);
  files_ = new FilesForm(link_);
  auto* const tabs = new QTabWidget;
  tabs->setObjectName("tabs");
  tabs->addTab(scrolled(wind_), "Wind");
  auto* const weather = new WeatherForm(link_);
  connect(&link_, &NodeLink::parameters_came, weather,
          [weather](const dynamic_reconfigure::ConfigConstPtr& parameters) {
            weather->show_parameters(*parameters);
          });
  tabs->addTab(scrolled(weather), "Weather");
  auto* const physics = new PhysicsForm(link_);
  connect(&link_, &NodeLink::description_came, physics,
          [physics](const dynamic_reconfigure::ConfigDescriptionConstPtr& description) {
            physics->describe(*description);
          });
  connect(&link_, &NodeLink::parameters_came, physics,
          [physics](const dynamic_reconfigure::ConfigConstPtr& parameters) {
            physics->show_parameters(*parameters);
          });
  tabs->addTab(scrolled(physics), "Physics");
  timeline_ = new TimelineForm(link_);
  connect(&link_, &NodeLink::description_came, timeline_,
          [this](const dynamic_reconfigure::ConfigDescriptionConstPtr& description) {
            timeline_->describe(*description);
          });
  tabs->addTab(scrolled(timeline_), "Timeline");
  plants_ = new PlantsForm(link_);
  connect(&SettingsNews::instance(), &SettingsNews::changed, plants_, [this](const QString& node) {
    if (node.toStdString() == link_.node()) plants_->refresh();
  });
  tabs->addTab(scrolled(plants_), "Plants");
  tabs->addTab(scrolled(files_), "Scenes");
  drive_ = new DriveForm(link_);
  tabs->addTab(scrolled(drive_), "Drive");
  connect(&link_.watch(), &NodeWatch::rovers_changed, drive_, &DriveForm::show_rovers);
  connect(&link_.watch(), &NodeWatch::planners_changed, drive_, &DriveForm::show_planners);
  connect(&link_.watch(), &NodeWatch::planners_changed, status_, &StatusView::show_planners);
  auto* const rows = new QVBoxLayout(controls_);
  rows->setContentsMargins(0, 0, 0, 0);
  rows->addWidget(run_);
  rows->addWidget(tabs, 1);
  return controls_;
}

void DesertPanel::choose_node() {
  for (ErrorLine* const line : findChildren<ErrorLine*>()) line->show_nothing();
  try {
    link_.set_node(node_->text().trimmed().toStdString());
  } catch (const ConfigError& e) {
    node_error_->show_error(e.what());
    return;
  }
  status_->forget();
  wind_->forget();
  show_presence();
}

void DesertPanel::show_presence() {
  const NodeWatch::Presence presence = link_.watch().presence();
  status_->show_presence(presence, link_.node());
  controls_->setEnabled(presence == NodeWatch::Presence::alive);
  if (presence != NodeWatch::Presence::alive) return;
  files_->refresh();
  plants_->refresh();
}

void DesertPanel::show_status(const SimulationStatusConstPtr& status) {
  status_->show_status(status);
  run_->show_status(*status);
  wind_->show_status(*status);
  timeline_->show_status(*status);
  if (status->scenario == scenario_) return;
  scenario_ = status->scenario;
  plants_->refresh();
}

void DesertPanel::load(const rviz::Config& config) {
  rviz::Panel::load(config);
  QString node;
  int steps = 0;
  if (config.mapGetInt("Steps", &steps)) run_->set_steps(steps);
  if (!config.mapGetString("Node", &node)) return;
  node_->setText(node);
  choose_node();
}

void DesertPanel::save(rviz::Config config) const {
  rviz::Panel::save(config);
  config.mapSetValue("Node", node_->text());
  config.mapSetValue("Steps", run_->steps());
}

}  // namespace desert_sim

PLUGINLIB_EXPORT_CLASS(desert_sim::DesertPanel, rviz::Panel)
