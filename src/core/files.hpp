#pragma once
/// Whole files.

#include <string>

namespace desert_sim {

/// Throws ConfigError if it is missing, is no regular file, or cannot be read.
std::string read_file(const std::string& path);

}  // namespace desert_sim
