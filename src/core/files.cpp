#include "src/core/files.hpp"

#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "src/core/error.hpp"
#include "src/core/temporary_file.hpp"

namespace desert_sim {

std::string read_file(const std::string& path) {
  struct stat status;
  if (stat(path.c_str(), &status) != 0)
    throw ConfigError(path + ": cannot be opened: " + std::strerror(errno));
  if (!S_ISREG(status.st_mode)) throw ConfigError(path + ": is not a regular file");
  std::ifstream file(path, std::ios::binary);
  std::string bytes(static_cast<std::size_t>(status.st_size), '\0');
  if (!file || !file.read(&bytes[0], status.st_size))
    throw ConfigError(path + ": cannot be read: " + std::strerror(errno));
  return bytes;
}

void write_file(const std::string& path, const std::string& bytes) {
  TemporaryFile file(path);
  file.write(bytes);
  file.publish();
}

void require_writable_file(const std::string& path) { const TemporaryFile probe(path); }

bool same_file(const std::string& a, const std::string& b) {
  namespace fs = std::filesystem;
  std::error_code missing;
  if (fs::equivalent(a, b, missing)) return true;
  return fs::weakly_canonical(fs::absolute(a)) == fs::weakly_canonical(fs::absolute(b));
}

}  // namespace desert_sim
