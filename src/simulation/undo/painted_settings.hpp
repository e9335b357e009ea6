#pragma once
/// What strokes do to settings. Of each setting, the newest stroke that set it and is not undone says what it
/// is, as with the cells of painted layers.

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "src/simulation/undo/settings.hpp"
#include "src/simulation/undo/stroke.hpp"

namespace desert_sim {

/// Adds to a stroke what a command has set; `order` as in PaintedCell.
void paint(std::deque<Stroke>& strokes, Stroke& stroke, std::vector<ChangedSetting> settings,
           std::uint64_t order);

/// What an undo or redo of a stroke does to settings.
class SettingsTurn {
 public:
  /// `present`: all settings.
  SettingsTurn(std::deque<Stroke>& strokes, Stroke& stroke, const SettingTexts& present);
  /// What is to be set.
  const SettingChanges& changes() const { return changes_; }
  /// It was set: the strokes are as after the undo or redo.
  void commit();

 private:
  struct Turned {
    ChangedSetting* own;
    ChangedSetting* above;  ///< of the next newer stroke that set it; null if none has
    ChangedSetting now;
    std::optional<std::string> text;
  };
  std::vector<Turned> turned_;
  SettingChanges changes_;
};

}  // namespace desert_sim
