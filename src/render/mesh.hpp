#pragma once
/// What a graphics card draws: vertices with normals and colours, and triangles or lines between them.

#include <cstdint>
#include <vector>

#include "src/render/colour.hpp"
#include "src/render/view.hpp"

namespace desert_sim::render {

struct Vertex {
  float x, y, z;
  float normal_x, normal_y, normal_z;
  PackedColour colour;
};

struct Mesh {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t>
      indices;  ///< three for each triangle, counter-clockwise as seen from outside; two for each line
  std::size_t surface_indices =
      0;  ///< The first so many belong to the surface, the others to skirts and walls.

  bool empty() const { return indices.empty(); }
};

/// The smallest box around all vertices; all 0 without any.
Box bounding_box(const Mesh& mesh);

}  // namespace desert_sim::render
