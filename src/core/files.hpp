#pragma once
/// Whole files.

#include <string>

namespace desert_sim {

/// Throws ConfigError if it is missing, is no regular file, or cannot be read.
std::string read_file(const std::string& path);

/// Writes to a temporary name beside it and renames, so that a file of that name is the old or the new one.
/// Throws Error.
void write_file(const std::string& path, const std::string& bytes);

}  // namespace desert_sim
