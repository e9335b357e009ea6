#pragma once
/// Reading and writing of whole files.

#include <string>

namespace desert_sim {

/// The content of a regular file; with a `folder`, only of one below it. Throws ConfigError as InputFile
/// does.
std::string read_file(const std::string& path, const std::string& folder = "");

/// Writes a file atomically and durably: the bytes go to a temporary file in the same folder, which is
/// synchronised to the disk and then renamed, so that `path` is always either the old or the new file. Throws
/// ConfigError if it cannot be written; the temporary file is then gone.
void write_file(const std::string& path, const std::string& bytes);

}  // namespace desert_sim
