/// PLY and STL files: the ground alone.
#include <array>
#include <cmath>
#include <cstdint>

#include "src/export/buffered_file.hpp"
#include "src/export/mesh_files.hpp"

namespace desert_sim {

namespace {

constexpr std::size_t stl_header_size = 80;

std::string ply_header(const Snapshot& s, const render::Mesh& ground) {
  return "ply\nformat binary_little_endian 1.0\ncomment " + frame_note(s) +
         "\ncomment x is east, y is north, z is up\nelement vertex " +
         std::to_string(ground.vertices.size()) +
         "\nproperty float x\nproperty float y\nproperty float z\n"
         "property float nx\nproperty float ny\nproperty float nz\n"
         "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face " +
         std::to_string(ground.indices.size() / 3) + "\nproperty list uchar int vertex_indices\nend_header\n";
}

std::array<float, 3> normal_of(const render::Vertex& a, const render::Vertex& b, const render::Vertex& c) {
  const double u[] = {b.x - a.x, b.y - a.y, b.z - a.z}, v[] = {c.x - a.x, c.y - a.y, c.z - a.z};
  const double n[] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  return {static_cast<float>(n[0] / length), static_cast<float>(n[1] / length),
          static_cast<float>(n[2] / length)};
}

}  // namespace

void write_ply(const std::string& path, const ExportedTerrain& terrain) {
  const Snapshot& s = *terrain.snapshot;
  const render::Mesh ground = meshes_of(path, terrain).ground;
  const std::vector<render::PackedColour> colours = surface_colours(s, ground);
  BufferedFile file(path, terrain.after_piece);
  file.text(ply_header(s, ground));
  for (const render::Vertex& v : ground.vertices) {
    for (const float number : {v.x, v.y, v.z, v.normal_x, v.normal_y, v.normal_z}) file.number(number);
    const render::PackedColour colour = colours[cell_of(s, v)];
    for (int shift = 0; shift < 24; shift += 8) file.number(static_cast<std::uint8_t>(colour >> shift));
  }
  for (std::size_t n = 0; n < ground.indices.size(); n += 3) {
    file.number(std::uint8_t{3});
    for (std::size_t corner = 0; corner < 3; ++corner)
      file.number(static_cast<std::int32_t>(ground.indices[n + corner]));
  }
  file.publish();
}

void write_stl(const std::string& path, const ExportedTerrain& terrain) {
  const render::Mesh ground = meshes_of(path, terrain).ground;
  BufferedFile file(path, terrain.after_piece);
  std::string header = frame_note(*terrain.snapshot);
  header.resize(stl_header_size, ' ');
  file.text(header);
  file.number(static_cast<std::uint32_t>(ground.indices.size() / 3));
  for (std::size_t n = 0; n < ground.indices.size(); n += 3) {
    const render::Vertex* corners[3];
    for (std::size_t corner = 0; corner < 3; ++corner)
      corners[corner] = &ground.vertices[ground.indices[n + corner]];
    for (const float number : normal_of(*corners[0], *corners[1], *corners[2])) file.number(number);
    for (const render::Vertex* v : corners)
      for (const float number : {v->x, v->y, v->z}) file.number(number);
    file.number(std::uint16_t{0});
  }
  file.publish();
}

}  // namespace desert_sim
