#pragma once
/// The data folder: services may read and write files below it, and nowhere else.

#include <string>

namespace desert_sim {

class DataFolder {
 public:
  /// `path` need not exist yet; empty: desert_sim in ROS's own folder ($ROS_HOME, or ~/.ros).
  explicit DataFolder(const std::string& path);
  const std::string& path() const { return path_; }

  /// The path of the file `name` (a path below the folder). Both throw ConfigError for a name that is empty
  /// or absolute, has "..", or leads out of the folder through links.
  std::string for_reading(const std::string& name) const;
  /// Also creates the folders that are missing.
  std::string for_writing(const std::string& name) const;
  /// Throws ConfigError unless the file `path`, its links followed, exists and lies below the folder.
  void require_below(const std::string& path) const;

 private:
  std::string path_;
};

}  // namespace desert_sim
