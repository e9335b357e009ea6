#include "src/core/data_folder.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "src/core/error.hpp"
#include "src/core/input_file.hpp"
#include "src/core/quoted.hpp"

namespace desert_sim {

namespace fs = std::filesystem;

namespace {

std::string ros_folder() {
  if (const char* home = std::getenv("ROS_HOME")) return home;
  const char* home = std::getenv("HOME");
  return (home ? std::string(home) : "") + "/.ros";
}

constexpr std::size_t longest_name = 255;  // [bytes]
constexpr long most_folders = 16;

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

/// The name as a path, if nothing is wrong with the name itself.
fs::path checked_path(const std::string& name) {
  const auto throw_error = [&](const std::string& reason) {
    std::string shown = shortened(name);  // a newline would begin another message in a log
    std::replace_if(shown.begin(), shown.end(), is_control, '?');
    throw ConfigError("'" + shown + "'" + ": " + reason + " (allowed: a path below ~data_dir)");
  };
  if (name.empty()) throw_error("is empty");
  if (name.size() > longest_name)
    throw_error("has " + std::to_string(name.size()) + " characters, at most " +
                std::to_string(longest_name) + " are allowed");
  if (const auto control = std::find_if(name.begin(), name.end(), is_control); control != name.end())
    throw_error("contains the control character with the code " + std::to_string(*control) + " after " +
                std::to_string(control - name.begin()) + " others");
  const fs::path path(name);
  if (path.is_absolute()) throw_error("is absolute");
  for (const fs::path& part : path)
    if (part == "..") throw_error("contains '..'");
  if (path.filename().empty() || path.filename() == ".") throw_error("names no file");
  const long folders = std::distance(path.begin(), path.end()) - 1;
  if (folders > most_folders)
    throw_error("lies " + std::to_string(folders) + " folders deep, at most " + std::to_string(most_folders) +
                " are allowed");
  return path;
}

/// `path` with its links followed. Throws if that is not below `root`. The last part of the path need not
/// exist, unless it is a link.
fs::path resolve_links(const fs::path& root, const fs::path& path, const std::string& name) {
  const fs::path real = fs::is_symlink(fs::symlink_status(path))
                            ? fs::canonical(path)
                            : fs::canonical(path.parent_path()) / path.filename();
  if (!is_below(root, real))
    throw ConfigError(quoted(name) + ": a symbolic link points outside the folder " + root.string());
  return real;
}

}  // namespace

DataFolder::DataFolder(const std::string& path) : path_(path.empty() ? ros_folder() + "/desert_sim" : path) {}

std::string DataFolder::for_reading(const std::string& name) const {
  const fs::path relative = checked_path(name);
  try {
    const fs::path root = fs::canonical(path_);
    const fs::path file = resolve_links(root, root / relative, name);
    if (!fs::exists(file)) throw ConfigError(quoted(name) + ": no such file exists in " + root.string());
    if (!fs::is_regular_file(file)) throw ConfigError(quoted(name) + ": is not a file");
    return file.string();
  } catch (const fs::filesystem_error& e) {
    throw ConfigError(quoted(name) + ": the file system reports \"" + e.code().message() + "\" (in " + path_ +
                      ")");
  }
}

std::string DataFolder::for_writing(const std::string& name) const {
  const fs::path relative = checked_path(name);
  try {
    fs::create_directories(path_);
    fs::path folder = fs::canonical(path_);
    const fs::path root = folder;
    for (const fs::path& part : relative.parent_path()) {
      folder = resolve_links(root, folder / part, name);
      fs::create_directory(folder);
    }
    const fs::path file = resolve_links(root, folder / relative.filename(), name);
    if (fs::exists(file) && !fs::is_regular_file(file)) throw ConfigError(quoted(name) + ": is not a file");
    return file.string();
  } catch (const fs::filesystem_error& e) {
    throw ConfigError(quoted(name) + ": the file system reports \"" + e.code().message() + "\" (in " + path_ +
                      ")");
  }
}

}  // namespace desert_sim
