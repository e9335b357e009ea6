#pragma once
/// What happens when in a node (run.timeline): a list of entries, which can be added, changed and removed.

#include <desert_sim/SimulationStatus.h>

#include <QWidget>
#include <functional>
#include <string>
#include <vector>

#include "src/rviz/node_link.hpp"
#include "src/rviz/timeline_entries.hpp"

class QPushButton;
class QTableWidget;

namespace desert_sim {

class TimelineEntryForm;

class TimelineForm : public QWidget {
  Q_OBJECT

 public:
  /// `link` must live longer.
  explicit TimelineForm(NodeLink& link, QWidget* parent = nullptr);

  void show_status(const SimulationStatus& status);
  void describe(const dynamic_reconfigure::ConfigDescription& description);

 protected:
  void showEvent(QShowEvent* event) override;

 private:
  /// An entry as it is listed.
  struct Row {
    std::string entry;
    double end;  ///< it does not happen after it [s]
  };
  /// Changes the entries, and returns the place of the one that is chosen then; -1: none.
  using Edit = std::function<int(TimelineEntries&)>;
  static constexpr int keep_choice = -2;

  void make_table();
  /// Asks the node for its entries, now or when the list is seen. `choose`: place of the entry that is then
  /// chosen.
  void refresh(int choose = keep_choice);
  void show_entries(const TimelineEntries& entries, int choose);
  void show_past();
  void fit_height();
  std::vector<std::string> chosen() const;
  void show_choice();

  void add();
  void change();
  void remove();
  /// The node's own entries are edited, which somebody else may have changed since they were listed.
  void edit(const Edit& edit);

  NodeLink& link_;
  std::vector<Row> rows_;
  std::string scenario_, changes_;  ///< as of the last status
  std::uint64_t step_ = 0;
  double now_ = 0;      ///< simulated [s]
  bool stale_ = false;  ///< the list is to be asked for when it is seen
  QLabel* none_;
  QTableWidget* table_;
  QPushButton *change_, *remove_;
  TimelineEntryForm* form_;
  ErrorLine *list_error_, *error_;
};

}  // namespace desert_sim
