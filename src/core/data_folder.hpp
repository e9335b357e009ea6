#pragma once
/// The data folder: services may read and write files below it, and nowhere else.

#include <string>

namespace desert_sim {

class DataFolder {
 public:
  /// `path` need not exist yet; empty: desert_sim in ROS's own folder ($ROS_HOME, or ~/.ros).
  explicit DataFolder(const std::string& path);
  const std::string& path() const { return path_; }

  /// The path of the file `name` (a path below the folder), its links followed. Throws ConfigError for a name
  /// that is empty or absolute, has "..", a control character, more than 255 characters or more than 16
  /// folders, or leads out of the folder through links; for_reading() also if it names no regular file. What
  /// opens the path later has to make sure itself that no link was put in the way meanwhile: see InputFile.
  std::string for_reading(const std::string& name) const;
  /// Also creates the folders that are missing.
  std::string for_writing(const std::string& name) const;

 private:
  std::string path_;
};

}  // namespace desert_sim
