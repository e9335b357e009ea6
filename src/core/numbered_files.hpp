#pragma once
/// Files of one folder that a program numbers: the highest number is the newest.

#include <cstddef>
#include <string>
#include <vector>

namespace desert_sim {

/// The regular files FOLDER/<prefix><number><suffix>. Numbers have ten digits, or more without leading zeros,
/// and are compared as numbers of any length, so that a file to which somebody has given a name like these is
/// never newer than what is saved after it. Throws ConfigError if the folder cannot be read or changed.
class NumberedFiles {
 public:
  NumberedFiles(std::string folder, std::string prefix, std::string suffix);
  /// The paths of the files there are, newest first; none if there is no folder.
  std::vector<std::string> paths() const;
  /// The name for a file that is newer than all.
  std::string next_name() const;
  /// Removes all files but the newest `count` and those in `needed` (paths), and what writers that were
  /// killed have left.
  void keep_newest(std::size_t count, const std::vector<std::string>& needed = {}) const;

 private:
  std::vector<std::string> names() const;
  std::vector<std::string> numbers() const;
  std::string folder_, prefix_, suffix_;
};

}  // namespace desert_sim
