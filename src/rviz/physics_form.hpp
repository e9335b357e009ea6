#pragma once
/// All parameters of the scenario that can change while it runs, section by section, as the node describes
/// them (~parameter_descriptions): names, units, ranges and choices are those of its parameter tables.

#include <desert_sim/GetScenario.h>

#include <QString>
#include <QWidget>
#include <map>
#include <string>
#include <vector>

#include "src/rviz/live_parameter_list.hpp"
#include "src/rviz/node_link.hpp"

class QComboBox;
class QDoubleSpinBox;
class QFormLayout;
class QLineEdit;

namespace desert_sim {

class PhysicsForm : public QWidget {
  Q_OBJECT

 public:
  /// `link` must live longer.
  explicit PhysicsForm(NodeLink& link, QWidget* parent = nullptr);

  /// Takes the place of an earlier description.
  void describe(const dynamic_reconfigure::ConfigDescription& description);
  void show_parameters(const dynamic_reconfigure::Config& parameters);

 private:
  /// Shows the rows of the chosen section, or of all parameters that have what is searched for.
  void choose();
  QWidget* make_field(const LiveParameter& parameter);
  void show_values();
  void set(const LiveParameter& parameter, const QString& value);
  void reset_section();
  void reset_to(const GetScenarioResponse& start);

  NodeLink& link_;
  std::vector<LiveParameter> parameters_;
  std::map<std::string, QString> values_;   ///< by path
  std::map<std::string, QWidget*> fields_;  ///< that are shown, by path
  QComboBox* section_;
  QLineEdit* search_;
  QDoubleSpinBox* ramp_;
  QWidget* rows_;
  QFormLayout* form_;
  ErrorLine* error_;
};

}  // namespace desert_sim
