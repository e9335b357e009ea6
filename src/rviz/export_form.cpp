#include "src/rviz/export_form.hpp"

#include <desert_sim/ExportTerrain.h>

#include <QComboBox>
#include <QHBoxLayout>
#include <QLineEdit>
#include <QVBoxLayout>

#include "src/rviz/fields.hpp"

namespace desert_sim {

namespace {

/// The ending in the list that a name has, or -1.
int ending_of(const QString& name, const QComboBox& endings) {
  for (int n = 0; n < endings.count(); ++n)
    if (name.endsWith(endings.itemText(n))) return n;
  return -1;
}

/// One or several paths of one folder: the first whole, of the others the names.
std::string in_one_line(const std::vector<std::string>& files) {
  std::string line;
  for (const std::string& file : files) line += line.empty() ? file : ", " + file.substr(file.rfind('/') + 1);
  return line;
}

}  // namespace

ExportForm::ExportForm(NodeLink& link, QWidget* parent) : QGroupBox("Export", parent), link_(link) {
  name_ = new QLineEdit;
  name_->setObjectName("export_name");
  name_->setPlaceholderText("a name for other programs");
  name_->setToolTip("A file below the node's ~data_dir");
  ending_ = new QComboBox;
  ending_->setObjectName("export_ending");
  ending_->addItems(QString::fromStdString(ExportTerrainRequest::ENDINGS).split(' '));
  ending_->setToolTip(
      "Meshes: .ply, .stl (ground), .glb, .obj (with water and plants)\n"
      "Heights: .exr (floats), .png (16 bits)\n.world: Gazebo 11");
  ending_->setFocusPolicy(Qt::StrongFocus);
  error_ = new ErrorLine("export_error");
  auto* const write = button("export_terrain", "Export", "Write the present terrain for other programs");
  auto* const row = new QHBoxLayout;
  row->addWidget(name_, 1);
  row->addWidget(ending_);
  row->addWidget(write);
  auto* const rows = new QVBoxLayout(this);
  rows->addLayout(row);
  rows->addWidget(error_);
  connect(name_, &QLineEdit::textEdited, this, &ExportForm::follow_name);
  connect(write, &QPushButton::clicked, this, &ExportForm::export_terrain);
}

void ExportForm::follow_name() {
  const int written = ending_of(name_->text().trimmed(), *ending_);
  if (written >= 0) ending_->setCurrentIndex(written);
}

QString ExportForm::file_name() const {
  QString name = name_->text().trimmed();
  const int written = ending_of(name, *ending_);
  if (written >= 0) name.chop(ending_->itemText(written).size());
  return name.isEmpty() ? name : name + ending_->currentText();
}

/// Apart from other calls: meshes of large terrains take long to write, and others need not wait for them.
void ExportForm::export_terrain() {
  ExportTerrainRequest request;
  request.name = file_name().toStdString();
  link_.call_apart<ExportTerrain>(error_, "export_terrain", request,
                                  [this](const ExportTerrainResponse& answer) {
                                    error_->show_note("exported: " + in_one_line(answer.files));
                                  });
}

}  // namespace desert_sim
