#include "src/core/files.hpp"

#include <filesystem>

#include "src/core/input_file.hpp"
#include "src/core/temporary_file.hpp"

namespace desert_sim {

std::string read_file(const std::string& path, const std::string& folder) {
  return InputFile(path, folder).read_all();
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
