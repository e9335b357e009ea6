#pragma once
/// The files that some formats consist of besides the one that is named.

#include <string>

namespace desert_sim {

constexpr const char *obj_materials = ".mtl", *obj_picture = "_ground.png";
constexpr const char *world_heights = "_heights.tif", *world_picture = "_surface.png";

/// out/dune.obj, ".mtl": out/dune.mtl.
inline std::string name_beside(const std::string& path, const std::string& end) {
  return path.substr(0, path.rfind('.')) + end;
}

}  // namespace desert_sim
