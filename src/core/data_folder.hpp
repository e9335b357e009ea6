#pragma once
/// The data folder: services may read and write files below it, and nowhere else.

#include <memory>
#include <string>

#include "src/core/descriptor.hpp"
#include "src/core/error.hpp"

namespace desert_sim {

/// A file below the data folder that may be written. Its folder stays open: what is written lands there, even
/// if somebody puts a link in the place of one of the folders of its path meanwhile.
class WritableFile {
 public:
  WritableFile(std::string path, std::shared_ptr<const Descriptor> folder);
  /// The path, links followed, as users know it.
  const std::string& path() const { return path_; }

  /// Calls `write` with a path that leads to the file through the open folder, and that is valid until the
  /// call returns. What `write` refuses is told with path() instead.
  template <class Write>
  auto write(const Write& write) const {
    try {
      return write(path_through_folder());
    } catch (const WriteError& e) {
      throw WriteError(with_known_path(e.what()));
    } catch (const ConfigError& e) {
      throw ConfigError(with_known_path(e.what()));
    }
  }

 private:
  std::string folder_link() const;
  std::string path_through_folder() const;
  std::string with_known_path(std::string message) const;

  std::string path_;
  std::shared_ptr<const Descriptor> folder_;
};

class DataFolder {
 public:
  /// `path` need not exist yet; empty: desert_sim in ROS's own folder ($ROS_HOME, or ~/.ros).
  explicit DataFolder(const std::string& path);
  const std::string& path() const { return path_; }

  /// The path of the file `name` (a path below the folder), its links followed. Throws ConfigError for a name
  /// that is empty or absolute, has "..", a control character, more than 255 characters or more than 16
  /// folders, or leads out of the folder through links, or if something other than a regular file has that
  /// name; for_reading() also if there is none. What opens the path for reading later has to make sure itself
  /// that no link was put in the way meanwhile: see InputFile.
  std::string for_reading(const std::string& name) const;
  /// Whether for_reading() would return the path.
  bool has_file(const std::string& name) const;
  /// Whether it has a folder of this name; false also where for_reading() would refuse the name.
  bool has_folder(const std::string& name) const;
  /// Throws ConfigError for names that for_writing() refuses whatever there is in the folder.
  static void require_name(const std::string& name);
  /// Also creates the folders that are missing.
  WritableFile for_writing(const std::string& name) const;

 private:
  std::string path_;
};

}  // namespace desert_sim
