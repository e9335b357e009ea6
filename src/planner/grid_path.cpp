#include "src/planner/grid_path.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/core/elementary.hpp"

namespace desert_sim {

namespace {

double distance(const GridPoint& a, const GridPoint& b) { return elementary::hypot(b.x - a.x, b.y - a.y); }

/// Walks along a line from one border of cells to the next, in units of cells (Amanatides and Woo 1987).
class CellWalk {
 public:
  CellWalk(const GridFrame& f, const GridPoint& from, const GridPoint& to)
      : x_(along(from.x - f.origin_x, to.x - from.x, f.cell_size)),
        y_(along(from.y - f.origin_y, to.y - from.y, f.cell_size)) {}

  int x() const { return x_.cell; }
  int y() const { return y_.cell; }
  /// Where the line leaves the cell, 0 … 1; 1 in its last cell.
  double end() const { return std::min({x_.next, y_.next, 1.0}); }
  void advance() {
    Axis& first = x_.next <= y_.next ? x_ : y_;
    first.cell += first.step;
    first.next += first.width;
  }

 private:
  struct Axis {
    int cell, step;
    double next, width;  ///< of the line: where it meets the next border, and from border to border
  };
  static Axis along(double from, double way, double cell_size) {
    const double at = from / cell_size, cells = way / cell_size;
    const double cell = std::floor(at);
    if (cells == 0) return {static_cast<int>(cell), 0, std::numeric_limits<double>::infinity(), 0};
    const double border = cells > 0 ? cell + 1 - at : at - cell;
    return {static_cast<int>(cell), cells > 0 ? 1 : -1, border / std::abs(cells), 1 / std::abs(cells)};
  }
  Axis x_, y_;
};

}  // namespace

std::optional<double> line_cost(const CostGrid& grid, const GridPoint& from, const GridPoint& to,
                                double free_start) {
  const GridFrame& f = grid.frame();
  const double length = distance(from, to);
  double sum = 0;
  CellWalk walk(f, from, to);
  for (double at = 0;;) {
    if (walk.x() < 0 || walk.x() >= f.width || walk.y() < 0 || walk.y() >= f.height) return std::nullopt;
    const std::uint8_t cost = grid.cost(grid.cell(walk.x(), walk.y()));
    const double end = walk.end();
    const bool touched = (end - at) * length < 1e-6 * f.cell_size;  // at a corner
    if (cost == CostGrid::lethal && !touched && at * length >= free_start) return std::nullopt;
    sum += (end - at) * (cost == CostGrid::lethal ? 255 : cost);
    if (end >= 1) return sum * length / CostGrid::cheapest;
    at = end;
    walk.advance();
  }
}

std::optional<double> path_cost(const CostGrid& grid, const GridPath& path, double free_start) {
  double sum = 0, way = 0;
  for (std::size_t n = 1; n < path.size(); ++n) {
    const auto cost = line_cost(grid, path[n - 1], path[n], free_start - way);
    if (!cost) return std::nullopt;
    sum += *cost;
    way += distance(path[n - 1], path[n]);
  }
  return sum;
}

GridPath shortened(const CostGrid& grid, const std::vector<CellIndex>& cells) {
  constexpr std::size_t longest = 200;  // cells that one line replaces
  GridPath points;
  if (cells.empty()) return points;
  // What the way costs up to each cell.
  std::vector<double> cost{0};
  for (std::size_t n = 1; n < cells.size(); ++n)
    cost.push_back(cost.back() +
                   line_cost(grid, grid.centre(cells[n - 1]), grid.centre(cells[n])).value_or(0));
  points.push_back(grid.centre(cells.front()));
  for (std::size_t at = 0; at + 1 < cells.size();) {
    std::size_t next = at + 1;
    // Twice as far while that works, and then half as far again.
    std::size_t step = 1;
    const auto reaches = [&](std::size_t n) {
      const auto direct = line_cost(grid, points.back(), grid.centre(cells[n]));
      return direct && *direct <= (cost[n] - cost[at]) * (1 + 1e-9);
    };
    while (next + step < cells.size() && next + step - at <= longest && reaches(next + step)) {
      next += step;
      step *= 2;
    }
    for (; step > 0; step /= 2)
      if (next + step < cells.size() && next + step - at <= longest && reaches(next + step)) next += step;
    points.push_back(grid.centre(cells[next]));
    at = next;
  }
  return points;
}

GridPath resampled(const GridPath& path, double spacing) {
  GridPath points;
  for (std::size_t n = 0; n < path.size(); ++n) {
    if (n > 0) {
      const GridPoint &a = path[n - 1], &b = path[n];
      const int parts = std::max(1, static_cast<int>(std::ceil(distance(a, b) / spacing - 1e-9)));
      for (int k = 1; k < parts; ++k)
        points.push_back({a.x + (b.x - a.x) * k / parts, a.y + (b.y - a.y) * k / parts});
    }
    points.push_back(path[n]);
  }
  return points;
}

double path_length(const GridPath& path) {
  double sum = 0;
  for (std::size_t n = 1; n < path.size(); ++n) sum += distance(path[n - 1], path[n]);
  return sum;
}

}  // namespace desert_sim
