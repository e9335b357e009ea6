/// Wavefront OBJ files, with materials and the picture of the ground beside them.
#include <cstdio>
#include <filesystem>

#include "src/core/files.hpp"
#include "src/export/buffered_file.hpp"
#include "src/export/height_files.hpp"
#include "src/export/mesh_files.hpp"
#include "src/export/names_beside.hpp"
#include "src/render/terrain_colours.hpp"

namespace desert_sim {

namespace {

/// Nine digits tell every float from its neighbours.
template <class... Numbers>
std::string line_of(const char* key, const char* format, Numbers... numbers) {
  char text[160];
  std::snprintf(text, sizeof text, format, static_cast<double>(numbers)...);
  return key + std::string(text) + "\n";
}

std::string colour_line(const char* key, const render::Colour& c) {
  return line_of(key, " %.4f %.4f %.4f", c.r, c.g, c.b);
}

std::string materials(const std::string& picture, const render::Palette& palette) {
  constexpr render::Colour white{1, 1, 1};
  return "newmtl ground\n" + colour_line("Kd", white) + "map_Kd " + picture + "\n\nnewmtl water\n" +
         colour_line("Kd", render::water_colour(1, palette)) + "d 0.7\n\nnewmtl plants\n" +
         colour_line("Kd", palette.vegetation);
}

class ObjFile {
 public:
  ObjFile(const std::string& path, const ExportedTerrain& terrain)
      : file_(path, terrain.after_piece), s_(*terrain.snapshot) {}

  void text(const std::string& lines) { file_.text(lines); }
  /// A group of triangles with the material of that name; `picture`: with the places of the vertices in it.
  void add(const std::string& name, const render::Mesh& mesh, bool picture) {
    if (mesh.empty()) return;
    file_.text("\no " + name + "\nusemtl " + name + "\n");
    for (const render::Vertex& v : mesh.vertices) {
      const auto channel = [&v](int shift) { return (v.colour >> shift & 255) / 255.0; };
      file_.text(
          line_of("v", " %.9g %.9g %.9g %.4f %.4f %.4f", v.x, v.y, v.z, channel(0), channel(8), channel(16)));
    }
    if (picture)
      for (const render::Vertex& v : mesh.vertices)
        file_.text(
            line_of("vt", " %.9g %.9g", v.x / (s_.width * s_.cell_size), v.y / (s_.height * s_.cell_size)));
    for (std::size_t n = 0; n < mesh.indices.size(); n += 3) {
      std::string face = "f";
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const std::string number = std::to_string(vertices_ + mesh.indices[n + corner] + 1);
        face += " " + number + (picture ? "/" + number : "");
      }
      file_.text(face + "\n");
    }
    vertices_ += mesh.vertices.size();
  }
  void publish() { file_.publish(); }

 private:
  BufferedFile file_;
  const Snapshot& s_;
  std::size_t vertices_ = 0;  ///< so far; those of OBJ files are counted from 1 through all groups
};

}  // namespace

void write_obj(const std::string& path, const ExportedTerrain& terrain) {
  const Snapshot& s = *terrain.snapshot;
  const TerrainMeshes meshes = meshes_of(path, terrain);
  const std::string picture = name_beside(path, obj_picture), library = name_beside(path, obj_materials);
  const auto name = [](const std::string& file) { return std::filesystem::path(file).filename().string(); };
  write_colours(picture, s.width, s.height, ground_colours(s, meshes.ground));
  write_file(library, materials(name(picture), s.palette));
  ObjFile file(path, terrain);
  file.text("# " + frame_note(s) + "\n# x is east, y is north, z is up\nmtllib " + name(library) + "\n");
  file.add("ground", meshes.ground, true);
  file.add("water", meshes.water, false);
  file.add("plants", meshes.plants, false);
  file.publish();
}

}  // namespace desert_sim
