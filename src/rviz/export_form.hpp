#pragma once
/// The terrain for other programs: ~export_terrain, with a list of the formats.

#include <QGroupBox>

#include "src/rviz/node_link.hpp"

class QComboBox;
class QLineEdit;
class QPushButton;

namespace desert_sim {

class ExportForm : public QGroupBox {
  Q_OBJECT

 public:
  /// `link` must live longer.
  explicit ExportForm(NodeLink& link, QWidget* parent = nullptr);

 private:
  /// Chooses the ending that is written in the name.
  void follow_name();
  /// What is written, with the ending that is chosen.
  QString file_name() const;
  void export_terrain();

  NodeLink& link_;
  QLineEdit* name_;
  QComboBox* ending_;
  ErrorLine* error_;
};

}  // namespace desert_sim
