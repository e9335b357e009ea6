#include "src/tools/drawing.hpp"

#include <filesystem>

#include "src/core/error.hpp"
#include "src/core/temporary_file.hpp"
#include "src/tools/child_process.hpp"

namespace desert_sim {

namespace {

std::string script_path(const std::string& option, const std::string& script) {
  namespace fs = std::filesystem;
  std::error_code ignored;  // a place that cannot be read counts as one without the script
  const fs::path beside = fs::read_symlink("/proc/self/exe", ignored).parent_path();
  const std::vector<fs::path> places{beside / script, fs::path(DESERT_PLOT_SCRIPTS) / script};
  for (const fs::path& place : places)
    if (fs::is_regular_file(place, ignored)) return place.string();
  throw ConfigError(option + ": its script is missing: neither " + places[0].string() + " nor " +
                    places[1].string() + " is a file");
}

}  // namespace

void run_plot_script(const std::string& option, const std::string& script, const std::string& picture,
                     const std::vector<std::string>& results) {
  TemporaryFile file(picture);
  // The script writes into the file that is open here, whatever lies under the picture's name by then.
  std::vector<std::string> words{"python3", script_path(option, script),
                                 path_for_children(file.library_path())};
  words.insert(words.end(), results.begin(), results.end());
  ChildProcess(option + " " + picture + ": " + words[1], words).finish();
  file.publish();
}

}  // namespace desert_sim
