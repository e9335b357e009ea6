#include "test/support/dune_shape.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace desert_sim {

namespace {

constexpr double slip_face_from_deg = 28.0;

/// A cell of a patch, in cells, unwrapped, with its place along and across the wind.
struct Cell {
  int x, y;
  double along, across;
};

using Patch = std::vector<Cell>;

std::vector<Patch> find_patches(const Field& sand, double wind_deg, double threshold,
                                std::size_t least_cells) {
  const double c = std::cos(wind_deg * degree), s = std::sin(wind_deg * degree);
  std::vector<char> seen(sand.values.size(), 0);
  std::vector<Patch> patches;
  for (int y0 = 0; y0 < sand.height; ++y0)
    for (int x0 = 0; x0 < sand.width; ++x0) {
      if (seen[sand.index(x0, y0)] || sand.at(x0, y0) < threshold) continue;
      Patch patch;
      const auto visit = [&](int x, int y) {
        if (!sand.periodic && (x < 0 || y < 0 || x >= sand.width || y >= sand.height)) return;
        char& mark = seen[sand.nearest(x, y)];
        if (mark || sand.at(x, y) < threshold) return;
        mark = 1;
        patch.push_back({x, y, (x * c + y * s) * sand.cell_size, (y * c - x * s) * sand.cell_size});
      };
      visit(x0, y0);
      for (std::size_t n = 0; n < patch.size(); ++n)
        for (int d = 0; d < 9; ++d) {
          const int x = patch[n].x + d % 3 - 1, y = patch[n].y + d / 3 - 1;
          visit(x, y);
        }
      if (patch.size() >= least_cells) patches.push_back(std::move(patch));
    }
  return patches;
}

/// Distance from the crest, going by `step` cells, at which the surface has fallen to `level` [m]; −1 if it
/// does not within `most` metres.
double fall_distance(const Field& elevation, double x, double y, double step_x, double step_y, double level,
                     double most) {
  constexpr double stride = 0.25;
  double last = elevation.sample(x, y);
  for (double d = stride; d * elevation.cell_size <= most; d += stride) {
    const double next = elevation.sample(x + d * step_x, y + d * step_y);
    if (next <= level) {
      const double part = last > next ? (last - level) / (last - next) : 0.0;
      return (d - stride * (1.0 - part)) * elevation.cell_size;
    }
    last = next;
  }
  return -1;
}

/// Angle of the line between the places where a profile from the crest has fallen to the shares `high` and
/// `low` of the height [deg]; 0 if it never does.
double flank_deg(const Field& elevation, const DuneShape& dune, double base, double dx, double dy,
                 double high, double low) {
  const double l = elevation.cell_size, x = dune.crest_x / l - 0.5, y = dune.crest_y / l - 0.5;
  const double most = 2 * dune.length + 10 * l;
  const double upper = fall_distance(elevation, x, y, dx, dy, base + high * dune.height, most);
  const double lower = fall_distance(elevation, x, y, dx, dy, base + low * dune.height, most);
  if (upper < 0 || lower <= upper) return 0;
  return std::atan((high - low) * dune.height / (lower - upper)) / degree;
}

void measure_horns(const Patch& patch, double wind_deg, double left, double right, DuneShape& dune) {
  constexpr double none = std::numeric_limits<double>::infinity();
  struct Third {
    double front = -none, back = none, front_across = 0, back_across = 0;
  } thirds[3];
  for (const Cell& cell : patch) {
    const double share = (cell.across - left) / std::max(right - left, 1e-9);
    Third& t = thirds[std::clamp(static_cast<int>(share * 3), 0, 2)];
    if (cell.along > t.front) t.front = cell.along, t.front_across = cell.across;
    if (cell.along < t.back) t.back = cell.along, t.back_across = cell.across;
  }
  dune.horn_reach = std::min(thirds[0].front, thirds[2].front) - thirds[1].front;
  const double along = 0.5 * (thirds[0].front + thirds[2].front) - thirds[1].back;
  const double across = 0.5 * (thirds[0].front_across + thirds[2].front_across) - thirds[1].back_across;
  dune.horn_direction_deg = std::remainder(wind_deg + direction_of(along, across), 360.0);
}

DuneShape measure(const Field& elevation, const Field& sand, const Slopes& slope, const Patch& patch,
                  double wind_deg) {
  DuneShape dune;
  const double l = sand.cell_size;
  double left = patch[0].across, right = left, back = patch[0].along, front = back;
  double top = -1e30, base = 1e30, slip_x = 0, slip_y = 0;
  std::size_t slip_cells = 0;
  for (const Cell& cell : patch) {
    const double s = sand.at(cell.x, cell.y), h = elevation.at(cell.x, cell.y);
    left = std::min(left, cell.across);
    right = std::max(right, cell.across);
    back = std::min(back, cell.along);
    front = std::max(front, cell.along);
    dune.volume += s * l * l;
    dune.x += s * l * l * (cell.x + 0.5) * l;
    dune.y += s * l * l * (cell.y + 0.5) * l;
    base = std::min(base, h - s);
    if (h > top) {
      top = h;
      dune.crest_x = (cell.x + 0.5) * l;
      dune.crest_y = (cell.y + 0.5) * l;
    }
    const std::size_t i = sand.nearest(cell.x, cell.y);
    if (slope.slope_deg[i] >= slip_face_from_deg) {
      ++slip_cells;
      slip_x += std::cos(slope.direction_deg[i] * degree);
      slip_y += std::sin(slope.direction_deg[i] * degree);
    }
  }
  dune.cells = patch.size();
  dune.x /= dune.volume;
  dune.y /= dune.volume;
  dune.height = top - base;
  dune.width = right - left + l;
  dune.length = front - back + l;
  dune.slip_share = static_cast<double>(slip_cells) / static_cast<double>(patch.size());
  dune.slip_direction_deg = direction_of(slip_x, slip_y);
  const double c = std::cos(wind_deg * degree), s = std::sin(wind_deg * degree);
  dune.stoss_deg = flank_deg(elevation, dune, base, -c, -s, 0.9, 0.1);
  for (double turn = -45; turn <= 45; turn += 5) {
    const double to = (wind_deg + turn) * degree;
    const double angle = flank_deg(elevation, dune, base, std::cos(to), std::sin(to), 0.75, 0.25);
    dune.slip_face_deg = std::max(dune.slip_face_deg, angle);
  }
  measure_horns(patch, wind_deg, left, right, dune);
  return dune;
}

}  // namespace

std::vector<DuneShape> find_dunes(const Field& elevation, const Field& sand, double wind_deg,
                                  double threshold, std::size_t least_cells) {
  const Slopes slope = slopes(elevation);
  std::vector<DuneShape> dunes;
  for (const Patch& patch : find_patches(sand, wind_deg, threshold, least_cells))
    dunes.push_back(measure(elevation, sand, slope, patch, wind_deg));
  std::stable_sort(dunes.begin(), dunes.end(),
                   [](const DuneShape& a, const DuneShape& b) { return a.volume > b.volume; });
  return dunes;
}

WallFront wall_front(const Field& sand, const Field& wall, int y0, int y1, double threshold, double reach) {
  WallFront mean;
  const double l = sand.cell_size;
  int rows = 0;
  for (int y = y0; y < y1; ++y) {
    int wall_x = 0;
    while (wall_x < wall.width && !(wall.at(wall_x, y) > 0)) ++wall_x;
    if (wall_x == wall.width) continue;
    const int farthest = std::max(0, wall_x - static_cast<int>(reach / l));
    double lane = reach, deepest = 0, distance = 0;
    for (int x = wall_x - 1; x >= farthest; --x) {
      const double depth = sand.at(x, y);
      if (depth > threshold) lane = std::min(lane, (wall_x - 1 - x) * l);
      if (depth > deepest) {
        deepest = depth;
        distance = (wall_x - x - 0.5) * l;
      }
    }
    mean.lane += lane;
    mean.dune_height += deepest;
    mean.dune_distance += distance;
    ++rows;
  }
  if (rows > 0) {
    mean.lane /= rows;
    mean.dune_height /= rows;
    mean.dune_distance /= rows;
  }
  return mean;
}

}  // namespace desert_sim
