#include "src/scenario/scenario_file.hpp"

#include <algorithm>
#include <filesystem>
#include <vector>

#include "src/core/did_you_mean.hpp"
#include "src/core/error.hpp"
#include "src/core/joined.hpp"
#include "src/core/package_folder.hpp"
#include "src/core/quoted.hpp"

namespace desert_sim {

namespace fs = std::filesystem;

namespace {

bool ends_with(const std::string& text, const std::string& ending) {
  return text.size() >= ending.size() &&
         text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

/// The file of a saved scenario in a folder; empty if there is none.
std::string saved_scenario_in(const std::string& folder) {
  const fs::path file = fs::path(folder) / saved_scenario_file;
  std::error_code error;
  return fs::is_regular_file(file, error) ? file.string() : "";
}

}  // namespace

const std::string& installed_scenario_folder() {
  static const std::string folder = [] {
    const std::string& package = package_folder();
    std::error_code error;
    const fs::path found =
        package.empty() ? fs::path() : fs::canonical(fs::path(package) / "config" / "scenarios", error);
    return error ? std::string() : found.string();
  }();
  return folder;
}

std::vector<std::string> installed_scenarios() {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator entry(installed_scenario_folder(), error), end; !error && entry != end;
       entry.increment(error))
    if (entry->path().extension() == ".yaml") names.push_back(entry->path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string installed_scenario_file(const std::string& name) {
  const std::vector<std::string> names = installed_scenarios();
  const auto found = std::find_if(names.begin(), names.end(), [&name](const std::string& known) {
    return name == known || name == installed_scenario_uri(known);
  });
  return found == names.end() ? "" : (fs::path(installed_scenario_folder()) / (*found + ".yaml")).string();
}

std::string two_meanings(const std::string& name, const std::string& other) {
  return in_quotes(name) +
         " is the name of an installed scenario and of a file (allowed: " + in_quotes(other) +
         " for the file, " + in_quotes(installed_scenario_uri(name)) + " for the installed one)";
}

std::string scenario_file(const std::string& name) {
  if (const std::string file = installed_scenario_file(name); !file.empty()) return file;
  if (name.rfind(installed_scenario_start, 0) != 0 &&
      (name.find('/') != std::string::npos || ends_with(name, ".yaml") || ends_with(name, ".yml"))) {
    const std::string saved = saved_scenario_in(name);
    return saved.empty() ? name : saved;
  }
  if (installed_scenario_folder().empty())
    throw ConfigError(
        "scenario '" + name +
        "' is not a path, and the package desert_sim is not in ROS_PACKAGE_PATH (setup.bash of its "
        "workspace puts it there)");
  const std::string all = joined(installed_scenarios());
  throw ConfigError("no scenario '" + name + "' exists in " + installed_scenario_folder() +
                    " (known: " + all + ")" + did_you_mean(name, all));
}

std::string scenario_argument(const std::string& argument) {
  std::error_code error;
  if (fs::is_regular_file(argument, error)) return argument;
  const std::string saved = saved_scenario_in(argument);
  if (saved.empty()) return scenario_file(argument);
  if (!installed_scenario_file(argument).empty())
    throw ConfigError("scenario " + two_meanings(argument, saved));
  return saved;
}

}  // namespace desert_sim
