#include "src/render/near_ground.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "src/render/ground_painter.hpp"
#include "src/render/sunlight.hpp"

namespace desert_sim::render {

namespace {

constexpr int points_in_a_row = 160;  // in a row, if a cell has fewer
constexpr int most_divisions = 201;   // of a cell
constexpr double finest = 0.005;      // between points [m]
constexpr float rim = 0.1f;           // of the width, over which micro-relief fades

/// Cells around a place along an axis, within those that have neighbours on both sides.
void choose_cells(double place, int count, int wanted, int& first, int& number) {
  const int step = std::max(1, wanted / 4);
  number = std::min(wanted, count - 2);
  const double middle = std::clamp(std::floor(place / step) * step, 0.0, double{1} * count);
  first = std::clamp(static_cast<int>(middle) - (number - 1) / 2, 1, count - 1 - number);
}

/// Where a point lies among four cells, and what it takes of each of them.
struct Between {
  int x, y;           ///< the south-western one
  float east, north;  ///< shares

  template <class Value>
  auto of(const Value& value) const {
    return mix(mix(value(x, y), value(x + 1, y), east), mix(value(x, y + 1), value(x + 1, y + 1), east),
               north);
  }

 private:
  static float mix(float a, float b, float share) { return a + share * (b - a); }
  static Colour mix(const Colour& a, const Colour& b, float share) { return render::mix(a, b, share); }
};

class NearGroundBuilder {
 public:
  NearGroundBuilder(const NearGround& near, const TerrainGrid& grid, const LayerWindow& window,
                    const TerrainLook& look)
      : near_(near),
        cell_size_(static_cast<float>(grid.cell_size)),
        look_(look),
        whole_{0, 0, grid.layout.width(), grid.layout.height()},
        elevation_(window("elevation", seen(grid))),
        painter_(grid, near.cells, elevation_, window, look),
        offsets_(near.heights.size()) {}

  Mesh build() {
    find_offsets();
    for (int row = 0; row < near_.rows(); ++row)
      for (int column = 0; column < near_.columns(); ++column) add_vertex(column, row);
    for (int row = 0; row + 1 < near_.rows(); ++row)
      for (int column = 0; column + 1 < near_.columns(); ++column) add_quad(column, row);
    mesh_.surface_indices = mesh_.indices.size();
    return std::move(mesh_);
  }

 private:
  CellRectangle seen(const TerrainGrid& grid) const {
    CellRectangle cells = cells_that_shade(near_.cells, grid.shadow_reach);
    cells.include(near_.cells.grown(1));
    return cells.clipped(whole_);
  }
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(near_.columns()) +
           static_cast<std::size_t>(column);
  }
  Between between(int column, int row) const {
    const auto along = [this](int n, int first, int cells, int& cell, float& share) {
      cell = std::min(n / near_.divisions, cells - 2);
      share = static_cast<float>(n - cell * near_.divisions) / static_cast<float>(near_.divisions);
      cell += first;
    };
    Between b{};
    along(column, near_.cells.x, near_.cells.width, b.x, b.east);
    along(row, near_.cells.y, near_.cells.height, b.y, b.north);
    return b;
  }
  float ground(const Between& b) const {
    return b.of([this](int x, int y) { return elevation_.at(x, y); });
  }
  /// 0 at the edge of the window, 1 within.
  float fade(int column, int row) const {
    const auto inwards = [](int n, int last) {
      const auto span = static_cast<float>(last);
      return std::min(1.0f, static_cast<float>(std::min(n, last - n)) / std::max(1.0f, rim * span));
    };
    return smooth_step(0, 1, inwards(column, near_.columns() - 1)) *
           smooth_step(0, 1, inwards(row, near_.rows() - 1));
  }
  /// Binomial weights over five points a side: what is left are heaps, not ripples.
  float smoothed(int column, int row) const {
    constexpr float weight[] = {1, 4, 6, 4, 1};
    float sum = 0, weights = 0;
    for (int j = -2; j <= 2; ++j)
      for (int i = -2; i <= 2; ++i) {
        const int x = std::clamp(column + i, 0, near_.columns() - 1),
                  y = std::clamp(row + j, 0, near_.rows() - 1);
        const float offset = near_.heights[index(x, y)] - ground(between(x, y));
        if (std::isnan(offset)) continue;
        sum += weight[i + 2] * weight[j + 2] * offset;
        weights += weight[i + 2] * weight[j + 2];
      }
    return weights > 0 ? sum / weights : 0.0f;
  }
  void find_offsets() {
    for (int row = 0; row < near_.rows(); ++row)
      for (int column = 0; column < near_.columns(); ++column) {
        const float offset = near_.ripples ? near_.heights[index(column, row)] - ground(between(column, row))
                                           : smoothed(column, row);
        offsets_[index(column, row)] = std::isnan(offset) ? 0.0f : offset * fade(column, row);
      }
  }
  /// Slope of the cells around [1], by central differences as the blocks have it.
  float slope_at(int x, int y, int step_x, int step_y) const {
    const float rise = elevation_.at(x + step_x, y + step_y) - elevation_.at(x - step_x, y - step_y);
    return std::isnan(rise) ? 0.0f : rise / (2 * cell_size_);
  }
  float slope_of_offsets(int column, int row, int step_x, int step_y) const {
    const int last_column = near_.columns() - 1, last_row = near_.rows() - 1;
    const int west = std::max(0, column - step_x), east = std::min(last_column, column + step_x),
              south = std::max(0, row - step_y), north = std::min(last_row, row + step_y);
    const float run =
        static_cast<float>(east - west + north - south) * cell_size_ / static_cast<float>(near_.divisions);
    return (offsets_[index(east, north)] - offsets_[index(west, south)]) / run;
  }

  void add_vertex(int column, int row) {
    const Between b = between(column, row);
    const float dz_dx = b.of([this](int x, int y) { return slope_at(x, y, 1, 0); }) +
                        slope_of_offsets(column, row, 1, 0),
                dz_dy = b.of([this](int x, int y) { return slope_at(x, y, 0, 1); }) +
                        slope_of_offsets(column, row, 0, 1);
    const float up = 1 / std::sqrt(1 + dz_dx * dz_dx + dz_dy * dz_dy), nx = -dz_dx * up, ny = -dz_dy * up;
    const Colour colour = b.of([&](int x, int y) { return painter_.colour(x, y, up); });
    const float sun = b.of([this](int x, int y) { return painter_.sun(x, y); }),
                day = b.of([this](int x, int y) { return painter_.day(x, y); });
    const auto place = [this](int first, int n) {
      return (static_cast<float>(first) + 0.5f +
              static_cast<float>(n) / static_cast<float>(near_.divisions)) *
             cell_size_;
    };
    const float z = ground(b) + offsets_[index(column, row)];
    known_.push_back(std::isfinite(z));
    mesh_.vertices.push_back(
        {place(near_.cells.x, column), place(near_.cells.y, row), std::isfinite(z) ? z : 0.0f, nx, ny, up,
         pack(lit(colour, painter_.light(nx, ny, up, sun, day)),
              look_.ripples ? picture_of_ripples(b, up, sun, fade(column, row)) : 1.0f)});
  }
  float picture_of_ripples(const Between& b, float normal_z, float sun, float shape) const {
    const float sand = b.of([this](int x, int y) { return painter_.sand_cover(x, y); });
    return ripples_on(sand, normal_z, sun) * (near_.ripples ? 1 - shape : 1.0f);
  }
  void add_quad(int column, int row) {
    const std::size_t corners[4] = {index(column, row), index(column + 1, row), index(column + 1, row + 1),
                                    index(column, row + 1)};
    for (const std::size_t corner : corners)
      if (!known_[corner]) return;
    for (const int n : {0, 1, 2, 0, 2, 3}) mesh_.indices.push_back(static_cast<std::uint32_t>(corners[n]));
  }

  const NearGround& near_;
  const float cell_size_;
  const TerrainLook& look_;
  const CellRectangle whole_;
  const CellWindow elevation_;
  const GroundPainter painter_;
  std::vector<float> offsets_;  ///< of the points from the surface between cells, faded [m]
  std::vector<bool> known_;     ///< whether the ground of each vertex is
  Mesh mesh_;
};

}  // namespace

NearWindow near_window(const BlockLayout& layout, double cell_size, double x, double y, double detail,
                       double ripple_wavelength) {
  const double for_ripples = std::max(ripple_wavelength / 6, finest);
  double apart = std::max(detail, finest);
  if (ripple_wavelength > 0 && apart > for_ripples && apart <= 2.5 * for_ripples) apart = for_ripples;
  const auto odd = [](double n) { return 2 * static_cast<int>(std::ceil((n - 1) / 2)) + 1; };
  NearWindow near;
  near.divisions = std::clamp(odd(std::min(cell_size / apart, double{most_divisions})), 3, most_divisions);
  near.ripples = cell_size / near.divisions <= ripple_wavelength / 4 || !(ripple_wavelength > 0);
  const bool seen = apart <= coarsest_near_ground && apart < cell_size &&
                    cell_size / near.divisions <= coarsest_near_ground;
  if (!seen || layout.width() < 4 || layout.height() < 4) return {};
  const int cells = std::max(1, points_in_a_row / near.divisions);
  int width = 0, height = 0;
  choose_cells(x / cell_size, layout.width(), cells + 1, near.cells.x, width);
  choose_cells(y / cell_size, layout.height(), cells + 1, near.cells.y, height);
  near.cells.width = width;
  near.cells.height = height;
  return near;
}

Mesh near_ground_mesh(const NearGround& near, const TerrainGrid& grid, const LayerWindow& window,
                      const TerrainLook& look) {
  if (near.empty()) return {};
  return NearGroundBuilder(near, grid, window, look).build();
}

}  // namespace desert_sim::render
