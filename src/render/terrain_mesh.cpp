#include "src/render/terrain_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "src/render/sunlight.hpp"
#include "src/render/terrain_colours.hpp"

namespace desert_sim::render {

namespace {

constexpr std::uint32_t no_vertex = std::numeric_limits<std::uint32_t>::max();
constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

/// The cells from `first` to `last` that are vertices: every stride-th, and the last one.
std::vector<int> vertex_cells(int first, int last, int stride) {
  std::vector<int> cells;
  for (int cell = first; cell < last; cell += stride) cells.push_back(cell);
  cells.push_back(last);
  return cells;
}

class BlockBuilder {
 public:
  BlockBuilder(const BlockLayout& layout, int block, int level, double cell_size, const CellWindow& surface,
               const CellColour& colour, float base, const CellRectangle& hole)
      : surface_(surface),
        colour_(colour),
        cell_size_(static_cast<float>(cell_size)),
        base_(base),
        hole_(hole),
        stride_(1 << level),
        cells_(layout.vertices(block)),
        columns_(vertex_cells(cells_.x, cells_.right() - 1, stride_)),
        rows_(vertex_cells(cells_.y, cells_.top() - 1, stride_)) {}

  Mesh build(const BlockLayout::Neighbours& neighbours) {
    add_vertices();
    add_surface();
    mesh_.surface_indices = mesh_.indices.size();
    if (mesh_.empty()) return std::move(mesh_);
    const std::size_t last_column = columns_.size() - 1, last_row = rows_.size() - 1;
    // Along each edge in the direction that has the block on its left.
    add_edge(neighbours.south, true, 0, -1, [](std::size_t n) { return std::pair(n, std::size_t{0}); });
    add_edge(neighbours.east, false, 1, 0, [&](std::size_t n) { return std::pair(last_column, n); });
    add_edge(neighbours.north, true, 0, 1,
             [&](std::size_t n) { return std::pair(last_column - n, last_row); });
    add_edge(neighbours.west, false, -1, 0,
             [&](std::size_t n) { return std::pair(std::size_t{0}, last_row - n); });
    return std::move(mesh_);
  }

 private:
  float difference(int x, int y, int step_x, int step_y) const {
    const float here = surface_.at(x, y), before = surface_.at(x - step_x, y - step_y),
                after = surface_.at(x + step_x, y + step_y);
    const float step = cell_size_ * static_cast<float>(step_x + step_y);
    if (std::isnan(before)) return std::isnan(after) ? 0.0f : (after - here) / step;
    return std::isnan(after) ? (here - before) / step : (after - before) / (2 * step);
  }

  void add_vertices() {
    numbers_.reserve(columns_.size() * rows_.size());
    mesh_.vertices.reserve(columns_.size() * rows_.size());
    for (const int y : rows_)
      for (const int x : columns_) {
        const float z = surface_.at(x, y);
        if (std::isnan(z)) {
          numbers_.push_back(no_vertex);
          continue;
        }
        const float dz_dx = difference(x, y, stride_, 0), dz_dy = difference(x, y, 0, stride_);
        const float up = 1 / std::sqrt(1 + dz_dx * dz_dx + dz_dy * dz_dy);
        numbers_.push_back(static_cast<std::uint32_t>(mesh_.vertices.size()));
        mesh_.vertices.push_back({(static_cast<float>(x) + 0.5f) * cell_size_,
                                  (static_cast<float>(y) + 0.5f) * cell_size_, z, -dz_dx * up, -dz_dy * up,
                                  up, colour_(x, y, -dz_dx * up, -dz_dy * up, up)});
      }
  }

  std::uint32_t number(std::size_t column, std::size_t row) const {
    return numbers_[row * columns_.size() + column];
  }

  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    for (const std::uint32_t corner : {a, b, c}) mesh_.indices.push_back(corner);
  }

  /// Whether all between these columns and rows lies in the hole.
  bool in_hole(int west, int east, int south, int north) const {
    return hole_.contains(west, south) && hole_.contains(east, north);
  }

  /// How different two vertices look.
  int contrast(std::uint32_t a, std::uint32_t b) const {
    int sum = 0;
    for (int shift = 0; shift < 24; shift += 8)
      sum += std::abs(static_cast<int>(mesh_.vertices[a].colour >> shift & 255) -
                      static_cast<int>(mesh_.vertices[b].colour >> shift & 255));
    return sum;
  }

  /// Two triangles for each quad of known vertices, one where a single vertex is unknown. A quad is divided
  /// along the diagonal whose ends look more alike, so that crests, edges of sand and shadows do not become
  /// saws.
  void add_surface() {
    mesh_.indices.reserve(6 * columns_.size() * rows_.size());
    for (std::size_t row = 0; row + 1 < rows_.size(); ++row)
      for (std::size_t column = 0; column + 1 < columns_.size(); ++column) {
        if (in_hole(columns_[column], columns_[column + 1], rows_[row], rows_[row + 1])) continue;
        const std::uint32_t ring[4] = {number(column, row), number(column + 1, row),
                                       number(column + 1, row + 1), number(column, row + 1)};
        std::uint32_t known[4];
        std::size_t count = 0;
        for (const std::uint32_t corner : ring)
          if (corner != no_vertex) known[count++] = corner;
        if (count == 4 && contrast(known[1], known[3]) < contrast(known[0], known[2]))
          std::rotate(known, known + 1, known + 4);
        if (count >= 3) add_triangle(known[0], known[1], known[2]);
        if (count == 4) add_triangle(known[0], known[2], known[3]);
      }
  }

  /// A skirt where there is a neighbour, else a wall, which looks to (normal_x, normal_y). `at(n)` is the
  /// column and row of the n-th vertex along the edge.
  template <class At>
  void add_edge(bool has_neighbour, bool along_x, float normal_x, float normal_y, const At& at) {
    const std::size_t count = along_x ? columns_.size() : rows_.size();
    if (has_neighbour)
      add_strip(count, at, [&](Vertex v, int x, int y) {
        Vertex below = v;
        below.z = lowest_near(x, y, along_x);
        return std::pair(v, below);
      });
    else if (!std::isnan(base_))
      add_strip(count, at, [&](Vertex v, int, int) {
        v.normal_x = normal_x;
        v.normal_y = normal_y;
        v.normal_z = 0;
        v.colour = pack(lit(cut_colour, mix({1, 1, 1}, illumination(normal_x, normal_y, 0), 0.5f)));
        Vertex below = v;
        below.z = std::fmin(v.z, base_);
        return std::pair(v, below);
      });
  }

  /// A vertical strip from an edge downwards. `ends(vertex, x, y)` are its upper and lower vertex below one
  /// of the surface, of cell (x, y).
  template <class At, class Ends>
  void add_strip(std::size_t count, const At& at, const Ends& ends) {
    std::uint32_t top_before = no_vertex;
    int x_before = -1, y_before = -1;
    for (std::size_t n = 0; n < count; ++n) {
      const auto [column, row] = at(n);
      const int x = columns_[column], y = rows_[row];
      std::uint32_t top = no_vertex;
      if (number(column, row) != no_vertex) {
        top = static_cast<std::uint32_t>(mesh_.vertices.size());
        const auto [upper, lower] = ends(mesh_.vertices[number(column, row)], x, y);
        mesh_.vertices.push_back(upper);
        mesh_.vertices.push_back(lower);
        const bool cut_out = in_hole(std::min(x, x_before), std::max(x, x_before), std::min(y, y_before),
                                     std::max(y, y_before));
        if (top_before != no_vertex && !cut_out) {
          add_triangle(top_before + 1, top + 1, top);
          add_triangle(top_before + 1, top, top_before);
        }
      }
      top_before = top;
      x_before = x;
      y_before = y;
    }
  }

  /// The lowest known cell of the block's edge in the quads of the coarsest level that have this cell.
  /// Vertices of all levels lie on the ends of these, so that what any level draws of the edge there is no
  /// lower.
  float lowest_near(int x, int y, bool along_x) const {
    constexpr int longest = 1 << BlockLayout::max_level;
    const int begin = along_x ? cells_.x : cells_.y, end = (along_x ? cells_.right() : cells_.top()) - 1;
    const int place = (along_x ? x : y) - begin;
    const int first = begin + std::max(0, (place - 1) / longest * longest);
    const int last = std::min(end, begin + (place / longest + 1) * longest);
    float z = std::numeric_limits<float>::infinity();
    for (int cell = first; cell <= last; ++cell)
      z = std::fmin(z, along_x ? surface_.at(cell, y) : surface_.at(x, cell));
    return z;
  }

  const CellWindow& surface_;
  const CellColour& colour_;
  const float cell_size_, base_;
  const CellRectangle hole_;
  const int stride_;
  const CellRectangle cells_;
  const std::vector<int> columns_, rows_;
  std::vector<std::uint32_t> numbers_;  ///< of the vertices, row by row
  Mesh mesh_;
};

}  // namespace

Mesh build_block(const BlockLayout& layout, int block, int level, double cell_size, const CellWindow& surface,
                 const CellColour& colour, float base, const CellRectangle& hole) {
  return BlockBuilder(layout, block, level, cell_size, surface, colour, base, hole)
      .build(layout.neighbours(block));
}

CellWindow water_surface(const CellWindow& ground, const CellWindow& depth, int level) {
  const CellRectangle& cells = depth.cells();
  const int stride = 1 << level;
  const auto level_at = [&](int x, int y) {
    const float d = depth.at(x, y);
    return d > least_water_depth ? ground.at(x, y) + d : unknown;
  };
  std::vector<float> surface;
  surface.reserve(static_cast<std::size_t>(cells.width) * static_cast<std::size_t>(cells.height));
  for (int y = cells.y; y < cells.top(); ++y)
    for (int x = cells.x; x < cells.right(); ++x) {
      float z = level_at(x, y);
      if (std::isnan(z)) {
        for (int dy = -stride; dy <= stride; dy += stride)
          for (int dx = -stride; dx <= stride; dx += stride) z = std::fmin(z, level_at(x + dx, y + dy));
        if (!std::isnan(z)) z = std::fmin(z, ground.at(x, y));
      }
      surface.push_back(z);
    }
  return {cells, std::move(surface)};
}

Box bounding_box(const Mesh& mesh) {
  if (mesh.vertices.empty()) return Box(Point::Zero(), Point::Zero());
  Box box;
  for (const Vertex& v : mesh.vertices) box.extend(Eigen::Vector3f(v.x, v.y, v.z).cast<double>());
  return box;
}

}  // namespace desert_sim::render
