#include "src/core/files.hpp"

#include <sys/stat.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>

#include "src/core/error.hpp"

namespace desert_sim {

std::string read_file(const std::string& path) {
  struct stat status;
  if (stat(path.c_str(), &status) != 0)
    throw ConfigError(path + ": cannot be opened: " + std::strerror(errno));
  if (!S_ISREG(status.st_mode)) throw ConfigError(path + ": is not a file");
  std::ifstream file(path, std::ios::binary);
  std::string bytes(static_cast<std::size_t>(status.st_size), '\0');
  if (!file || !file.read(&bytes[0], status.st_size))
    throw ConfigError(path + ": cannot be read: " + std::strerror(errno));
  return bytes;
}

void write_file(const std::string& path, const std::string& bytes) {
  const std::string temporary = path + ".part";
  std::ofstream file(temporary, std::ios::binary);
  file << bytes;
  file.close();
  if (!file || std::rename(temporary.c_str(), path.c_str()) != 0)
    throw Error(path + ": cannot be written: " + std::strerror(errno));
}

}  // namespace desert_sim
