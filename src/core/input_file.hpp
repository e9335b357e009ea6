#pragma once
/// Files that are open for reading.

#include <cstdint>
#include <string>

#include "src/core/descriptor.hpp"

namespace desert_sim {

/// A regular file that is open for reading. What is read comes from the file that was opened, whatever
/// becomes of its name.
class InputFile {
 public:
  /// Opens the file `path` without waiting for anybody, whatever lies there. With a `folder`, the file, its
  /// links followed, must lie below it: it is then opened folder by folder without following links, so that a
  /// link that somebody puts in the way meanwhile is refused too. Throws ConfigError if the file is missing,
  /// is not a regular file, lies outside the folder, or cannot be opened.
  explicit InputFile(const std::string& path, const std::string& folder = "");

  const std::string& path() const { return path_; }
  std::uint64_t size() const { return size_; }  ///< when it was opened [bytes]
  /// The open file as a path, for libraries that only take paths; valid as long as this object.
  std::string descriptor_path() const;
  /// Copies up to `bytes` bytes from `offset` on, and returns how many; fewer at the end of the file. Throws
  /// ConfigError if they cannot be read.
  std::size_t read(std::uint64_t offset, void* to, std::size_t bytes) const;
  /// The first size() bytes. Throws ConfigError if they cannot be read or are there no longer.
  std::string read_all() const;

 private:
  const std::string path_;
  Descriptor file_;
  std::uint64_t size_ = 0;
};

}  // namespace desert_sim
