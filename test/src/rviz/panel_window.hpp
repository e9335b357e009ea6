#pragma once
/// The panel desert_sim/Panel in the test's own process, loaded as rviz does, with a hand that clicks and
/// types.

#include <rviz/panel.h>

#include <QAbstractButton>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QLineEdit>
#include <QTabWidget>
#include <QTableWidget>
#include <QTest>
#include <cstdlib>
#include <functional>
#include <memory>
#include <pluginlib/class_loader.hpp>
#include <stdexcept>
#include <string>

#include "test/support/ros/client.hpp"

namespace rviz_test {

/// The tabs of the panel, in their order.
enum Tab { wind, weather, physics, timeline, plants, scenes, drive };

class PanelWindow {
 public:
  explicit PanelWindow(const std::string& node)
      : loader_("rviz", "rviz::Panel"), panel_(loader_.createUnmanagedInstance("desert_sim/Panel")) {
    panel_->resize(380, 800);
    panel_->show();
    type("node", node);
  }
  ~PanelWindow() { delete panel_; }
  PanelWindow(const PanelWindow&) = delete;
  PanelWindow& operator=(const PanelWindow&) = delete;

  rviz::Panel& panel() { return *panel_; }

  /// A widget by its object's name; an exception if there is none.
  template <class Widget>
  Widget* find(const std::string& name) const {
    auto* const found = panel_->findChild<Widget*>(QString::fromStdString(name));
    if (!found) throw std::runtime_error("the panel has no " + name);
    return found;
  }
  std::string text(const std::string& label) const { return find<QLabel>(label)->text().toStdString(); }
  bool enabled(const std::string& name) const { return find<QWidget>(name)->isEnabled(); }
  /// What a line under a control says in red; empty if nothing was refused.
  std::string error(const std::string& line) const {
    auto* const label = find<QLabel>(line);
    return label->isVisibleTo(label->window()) && label->property("refused").toBool()
               ? label->text().toStdString()
               : "";
  }

  void show_tab(Tab index) { find<QTabWidget>("tabs")->setCurrentIndex(index); }
  void click(const std::string& button) { QTest::mouseClick(find<QAbstractButton>(button), Qt::LeftButton); }
  /// Clicks a row of a table.
  void choose_row(const std::string& table, int row) {
    auto* const widget = find<QTableWidget>(table);
    QTest::mouseClick(widget->viewport(), Qt::LeftButton, {},
                      widget->visualItemRect(widget->item(row, 0)).center());
  }
  /// What a cell of a table says.
  std::string cell_text(const std::string& table, int row, int column) const {
    const QTableWidgetItem* const item = find<QTableWidget>(table)->item(row, column);
    return item ? item->text().toStdString() : "";
  }
  void type(const std::string& field, const std::string& text) {
    auto* const widget = find<QWidget>(field);
    auto* const edit =
        widget->inherits("QLineEdit") ? qobject_cast<QLineEdit*>(widget) : widget->findChild<QLineEdit*>();
    if (!edit) throw std::runtime_error(field + " takes no text");
    edit->setFocus();
    edit->selectAll();
    QTest::keyClicks(edit, QString::fromStdString(text));
    QTest::keyClick(edit, Qt::Key_Return);
  }

  /// Writes a picture of the panel, so high, to the folder that DESERT_PICTURES names, if it names one.
  void save(const std::string& name, int height = 800) {
    const char* const folder = std::getenv("DESERT_PICTURES");
    if (!folder) return;
    panel_->resize(panel_->width(), height);
    QTest::qWait(50);  // what is laid out anew is painted
    panel_->grab().save(QString::fromStdString(std::string(folder) + "/" + name + ".png"));
  }

  /// Serves Qt until the condition holds; false if it does not within the time [s], times patience().
  bool run_until(const std::function<bool()>& condition, double seconds = 60) const {
    return QTest::qWaitFor(condition, static_cast<int>(1000 * seconds * node_test::patience()));
  }
  bool shows(const std::string& label, const std::string& part) const {
    return run_until([&] { return text(label).find(part) != std::string::npos; });
  }

 private:
  pluginlib::ClassLoader<rviz::Panel> loader_;
  rviz::Panel* panel_;
};

}  // namespace rviz_test
