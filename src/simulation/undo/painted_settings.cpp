#include "src/simulation/undo/painted_settings.hpp"

#include <algorithm>

namespace desert_sim {

namespace {

ChangedSetting* find(Stroke& stroke, const std::string& key) {
  const auto at = std::find_if(stroke.settings.begin(), stroke.settings.end(),
                               [&key](const ChangedSetting& setting) { return setting.key == key; });
  return at == stroke.settings.end() ? nullptr : &*at;
}

ChangedSetting* newer(std::deque<Stroke>& strokes, const Stroke& stroke, const ChangedSetting& own) {
  ChangedSetting* above = nullptr;
  for (Stroke& other : strokes) {
    if (&other == &stroke || other.undone) continue;
    ChangedSetting* const there = find(other, own.key);
    if (there && there->order > own.order && (!above || there->order < above->order)) above = there;
  }
  return above;
}

}  // namespace

void paint(std::deque<Stroke>& strokes, Stroke& stroke, std::vector<ChangedSetting> settings,
           std::uint64_t order) {
  for (ChangedSetting& setting : settings) {
    setting.order = order;
    ChangedSetting* const own = find(stroke, setting.key);
    if (!own) {
      stroke.settings.push_back(std::move(setting));
    } else if (ChangedSetting* const above = newer(strokes, stroke, *own)) {
      above->before = own->before;
      *own = std::move(setting);
    } else {
      own->after = std::move(setting.after);
    }
  }
}

SettingsTurn::SettingsTurn(std::deque<Stroke>& strokes, Stroke& stroke, const SettingTexts& present) {
  for (ChangedSetting& own : stroke.settings) {
    Turned turned{&own, newer(strokes, stroke, own), own, {}};
    const auto at = present.find(own.key);
    const std::optional<std::string> text = at == present.end() ? std::optional<std::string>() : at->second;
    if (stroke.undone)
      turned.now.before = turned.above ? turned.above->before : text;
    else if (!turned.above)
      turned.now.after = text;
    turned.text = stroke.undone ? turned.now.after : turned.now.before;
    if (!turned.above && turned.text != text) changes_[own.key] = turned.text;
    turned_.push_back(std::move(turned));
  }
}

void SettingsTurn::commit() {
  for (Turned& turned : turned_) {
    *turned.own = turned.now;
    if (turned.above) turned.above->before = turned.text;
  }
}

}  // namespace desert_sim
