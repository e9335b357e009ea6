#pragma once
/// The species of a node's plants: their traits, ranges and units as the parameter table has them, their
/// colour, and further species from presets.

#include <desert_sim/GetScenario.h>

#include <QStringList>
#include <QWidget>
#include <map>
#include <string>
#include <vector>

#include "src/rviz/node_link.hpp"

class QComboBox;
class QLineEdit;
class QPushButton;

namespace desert_sim {

class PlantsForm : public QWidget {
  Q_OBJECT

 public:
  /// `link` must live longer.
  explicit PlantsForm(NodeLink& link, QWidget* parent = nullptr);

  /// Asks the node for its species.
  void refresh();

 private:
  QWidget* make_traits();
  QWidget* make_addition();
  void show(const GetScenarioResponse& answer);
  /// Shows the chosen species. `keep_typed`: but for what somebody has typed and not yet set.
  void show_traits(bool keep_typed);
  void apply_traits();
  void add_species();
  void let_live();
  void apply(const std::vector<std::string>& settings);

  using Traits = std::map<std::string, QString>;
  NodeLink& link_;
  std::vector<Traits> species_;  ///< of the node, in its order
  std::map<std::string, QLineEdit*> fields_;
  QComboBox *name_, *preset_;
  QLineEdit* new_name_;
  QLabel* colour_;
  QPushButton* live_;
  ErrorLine *list_error_,
      *error_;  ///< of the list of species; of changes, which a list that comes leaves alone
};

}  // namespace desert_sim
