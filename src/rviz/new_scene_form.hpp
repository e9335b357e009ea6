#pragma once
/// A scene from nothing: its grid, its ground, its wind, and what moves the sand, begun by ~new_scenario.

#include <QGroupBox>
#include <string>

#include "src/rviz/node_link.hpp"

class QComboBox;
class QDoubleSpinBox;
class QSpinBox;

namespace desert_sim {

class NewSceneForm : public QGroupBox {
  Q_OBJECT

 public:
  /// `link` must live longer.
  explicit NewSceneForm(NodeLink& link, QWidget* parent = nullptr);

  /// The scenario that the fields describe.
  std::string yaml() const;

 private:
  QLayout* make_grid();
  void begin();

  NodeLink& link_;
  QSpinBox *width_, *height_, *seed_;
  QDoubleSpinBox *cell_size_, *sand_, *relief_, *rock_, *scale_, *direction_, *speed_;
  QComboBox *boundary_, *model_;
  ErrorLine* error_;
};

}  // namespace desert_sim
