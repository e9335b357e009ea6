#include "src/core/temporary_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <utility>

#include "src/core/error.hpp"

namespace desert_sim {

namespace {

std::string folder_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  return slash == std::string::npos ? "." : path.substr(0, slash + 1);
}

int open_folder(const std::string& folder) {
  return open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
}

const char* kind_of(mode_t mode) {
  if (S_ISDIR(mode)) return "a folder";
  if (S_ISLNK(mode)) return "a symbolic link";
  if (S_ISFIFO(mode)) return "a pipe";
  return S_ISSOCK(mode) ? "a socket" : "a device";
}

/// ".<name>.<16 random hexadecimal digits>.part".
std::string random_name(const std::string& name) {
  constexpr std::size_t longest = 200;  // file systems allow 255 bytes with what is added here
  std::uint64_t bits = 0;
  while (getrandom(&bits, sizeof bits, 0) != sizeof bits) continue;
  char random[32];
  std::snprintf(random, sizeof random, ".%016" PRIx64 ".part", bits);
  return "." + name.substr(0, longest) + random;
}

}  // namespace

// ---- TemporaryFile.

TemporaryFile::TemporaryFile(const std::string& path)
    : path_(path),
      name_(path.substr(path.rfind('/') + 1)),
      folder_(open_folder(folder_of(path))),
      temporary_name_(random_name(name_)) {
  if (folder_.number() < 0) fail("cannot be written");
  require_regular_or_free();
  file_.reset(openat(folder_.number(), temporary_name_.c_str(),
                     O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666));
  exists_ = file_.number() >= 0;
  if (!exists_) fail("cannot be written");
}

TemporaryFile::~TemporaryFile() {
  if (exists_) unlinkat(folder_.number(), temporary_name_.c_str(), 0);
}

/// Opening this link of the kernel opens the file itself, whatever has got its name in the meantime.
std::string TemporaryFile::library_path() const { return "/proc/self/fd/" + std::to_string(file_.number()); }

void TemporaryFile::write(std::string_view bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t n = ::write(file_.number(), bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail("cannot be written");
    done += static_cast<std::size_t>(n);
  }
}

void TemporaryFile::publish() {
  if (fsync(file_.number()) != 0 || !file_.close()) fail("cannot be synchronised to the disk");
  require_regular_or_free();
  if (renameat(folder_.number(), temporary_name_.c_str(), folder_.number(), name_.c_str()) != 0)
    fail("the temporary file cannot be renamed");
  exists_ = false;
  // Makes the name durable. Some file systems cannot synchronise a folder, and say so by EINVAL.
  if (fsync(folder_.number()) != 0 && errno != EINVAL)
    throw WriteError(path_ + ": its folder cannot be synchronised to the disk: " + std::strerror(errno));
}

void TemporaryFile::require_regular_or_free() const {
  if (name_.empty() || name_ == "." || name_ == "..")
    throw ConfigError("'" + path_ + "': cannot be written: it names no file");
  struct stat status;
  if (fstatat(folder_.number(), name_.c_str(), &status, AT_SYMLINK_NOFOLLOW) != 0) {
    if (errno != ENOENT) fail("cannot be written");
  } else if (!S_ISREG(status.st_mode)) {
    throw ConfigError(path_ + ": cannot be written: is " + kind_of(status.st_mode) +
                      " (allowed: a regular file, or a name that is free)");
  }
}

void TemporaryFile::fail(const char* what) const {
  const int reason = errno;
  const std::string message = path_ + ": " + what + ": " + std::strerror(reason);
  if (reason == ENOSPC || reason == EDQUOT || reason == EFBIG || reason == EIO) throw WriteError(message);
  throw ConfigError(message);
}

// ---- FolderLock.

FolderLock::FolderLock(const std::string& folder) : folder_(open_folder(folder)) {
  if (folder_.number() < 0) throw ConfigError(folder + ": cannot be opened: " + std::strerror(errno));
  while (flock(folder_.number(), LOCK_EX) != 0)
    if (errno != EINTR) throw ConfigError(folder + ": cannot be locked: " + std::strerror(errno));
}

}  // namespace desert_sim
