#pragma once
/// The statuses of a display in rviz's list. Qt's model is told only what has changed.

#include <rviz/display.h>

#include <map>
#include <string>

namespace desert_sim {

class DisplayStatuses {
 public:
  explicit DisplayStatuses(rviz::Display& display) : display_(display) {}

  void set(rviz::StatusProperty::Level level, const char* name, const std::string& text) {
    std::string& shown = texts_[name];
    if (shown == text) return;
    shown = text;
    display_.setStatus(level, name, QString::fromStdString(text));
  }
  /// After rviz::Display::clearStatuses().
  void clear() { texts_.clear(); }

 private:
  rviz::Display& display_;
  std::map<std::string, std::string> texts_;  ///< that are shown
};

}  // namespace desert_sim
