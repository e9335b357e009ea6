#pragma once
/// Help with paths that lead nowhere.

#include <filesystem>
#include <string>

namespace desert_sim {

/// "; did you mean 'terrain-sand.tif'?" of the first part of a path that does not exist, where the folder
/// before it has a name that is a typing error away from it or contains it; else empty.
std::string near_name(const std::filesystem::path& missing);

}  // namespace desert_sim
