#include "src/export/export_formats.hpp"

#include <algorithm>
#include <filesystem>

#include "src/core/did_you_mean.hpp"
#include "src/core/error.hpp"
#include "src/core/files.hpp"
#include "src/core/joined.hpp"
#include "src/core/quoted.hpp"
#include "src/export/height_files.hpp"
#include "src/export/mesh_files.hpp"
#include "src/export/names_beside.hpp"

namespace desert_sim {

const std::vector<ExportFormat>& export_formats() {
  static const std::vector<ExportFormat> formats = [] {
    std::vector<ExportFormat> all;
    all.push_back({".ply", "binary mesh of the ground with colours", {}, true, write_ply});
    all.push_back({".stl", "binary mesh of the ground", {}, true, write_stl});
#if DESERT_WITH_TINYGLTF
    all.push_back({".glb", "binary glTF of ground, water and plants", {}, true, write_glb});
#endif
#if DESERT_WITH_IO
    all.push_back({".obj",
                   "mesh of ground, water and plants, with .mtl and _ground.png",
                   {obj_materials, obj_picture},
                   true,
                   write_obj});
    all.push_back({".exr", "elevation as floats", {}, false, write_elevation_exr});
    all.push_back({".png", "elevation in 16 bits, a square of 2^n + 1 pixels", {}, false, write_height_png});
    all.push_back({".world",
                   "Gazebo 11, with _heights.tif and _surface.png",
                   {world_heights, world_picture},
                   true,
                   write_gazebo_world});
#endif
    return all;
  }();
  return formats;
}

std::string describe_export_formats() {
  return joined(export_formats(), [](const ExportFormat& format) {
    return std::string(format.ending) + " (" + format.what + ")";
  });
}

const ExportFormat& export_format(const std::string& path) {
  const std::string ending = std::filesystem::path(path).extension().string();
  const auto found = std::find_if(export_formats().begin(), export_formats().end(),
                                  [&](const ExportFormat& format) { return ending == format.ending; });
  if (found != export_formats().end()) return *found;
  const std::string known =
      joined(export_formats(), [](const ExportFormat& format) { return std::string(format.ending); });
  throw ConfigError(path + ": " +
                    (ending.empty() ? "has no ending" : in_quotes(ending) + " is not an ending") +
                    " that this build exports (allowed: " + known + ")" + did_you_mean(ending, known));
}

std::vector<std::string> exported_files(const std::string& path) {
  std::vector<std::string> files{path};
  for (const std::string& end : export_format(path).beside) files.push_back(name_beside(path, end));
  return files;
}

void require_exportable(const std::string& path, int width, int height,
                        const std::vector<std::string>& inputs) {
  if (export_format(path).has_surface) require_surface(path, width, height);
  for (const std::string& file : exported_files(path)) {
    for (const std::string& input : inputs)
      if (same_file(file, input))
        throw ConfigError(path + ": would replace " + input +
                          ", which the run reads (allowed: another name)");
    require_writable_file(file);
  }
}

void export_terrain(const std::string& path, const ExportedTerrain& terrain) {
  export_format(path).write(path, terrain);
}

}  // namespace desert_sim
