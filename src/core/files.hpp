#pragma once
/// Reading and writing of whole files.

#include <string>

namespace desert_sim {

/// The content of a regular file; with a `folder`, only of one below it. Throws ConfigError as InputFile
/// does.
std::string read_file(const std::string& path, const std::string& folder = "");

/// Writes a file atomically and durably, through a TemporaryFile, so that `path` is always either the old or
/// the new file. Throws what TemporaryFile throws; nothing is then left.
void write_file(const std::string& path, const std::string& bytes);

/// Throws ConfigError unless write_file() can write `path` at present: its folder exists and can be written
/// to, and `path` is a regular file or does not exist. For checks before a long run.
void require_writable_file(const std::string& path);

/// Whether both paths lead to one file, or would if it existed: their links are followed.
bool same_file(const std::string& a, const std::string& b);

}  // namespace desert_sim
