#include "src/core/files.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "src/core/error.hpp"
#include "src/core/input_file.hpp"

namespace desert_sim {

std::string read_file(const std::string& path, const std::string& folder) {
  return InputFile(path, folder).read_all();
}

namespace {

/// An open file that is written under a temporary name, and removed unless it gets its own.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& path) : path_(path), temporary_(path + ".part") {
    file_ = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (file_ < 0) fail("cannot be written");
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (file_ >= 0) close(file_);
    if (!renamed_) unlink(temporary_.c_str());
  }
  void write(const std::string& bytes) {
    for (std::size_t done = 0; done < bytes.size();) {
      const ssize_t n = ::write(file_, bytes.data() + done, bytes.size() - done);
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) fail("cannot be written");
      done += static_cast<std::size_t>(n);
    }
    if (fsync(file_) != 0) fail("cannot be synchronised to the disk");
    if (close(std::exchange(file_, -1)) != 0) fail("cannot be synchronised to the disk");
  }
  void rename() {
    if (std::rename(temporary_.c_str(), path_.c_str()) != 0) fail("the temporary file cannot be renamed");
    renamed_ = true;
  }

 private:
  [[noreturn]] void fail(const char* what) const {
    throw ConfigError(path_ + ": " + what + ": " + std::strerror(errno));
  }
  const std::string path_, temporary_;
  int file_ = -1;
  bool renamed_ = false;
};

}  // namespace

void write_file(const std::string& path, const std::string& bytes) {
  TemporaryFile file(path);
  file.write(bytes);
  file.rename();
  const std::size_t slash = path.rfind('/');
  const int folder =
      open(slash == std::string::npos ? "." : path.substr(0, slash + 1).c_str(), O_RDONLY | O_CLOEXEC);
  if (folder < 0) return;
  fsync(folder);  // makes the name durable; a file system that cannot do this still has the data
  close(folder);
}

}  // namespace desert_sim
