#pragma once
/// The one folder below which services may read and write files.

#include <string>

namespace desert_sim {

class DataFolder {
 public:
  /// `path` need not exist yet; empty: desert_sim in ROS's own folder ($ROS_HOME, or ~/.ros).
  explicit DataFolder(const std::string& path);
  const std::string& path() const { return path_; }

  /// The file that `name` (a path below the folder) stands for. Both throw ConfigError for a name that is
  /// empty, absolute, has
  /// "..", or leads out of the folder through links.
  std::string for_reading(const std::string& name) const;
  /// Makes the folders that are missing.
  std::string for_writing(const std::string& name) const;
  /// Throws ConfigError unless `path`, its links followed, lies below the folder; a file that is not there
  /// does not.
  void require_below(const std::string& path) const;

 private:
  std::string path_;
};

}  // namespace desert_sim
