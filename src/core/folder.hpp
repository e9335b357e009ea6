#pragma once
/// Folders that are opened step by step, so that nobody can put a link in the way.

#include <filesystem>

#include "src/core/descriptor.hpp"

namespace desert_sim {

/// Whether `path` is `folder` or lies below it, by their names alone: links are not followed.
bool is_below(const std::filesystem::path& folder, const std::filesystem::path& path);

enum class MissingFolders { refuse, create };

/// Opens (O_PATH) the folder `relative` below `root`, one folder after the other and without following links
/// below `root`, whose own path is trusted. The number is negative, with the reason in errno, if that cannot
/// be done: ELOOP or ENOTDIR where a part is a link.
int open_folder_below(const std::filesystem::path& root, const std::filesystem::path& relative,
                      MissingFolders missing = MissingFolders::refuse);

}  // namespace desert_sim
