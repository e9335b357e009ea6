#pragma once
/// Preset files of a folder below config. cmake/DesertPresets.cmake compiles their texts into the library.

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace desert_sim {

class Presets {
 public:
  using Row = std::pair<const char*, const char*>;  ///< name, text

  template <std::size_t count>
  explicit constexpr Presets(const Row (&rows)[count]) : rows_(rows), count_(count) {}

  /// The text of the preset with this name; null if there is none.
  const char* text(const std::string& name) const {
    const Row* found = std::find_if(rows_, rows_ + count_, [&](const Row& row) { return name == row.first; });
    return found == rows_ + count_ ? nullptr : found->second;
  }
  /// Names of all presets, in alphabetical order.
  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (std::size_t n = 0; n < count_; ++n) all.emplace_back(rows_[n].first);
    std::sort(all.begin(), all.end());
    return all;
  }

 private:
  const Row* rows_;
  std::size_t count_;
};

}  // namespace desert_sim
