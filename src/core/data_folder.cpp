#include "src/core/data_folder.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>

#include "src/core/folder.hpp"
#include "src/core/near_name.hpp"
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

/// `path` is `root / name` with its links followed.
void require_below(const fs::path& root, const fs::path& path, const std::string& name) {
  if (!is_below(root, path))
    throw ConfigError(in_quotes(name) + ": a symbolic link points outside the folder " + root.string());
}

}  // namespace

DataFolder::DataFolder(const std::string& path) : path_(path.empty() ? ros_folder() + "/desert_sim" : path) {}

std::string DataFolder::for_reading(const std::string& name) const {
  const fs::path relative = checked_path(name);
  try {
    const fs::path root = fs::canonical(path_);
    const fs::path file = fs::weakly_canonical(root / relative);
    require_below(root, file, name);
    if (!fs::exists(file))
      throw ConfigError(in_quotes(name) + ": no such file exists in " + root.string() + near_name(file));
    if (!fs::is_regular_file(file)) throw ConfigError(in_quotes(name) + ": is not a file");
    return file.string();
  } catch (const fs::filesystem_error& e) {
    throw ConfigError(in_quotes(name) + ": the file system reports \"" + e.code().message() + "\" (in " +
                      path_ + ")");
  }
}

bool DataFolder::has_file(const std::string& name) const {
  try {
    return !for_reading(name).empty();
  } catch (const ConfigError&) {
    return false;
  }
}

bool DataFolder::has_folder(const std::string& name) const {
  try {
    const fs::path root = fs::canonical(path_), folder = fs::weakly_canonical(root / checked_path(name));
    require_below(root, folder, name);
    return fs::is_directory(folder);
  } catch (const ConfigError&) {
  } catch (const fs::filesystem_error&) {
  }
  return false;
}

void DataFolder::require_name(const std::string& name) { checked_path(name); }

WritableFile DataFolder::for_writing(const std::string& name) const {
  const fs::path relative = checked_path(name);
  try {
    fs::create_directories(path_);
    const fs::path root = fs::canonical(path_);
    const fs::path file = fs::weakly_canonical(root / relative);
    require_below(root, file, name);
    if (fs::is_symlink(file))  // all others have been followed
      throw ConfigError(in_quotes(name) + ": is a symbolic link that leads nowhere");
    const fs::path folder = file.parent_path();
    auto opened = std::make_shared<const Descriptor>(
        open_folder_below(root, folder.lexically_relative(root), MissingFolders::create));
    if (opened->number() < 0)
      throw fs::filesystem_error("", folder, std::error_code(errno, std::generic_category()));
    if (fs::exists(file) && !fs::is_regular_file(file))
      throw ConfigError(in_quotes(name) + ": is not a file");
    return {file.string(), std::move(opened)};
  } catch (const fs::filesystem_error& e) {
    throw ConfigError(in_quotes(name) + ": the file system reports \"" + e.code().message() + "\" (in " +
                      path_ + ")");
  }
}

// ---- WritableFile.

WritableFile::WritableFile(std::string path, std::shared_ptr<const Descriptor> folder)
    : path_(std::move(path)), folder_(std::move(folder)) {}

/// Opening this link of the kernel opens the folder itself, whatever has got its name in the meantime.
std::string WritableFile::folder_link() const { return "/proc/self/fd/" + std::to_string(folder_->number()); }

std::string WritableFile::path_through_folder() const {
  return folder_link() + path_.substr(path_.rfind('/'));
}

std::string WritableFile::with_known_path(std::string message) const {
  const std::string link = folder_link(), known = path_.substr(0, path_.rfind('/'));
  for (std::size_t at = message.find(link); at != std::string::npos;
       at = message.find(link, at + known.size()))
    message.replace(at, link.size(), known);
  return message;
}

}  // namespace desert_sim
