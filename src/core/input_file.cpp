#include "src/core/input_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "src/core/error.hpp"
#include "src/core/folder.hpp"
#include "src/core/near_name.hpp"
#include "src/core/quoted.hpp"

namespace desert_sim {

namespace fs = std::filesystem;

namespace {

// Without O_NONBLOCK, opening a FIFO would wait for a writer.
constexpr int reading = O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC;

[[noreturn]] void throw_error(const std::string& path, int error) {
  throw ConfigError(path + ": " +
                    (error == ENOENT ? "no such file exists" + near_name(path)
                                     : std::string("cannot be opened: ") + std::strerror(error)));
}

/// Opens a file below `folder`, whose own path is trusted.
int open_below(const std::string& folder, const std::string& path) {
  std::error_code error;
  const fs::path root = fs::canonical(folder, error);
  if (error) throw_error(folder, error.value());
  const fs::path file = fs::canonical(path, error);
  // The reason why a file outside cannot be opened would tell something about it.
  const fs::path known = error ? fs::absolute(path).lexically_normal() : file;
  if (!is_below(root, known) && !is_below(fs::absolute(folder).lexically_normal(), known)) {
    // Whether the working folder has a file of this name is not told either.
    const fs::path relative = fs::path(path).lexically_normal();
    if (relative.is_relative() && *relative.begin() != "..")
      throw ConfigError(in_quotes(path) + ": no such file exists below " + root.string() +
                        near_name(root / relative));
    throw ConfigError(in_quotes(path) + ": is not below " + root.string());
  }
  if (error) throw_error(path, error.value());
  const auto check_opened = [&path](int opened) {
    // ENOTDIR and ELOOP: a link has come in the way after the links were followed.
    if (opened < 0 && (errno == ELOOP || errno == ENOTDIR))
      throw ConfigError(in_quotes(path) + ": was replaced by a symbolic link while it was opened");
    if (opened < 0) throw_error(path, errno);
    return opened;
  };
  const fs::path relative = file.lexically_relative(root);
  const Descriptor parent(check_opened(open_folder_below(root, relative.parent_path())));
  return check_opened(openat(parent.number(), relative.filename().c_str(), reading | O_NOFOLLOW));
}

}  // namespace

InputFile::InputFile(const std::string& path, const std::string& folder)
    : path_(path), file_(folder.empty() ? open(path.c_str(), reading) : open_below(folder, path)) {
  if (file_.number() < 0) throw_error(path, errno);
  struct stat status;
  if (fstat(file_.number(), &status) != 0) throw_error(path, errno);
  if (!S_ISREG(status.st_mode)) throw ConfigError(path + ": is not a regular file");
  size_ = static_cast<std::uint64_t>(status.st_size);
}

std::string InputFile::descriptor_path() const { return "/proc/self/fd/" + std::to_string(file_.number()); }

std::size_t InputFile::read(std::uint64_t offset, void* to, std::size_t bytes) const {
  std::size_t done = 0;
  while (done < bytes) {
    const ssize_t n =
        pread(file_.number(), static_cast<char*>(to) + done, bytes - done, static_cast<off_t>(offset + done));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw ConfigError(path_ + ": cannot be read: " + std::strerror(errno));
    if (n == 0) break;
    done += static_cast<std::size_t>(n);
  }
  return done;
}

std::string InputFile::read_all() const {
  std::string bytes(static_cast<std::size_t>(size_), '\0');
  if (read(0, bytes.data(), bytes.size()) < bytes.size())
    throw ConfigError(path_ + ": cannot be read: it has become shorter");
  return bytes;
}

}  // namespace desert_sim
