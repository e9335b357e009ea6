#include "src/rviz/number_table.hpp"

#include <QDoubleSpinBox>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QPushButton>
#include <QTableWidget>
#include <QVBoxLayout>
#include <algorithm>

#include "src/rviz/fields.hpp"

namespace desert_sim {

namespace {

constexpr int most_visible_rows = 6;

}  // namespace

NumberTable::NumberTable(const QString& name, const std::vector<Column>& columns, QWidget* parent)
    : QWidget(parent), columns_(columns), table_(new QTableWidget(0, static_cast<int>(columns.size()))) {
  setObjectName(name);
  table_->setObjectName(name + "_table");
  for (int n = 0; n < table_->columnCount(); ++n) {
    const Column& column = columns_[static_cast<std::size_t>(n)];
    auto* const header = new QTableWidgetItem(column.title);
    header->setToolTip(column.tip);
    table_->setHorizontalHeaderItem(n, header);
  }
  table_->horizontalHeader()->setSectionResizeMode(QHeaderView::Stretch);
  table_->verticalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
  table_->setSelectionBehavior(QAbstractItemView::SelectRows);
  auto* const add = new QPushButton("Add row");
  add->setObjectName(name + "_add");
  auto* const remove = new QPushButton("Remove row");
  remove->setObjectName(name + "_remove");
  connect(add, &QPushButton::clicked, this, &NumberTable::add_row);
  connect(remove, &QPushButton::clicked, this, &NumberTable::remove_row);

  auto* const buttons = new QHBoxLayout;
  buttons->addWidget(add);
  buttons->addWidget(remove);
  buttons->addStretch();
  auto* const all = new QVBoxLayout(this);
  all->setContentsMargins(0, 0, 0, 0);
  all->addWidget(table_);
  all->addLayout(buttons);
  fit_height();
}

std::vector<std::vector<double>> NumberTable::rows() const {
  std::vector<std::vector<double>> rows(static_cast<std::size_t>(table_->rowCount()));
  for (int row = 0; row < table_->rowCount(); ++row)
    for (int column = 0; column < table_->columnCount(); ++column)
      rows[static_cast<std::size_t>(row)].push_back(
          qobject_cast<QDoubleSpinBox*>(table_->cellWidget(row, column))->value());
  return rows;
}

void NumberTable::set_rows(const std::vector<std::vector<double>>& rows) {
  table_->setRowCount(0);
  for (const std::vector<double>& row : rows) append(row);
  fit_height();
  Q_EMIT changed();
}

void NumberTable::show_column(int column, bool shown) { table_->setColumnHidden(column, !shown); }

void NumberTable::add_row() {
  const auto present = rows();
  std::vector<double> values;
  for (const Column& column : columns_) values.push_back(column.start);
  append(present.empty() ? values : present.back());
  fit_height();
  Q_EMIT changed();
}

void NumberTable::remove_row() {
  const int selected = table_->currentRow();
  if (table_->rowCount() > 0) table_->removeRow(selected >= 0 ? selected : table_->rowCount() - 1);
  fit_height();
  Q_EMIT changed();
}

void NumberTable::append(const std::vector<double>& values) {
  const int row = table_->rowCount();
  table_->insertRow(row);
  for (int n = 0; n < table_->columnCount(); ++n) {
    const Column& column = columns_[static_cast<std::size_t>(n)];
    auto* const field = new NumberField;
    field->setFrame(false);
    field->setButtonSymbols(QAbstractSpinBox::NoButtons);
    field->setDecimals(column.decimals);
    field->setRange(column.low, column.high);
    field->setToolTip(column.tip);
    field->setValue(static_cast<std::size_t>(n) < values.size() ? values[static_cast<std::size_t>(n)]
                                                                : column.start);
    connect(field, qOverload<double>(&QDoubleSpinBox::valueChanged), this, &NumberTable::changed);
    table_->setCellWidget(row, n, field);
  }
}

void NumberTable::fit_height() {
  int height = table_->horizontalHeader()->sizeHint().height() + 2 * table_->frameWidth();
  const int visible = std::clamp(table_->rowCount(), 1, most_visible_rows);
  for (int row = 0; row < visible; ++row)
    height +=
        row < table_->rowCount() ? table_->rowHeight(row) : table_->verticalHeader()->defaultSectionSize();
  table_->setFixedHeight(height + 2);
}

}  // namespace desert_sim
