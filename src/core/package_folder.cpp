#include "src/core/package_folder.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

namespace desert_sim {

namespace fs = std::filesystem;

namespace {

constexpr int max_depth =
    6;  // levels of folders that are searched below an entry of the path, such as /usr/share

bool is_this_package(const fs::path& folder) {
  std::ifstream manifest(folder / "package.xml");
  std::stringstream text;
  text << manifest.rdbuf();
  return text.str().find("<name>desert_sim</name>") != std::string::npos;
}

/// The folder of this package in `folder` or below it; empty if it is not there.
std::string find_below(const fs::path& folder, int depth) {
  std::error_code error;
  if (fs::exists(folder / "CATKIN_IGNORE", error) || fs::exists(folder / "rospack_nosubdirs", error))
    return "";
  if (fs::exists(folder / "package.xml", error)) return is_this_package(folder) ? folder.string() : "";
  if (depth == max_depth) return "";
  std::vector<fs::path> below;
  for (fs::directory_iterator entry(folder, fs::directory_options::skip_permission_denied, error), end;
       !error && entry != end; entry.increment(error))
    if (entry->is_directory(error) && entry->path().filename().string()[0] != '.')
      below.push_back(entry->path());
  // The folder that has the package's name is the likeliest one; the others follow by name.
  std::sort(below.begin(), below.end(), [](const fs::path& a, const fs::path& b) {
    const bool likely_a = a.filename() == "desert_sim", likely_b = b.filename() == "desert_sim";
    return likely_a != likely_b ? likely_a : a < b;
  });
  for (const fs::path& next : below)
    if (const std::string found = find_below(next, depth + 1); !found.empty()) return found;
  return "";
}

/// The folder of desert_sim among the packages of ROS_PACKAGE_PATH, found as rospack does: entries in turn,
/// the folders below them, but not those inside packages. Empty if it is not there.
std::string find_in_package_path() {
  const char* path = std::getenv("ROS_PACKAGE_PATH");
  std::stringstream entries(path ? path : "");
  for (std::string entry; std::getline(entries, entry, ':');)
    if (!entry.empty())
      if (const std::string found = find_below(entry, 0); !found.empty()) return found;
  return "";
}

/// share/desert_sim of the prefix in which this program is installed, as bin/NAME or lib/desert_sim/NAME;
/// empty if it is not installed.
std::string find_beside_program() {
  std::error_code error;
  const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
  if (error) return "";
  for (const fs::path& prefix : {folder.parent_path(), folder.parent_path().parent_path()}) {
    const fs::path share = prefix / "share" / "desert_sim";
    if (fs::is_directory(share / "config" / "scenarios", error)) return share.string();
  }
  return "";
}

}  // namespace

const std::string& package_folder() {
  static const std::string folder = [] {
    const std::string found = find_in_package_path();
    return found.empty() ? find_beside_program() : found;
  }();
  return folder;
}

}  // namespace desert_sim
