#include "src/tools/drawing.hpp"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>

#include "src/core/error.hpp"
#include "src/core/temporary_file.hpp"

extern char** environ;

namespace desert_sim {

namespace {

std::string script_path(const std::string& option, const std::string& script) {
  namespace fs = std::filesystem;
  std::error_code ignored;  // a place that cannot be read counts as one without the script
  const fs::path beside = fs::read_symlink("/proc/self/exe", ignored).parent_path();
  const std::vector<fs::path> places{beside / script, fs::path(DESERT_BENCH_SCRIPTS) / script};
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
  const std::string place = "/proc/" + std::to_string(getpid()) + file.library_path().substr(std::strlen("/proc/self"));
  std::vector<std::string> words{"python3", script_path(option, script), place};
  words.insert(words.end(), results.begin(), results.end());
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = 0;
  const int failure = posix_spawnp(&child, "python3", nullptr, nullptr, arguments.data(), environ);
  if (failure != 0) throw ConfigError(option + ": python3: " + std::strerror(failure));
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw ConfigError(option + " " + picture + ": " + words[1] + " failed");
  file.publish();
}

}  // namespace desert_sim
