#pragma once
/// The panel desert_sim/Panel of rviz: steers a node through its public services, and shows its status.

#include <rviz/panel.h>

#include "src/rviz/node_link.hpp"

class QLineEdit;

namespace desert_sim {

class DriveForm;
class FilesForm;
class PlantsForm;
class RunControls;
class StatusView;
class TimelineForm;
class WindForm;

class DesertPanel : public rviz::Panel {
  Q_OBJECT

 public:
  explicit DesertPanel(QWidget* parent = nullptr);

  ~DesertPanel() override;

  void load(const rviz::Config& config) override;
  void save(rviz::Config config) const override;

 private Q_SLOTS:
  void choose_node();
  void show_presence();
  void show_status(const desert_sim::SimulationStatusConstPtr& status);

 private:
  QWidget* make_controls();

  NodeLink link_;  ///< before the forms, which use it
  QLineEdit* node_;
  ErrorLine* node_error_;
  StatusView* status_;
  RunControls* run_;
  WindForm* wind_;
  DriveForm* drive_;
  FilesForm* files_;
  PlantsForm* plants_;
  TimelineForm* timeline_;
  std::string scenario_;  ///< whose species are shown
  QWidget* controls_;     ///< all that needs a node
};

}  // namespace desert_sim
