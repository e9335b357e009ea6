#pragma once
/// Files that appear under their name when they are complete, and folders that one writer uses at a time.

#include <string>
#include <string_view>

#include "src/core/descriptor.hpp"

namespace desert_sim {

/// A file that is written under a random name in the folder of `path`, and gets the name `path` when it is
/// complete. The folder is opened once and symbolic links are not followed, so that nobody who can write to
/// the folder can have another file overwritten. The file is removed unless it has been published.
///
/// Throws ConfigError if the folder cannot be written to, or if `path` is neither a regular file nor free;
/// WriteError if the disk is full or broken.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& path);
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  /// A path under which a library can open the file until it is published.
  std::string library_path() const;
  /// Appends bytes.
  void write(std::string_view bytes);
  /// Synchronises the file to the disk and renames it to `path`, which may replace a regular file.
  void publish();

 private:
  void require_regular_or_free() const;
  [[noreturn]] void fail(const char* what) const;

  const std::string path_, name_;
  const Descriptor folder_;
  const std::string temporary_name_;
  Descriptor file_{-1};
  bool exists_ = false;  ///< under the temporary name
};

/// Holds an advisory lock (flock) on a folder, and waits for it while another process or thread has it.
/// Throws ConfigError if the folder cannot be opened or locked.
class FolderLock {
 public:
  explicit FolderLock(const std::string& folder);

 private:
  const Descriptor folder_;
};

}  // namespace desert_sim
