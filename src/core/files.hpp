#pragma once
/// Reading and writing of whole files.

#include <string>

namespace desert_sim {

/// The content of a file. Throws ConfigError if it is missing, is not a regular file, or cannot be read.
std::string read_file(const std::string& path);

/// Writes a file atomically and durably: the bytes go to a temporary file in the same folder, which is
/// synchronised to the disk and then renamed, so that `path` is always either the old or the new file. Throws
/// ConfigError if it cannot be written; the temporary file is then gone.
void write_file(const std::string& path, const std::string& bytes);

}  // namespace desert_sim
