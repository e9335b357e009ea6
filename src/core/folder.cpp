#include "src/core/folder.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

namespace desert_sim {

namespace fs = std::filesystem;

bool is_below(const fs::path& folder, const fs::path& path) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

int open_folder_below(const fs::path& root, const fs::path& relative, MissingFolders missing) {
  constexpr int flags = O_PATH | O_DIRECTORY | O_CLOEXEC;
  int at = open(root.c_str(), flags);
  for (const fs::path& part : relative) {
    if (at < 0) break;
    if (part.empty() || part == ".") continue;
    const Descriptor parent(at);
    if (missing == MissingFolders::create && mkdirat(at, part.c_str(), 0777) != 0 && errno != EEXIST)
      return -1;
    at = openat(parent.number(), part.c_str(), flags | O_NOFOLLOW);
  }
  return at;
}

}  // namespace desert_sim
