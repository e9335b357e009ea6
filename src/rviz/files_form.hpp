#pragma once
/// Scenarios, terrains and checkpoints of a node, by name, and exports.

#include <QWidget>

#include "src/rviz/node_link.hpp"
#include "src/rviz/scene_lists.hpp"

class QComboBox;
class QGroupBox;
class QLineEdit;

namespace desert_sim {

class FilesForm : public QWidget {
  Q_OBJECT

 public:
  /// `link` must live longer.
  explicit FilesForm(NodeLink& link, QWidget* parent = nullptr);

  /// Looks again for what can be loaded, on the link's thread.
  void refresh();

 private:
  QGroupBox* make_scenario();
  QGroupBox* make_terrain();
  QGroupBox* make_checkpoint();
  void show(const SceneLists& lists);
  void load_scenario();
  void save_scenario();
  void save_terrain();
  void load_terrain();
  void save_checkpoint();
  void load_checkpoint();

  NodeLink& link_;
  QLineEdit* settings_;
  QComboBox *scenario_, *terrain_, *format_, *checkpoint_;
  ErrorLine *scenario_error_, *terrain_error_, *checkpoint_error_;
};

}  // namespace desert_sim
