#pragma once
/// The fields of one entry of a timeline: when it happens, and which parameters it sets or which command it
/// gives.

#include <QWidget>
#include <map>
#include <string>
#include <vector>

#include "src/rviz/live_parameter_list.hpp"

class QComboBox;
class QGridLayout;
class QLabel;
class QLineEdit;
class QPlainTextEdit;

namespace desert_sim {

class TimelineEntryForm : public QWidget {
  Q_OBJECT

 public:
  explicit TimelineEntryForm(QWidget* parent = nullptr);

  /// The parameters that can be chosen.
  void describe(const dynamic_reconfigure::ConfigDescription& description);
  /// How far ahead an entry is at first [s], unless somebody has typed when.
  void suggest(double ahead);
  void show_entry(const std::string& entry);
  /// What the fields say; a time from now counts from `now` [s]. Throws ConfigError where that is no YAML;
  /// all else is for the node to judge.
  std::string entry(double now) const;

 private:
  struct ParameterField {
    QComboBox* path;
    QLineEdit* value;
  };

  QWidget* make_times();
  QWidget* make_parameters();
  QWidget* make_command();
  QLineEdit* time_field(const QString& name, const QString& empty, const QString& tip);
  void add_parameter(const QString& path = {}, const QString& value = {});
  /// Says at a parameter what it may be.
  void explain(const ParameterField& field) const;
  void show_kind();
  void show_time(QLineEdit* field, const std::string& given);
  /// What a field says: what it was given, which may have more digits, unless somebody has typed.
  std::string time_said(QLineEdit* field) const;

  std::vector<LiveParameter> parameters_;
  QComboBox *from_, *kind_;  ///< whether the time counts from now; parameters, or a command
  QLineEdit *time_, *every_, *until_, *ramp_;
  std::map<QLineEdit*, std::string> given_;  ///< times of the entry that is shown
  QWidget *set_, *command_;
  QLabel *ramp_label_, *keys_label_, *kept_label_;
  QGridLayout* rows_;
  std::vector<ParameterField> fields_;
  QPlainTextEdit* keys_;
  std::map<std::string, std::string> kept_;  ///< keys too long to be shown, and their values
};

}  // namespace desert_sim
