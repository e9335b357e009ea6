#pragma once
/// A table of numbers whose rows can be added and removed: segments of a wind schedule, springs.

#include <QString>
#include <QWidget>
#include <vector>

class QTableWidget;

namespace desert_sim {

class NumberTable : public QWidget {
  Q_OBJECT

 public:
  struct Column {
    QString title, tip;
    double low, high, start;  ///< range, and what a new row has without one above it
    int decimals = 1;
  };

  NumberTable(const QString& name, const std::vector<Column>& columns, QWidget* parent = nullptr);

  std::vector<std::vector<double>> rows() const;
  void set_rows(const std::vector<std::vector<double>>& rows);
  /// Hides or shows a column.
  void show_column(int column, bool shown);

 public Q_SLOTS:
  /// Adds a row like the last one.
  void add_row();
  /// Removes the row that is selected, else the last one.
  void remove_row();

 Q_SIGNALS:
  /// A number, or the number of rows.
  void changed();

 private:
  void append(const std::vector<double>& values);
  void fit_height();

  std::vector<Column> columns_;
  QTableWidget* table_;
};

}  // namespace desert_sim
