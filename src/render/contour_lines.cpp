#include "src/render/contour_lines.hpp"

#include <cmath>
#include <utility>

namespace desert_sim::render {

namespace {

constexpr int index_line = 5;  // every fifth contour line is an index line, as on maps

Vertex between(const Vertex& a, const Vertex& b, float z, PackedColour colour) {
  const float share = (z - a.z) / (b.z - a.z);
  const auto part = [share](float from, float to) { return from + share * (to - from); };
  return {part(a.x, b.x),
          part(a.y, b.y),
          z,
          part(a.normal_x, b.normal_x),
          part(a.normal_y, b.normal_y),
          part(a.normal_z, b.normal_z),
          colour};
}

}  // namespace

Mesh contour_lines(const Mesh& mesh, double interval, int most) {
  Mesh lines;
  if (!(interval > 0)) return lines;
  const PackedColour fine = pack({0.20f, 0.13f, 0.08f}, 0.45f), index = pack({0.20f, 0.13f, 0.08f}, 0.9f);
  for (std::size_t n = 0; n + 2 < mesh.surface_indices; n += 3) {
    const Vertex *low = &mesh.vertices[mesh.indices[n]], *middle = &mesh.vertices[mesh.indices[n + 1]],
                 *high = &mesh.vertices[mesh.indices[n + 2]];
    if (middle->z < low->z) std::swap(low, middle);
    if (high->z < middle->z) std::swap(middle, high);
    if (middle->z < low->z) std::swap(low, middle);
    // A level at a corner belongs to the triangles above it, so that no line is drawn twice.
    double step = interval;
    if ((high->z - low->z) / step > most) step *= index_line;
    if ((high->z - low->z) / step > most) continue;
    for (double number = std::ceil(low->z / step); number * step < high->z; ++number) {
      const float z = static_cast<float>(number * step);
      if (!(z >= low->z && z < high->z)) continue;
      const bool is_index = step > interval || std::fmod(number, index_line) == 0;
      const bool below_middle = z < middle->z;
      const Vertex& from = below_middle ? *low : *middle;
      const Vertex& to = below_middle ? *middle : *high;
      for (const Vertex& end : {between(*low, *high, z, is_index ? index : fine),
                                between(from, to, z, is_index ? index : fine)}) {
        lines.indices.push_back(static_cast<std::uint32_t>(lines.vertices.size()));
        lines.vertices.push_back(end);
      }
    }
  }
  lines.surface_indices = lines.indices.size();
  return lines;
}

}  // namespace desert_sim::render
