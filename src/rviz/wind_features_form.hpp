#pragma once
/// The local features of a node's wind as a list, whose numbers can be changed and which can be deleted.

#include <desert_sim/WindFeatureList.h>

#include <QWidget>
#include <optional>
#include <vector>

#include "src/rviz/node_link.hpp"
#include "src/rviz/wind_features.hpp"

class QDoubleSpinBox;
class QLineEdit;
class QPushButton;
class QSpinBox;
class QTableWidget;

namespace desert_sim {

class WindFeaturesForm : public QWidget {
  Q_OBJECT

 public:
  /// `link` must live longer.
  explicit WindFeaturesForm(NodeLink& link, QWidget* parent = nullptr);

 private:
  /// A number of a feature and its field.
  struct Number {
    QLabel* label;
    QDoubleSpinBox* field;
    double& (*of)(WindFeatureItem&);
    bool (*has)(const WindFeatureItem&);
  };

  void make_table();
  QWidget* make_fields();
  void show_features(const WindFeatures& features);
  void fill_table();
  /// The chosen feature, as the list has it; null if none is.
  const WindFeatureItem* chosen() const;
  /// Shows the numbers of the chosen feature, unless they are shown already and perhaps being changed.
  void show_chosen();
  void apply();
  void call(const EditWind::Request& request);

  NodeLink& link_;
  WindFeatures features_;
  std::optional<WindFeatureItem> shown_;  ///< in the fields
  QLabel* none_;
  QTableWidget* table_;
  QWidget* fields_;
  std::vector<Number> numbers_;
  QLabel* seed_label_;
  QSpinBox* seed_;
  QLineEdit* path_;
  QPushButton *delete_, *delete_all_;
  ErrorLine* error_;
};

}  // namespace desert_sim
