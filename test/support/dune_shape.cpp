#include "support/dune_shape.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace desert_sim {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double degree = pi / 180.0;
constexpr double slip_face_from_deg = 28.0;

int wrapped(int i, int n) { return ((i % n) + n) % n; }

int bounded(const Field& f, int i, int n) { return f.periodic ? wrapped(i, n) : std::clamp(i, 0, n - 1); }

double direction_of(double x, double y) { return std::atan2(y, x) / degree; }

}  // namespace

float Field::at(int x, int y) const {
  return values[index(bounded(*this, x, width), bounded(*this, y, height))];
}

double Field::sample(double x, double y) const {
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  const double fx = x - x0, fy = y - y0;
  return (1 - fy) * ((1 - fx) * at(x0, y0) + fx * at(x0 + 1, y0)) +
         fy * ((1 - fx) * at(x0, y0 + 1) + fx * at(x0 + 1, y0 + 1));
}

double angle_between_deg(double a, double b) { return std::abs(std::remainder(a - b, 360.0)); }

double line_angle_between_deg(double a, double b) { return std::abs(std::remainder(a - b, 180.0)); }

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto n = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(n), values.end());
  return values[n];
}

// ---- slopes
// --------------------------------------------------------------------------------------------------------

Slopes slopes(const Field& f) {
  Slopes s;
  s.slope_deg.resize(f.values.size());
  s.direction_deg.resize(f.values.size());
  for (int y = 0; y < f.height; ++y)
    for (int x = 0; x < f.width; ++x) {
      const double gx = (f.at(x + 1, y) - f.at(x - 1, y)) / (2 * f.cell_size);
      const double gy = (f.at(x, y + 1) - f.at(x, y - 1)) / (2 * f.cell_size);
      s.slope_deg[f.index(x, y)] = static_cast<float>(std::atan(std::hypot(gx, gy)) / degree);
      s.direction_deg[f.index(x, y)] = static_cast<float>(direction_of(-gx, -gy));
    }
  return s;
}

std::vector<double> slope_histogram(const Field& f, double bin_deg) {
  std::vector<double> shares(static_cast<std::size_t>(std::ceil(90.0 / bin_deg)), 0.0);
  for (float slope : slopes(f).slope_deg)
    shares[std::min(static_cast<std::size_t>(slope / bin_deg), shares.size() - 1)] += 1.0;
  for (double& share : shares) share /= static_cast<double>(f.values.size());
  return shares;
}

std::vector<double> slip_face_directions(const Field& f, double least_share) {
  constexpr int bins = 72, reach = 3;  // of 5 degrees; ±15 degrees are 7 bins
  std::vector<double> count(bins, 0.0), around(bins, 0.0);
  const Slopes s = slopes(f);
  double total = 0;
  for (std::size_t i = 0; i < s.slope_deg.size(); ++i) {
    if (s.slope_deg[i] < slip_face_from_deg) continue;
    count[static_cast<std::size_t>(wrapped(static_cast<int>(std::floor(s.direction_deg[i] / 5)), bins))] += 1;
    total += 1;
  }
  std::vector<double> directions;
  if (total == 0) return directions;
  for (int b = 0; b < bins; ++b)
    for (int d = -reach; d <= reach; ++d)
      around[static_cast<std::size_t>(b)] += count[static_cast<std::size_t>(wrapped(b + d, bins))] / total;
  std::vector<int> order(bins);
  for (int b = 0; b < bins; ++b) order[static_cast<std::size_t>(b)] = b;
  const auto share = [&](int b) { return around[static_cast<std::size_t>(wrapped(b, bins))]; };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return share(a) > share(b); });
  for (int b : order) {
    double turn = 0;  // from the bin's middle to the mean direction within reach
    for (int d = -reach; d <= reach; ++d)
      turn += 5.0 * d * count[static_cast<std::size_t>(wrapped(b + d, bins))] / total;
    const double direction = std::fmod(5.0 * b + 2.5 + (share(b) > 0 ? turn / share(b) : 0.0) + 360.0, 360.0);
    const bool peak = share(b) >= share(b - 1) && share(b) >= share(b + 1);
    const bool apart = std::all_of(directions.begin(), directions.end(),
                                   [&](double other) { return angle_between_deg(direction, other) >= 45.0; });
    if (share(b) >= least_share && peak && apart) directions.push_back(direction);
  }
  return directions;
}

// ---- separate dunes
// ------------------------------------------------------------------------------------------------

namespace {

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
        char& mark = seen[sand.index(bounded(sand, x, sand.width), bounded(sand, y, sand.height))];
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
double flank_deg(const Field& elevation, const Dune& dune, double base, double dx, double dy, double high,
                 double low) {
  const double l = elevation.cell_size, x = dune.crest_x / l - 0.5, y = dune.crest_y / l - 0.5;
  const double most = 2 * dune.length + 10 * l;
  const double upper = fall_distance(elevation, x, y, dx, dy, base + high * dune.height, most);
  const double lower = fall_distance(elevation, x, y, dx, dy, base + low * dune.height, most);
  if (upper < 0 || lower <= upper) return 0;
  return std::atan((high - low) * dune.height / (lower - upper)) / degree;
}

void measure_horns(const Patch& patch, double wind_deg, double left, double right, Dune& dune) {
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

Dune measure(const Field& elevation, const Field& sand, const Slopes& slope, const Patch& patch,
             double wind_deg) {
  Dune dune;
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
    const std::size_t i = sand.index(bounded(sand, cell.x, sand.width), bounded(sand, cell.y, sand.height));
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

std::vector<Dune> find_dunes(const Field& elevation, const Field& sand, double wind_deg, double threshold,
                             std::size_t least_cells) {
  const Slopes slope = slopes(elevation);
  std::vector<Dune> dunes;
  for (const Patch& patch : find_patches(sand, wind_deg, threshold, least_cells))
    dunes.push_back(measure(elevation, sand, slope, patch, wind_deg));
  std::stable_sort(dunes.begin(), dunes.end(),
                   [](const Dune& a, const Dune& b) { return a.volume > b.volume; });
  return dunes;
}

// ---- patterns of crests
// --------------------------------------------------------------------------------------------

Field smoothed(const Field& f, double sigma) {
  const double cells = sigma / f.cell_size;
  if (cells < 0.1) return f;
  const int reach = static_cast<int>(std::ceil(3 * cells));
  std::vector<double> kernel;
  double sum = 0;
  for (int d = -reach; d <= reach; ++d) {
    kernel.push_back(std::exp(-0.5 * d * d / (cells * cells)));
    sum += kernel.back();
  }
  Field rows = f, out = f;
  for (int pass = 0; pass < 2; ++pass) {
    const Field& from = pass == 0 ? f : rows;
    Field& to = pass == 0 ? rows : out;
    for (int y = 0; y < f.height; ++y)
      for (int x = 0; x < f.width; ++x) {
        double mean = 0;
        for (int d = -reach; d <= reach; ++d)
          mean += kernel[static_cast<std::size_t>(d + reach)] *
                  (pass == 0 ? from.at(x + d, y) : from.at(x, y + d));
        to.values[f.index(x, y)] = static_cast<float>(mean / sum);
      }
  }
  return out;
}

Orientation crest_orientation(const Field& elevation, double sigma) {
  const Field f = smoothed(elevation, sigma);
  double xx = 0, xy = 0, yy = 0;
  for (int y = 0; y < f.height; ++y)
    for (int x = 0; x < f.width; ++x) {
      const double gx = f.at(x + 1, y) - f.at(x - 1, y), gy = f.at(x, y + 1) - f.at(x, y - 1);
      xx += gx * gx;
      xy += gx * gy;
      yy += gy * gy;
    }
  Orientation o;
  const double steepest = 0.5 * std::atan2(2 * xy, xx - yy) / degree;
  o.crest_deg = std::fmod(steepest + 90.0 + 360.0, 180.0);
  if (xx + yy > 0) o.coherence = std::hypot(xx - yy, 2 * xy) / (xx + yy);
  return o;
}

double wavelength(const Field& f, double direction_deg) {
  const double c = std::cos(direction_deg * degree), s = std::sin(direction_deg * degree);
  double mean = 0;
  for (float v : f.values) mean += v / static_cast<double>(f.values.size());
  const auto correlation = [&](int d) {
    double sum = 0;
    for (int y = 0; y < f.height; ++y)
      for (int x = 0; x < f.width; ++x) sum += (f.at(x, y) - mean) * (f.sample(x + d * c, y + d * s) - mean);
    return sum;
  };
  const int most = std::min(f.width, f.height) / 2;
  bool crossed = false;
  double before = correlation(0), here = before;
  for (int d = 1; d <= most; ++d) {
    const double next = correlation(d);
    if (crossed && here > 0 && here >= before && here > next) {
      const double bend = before - 2 * here + next;
      return (d - 1 + (bend < 0 ? 0.5 * (before - next) / bend : 0.0)) * f.cell_size;
    }
    crossed = crossed || next < 0;
    before = here;
    here = next;
  }
  return 0;
}

double roughness(const Field& f) {
  double mean = 0, square = 0;
  for (float v : f.values) mean += v / static_cast<double>(f.values.size());
  for (float v : f.values) square += (v - mean) * (v - mean) / static_cast<double>(f.values.size());
  return std::sqrt(square);
}

// ---- spectra
// -------------------------------------------------------------------------------------------------------

namespace {

/// Power of mode k of the rows (or columns), summed over all of them.
double line_power(const Field& f, bool along_x, int k) {
  const int n = along_x ? f.width : f.height, lines = along_x ? f.height : f.width;
  std::vector<double> cosine(static_cast<std::size_t>(n)), sine(cosine);
  for (int i = 0; i < n; ++i) {
    cosine[static_cast<std::size_t>(i)] = std::cos(2 * pi * k * i / n);
    sine[static_cast<std::size_t>(i)] = std::sin(2 * pi * k * i / n);
  }
  double power = 0;
  for (int line = 0; line < lines; ++line) {
    double re = 0, im = 0;
    for (int i = 0; i < n; ++i) {
      const double v = along_x ? f.values[f.index(i, line)] : f.values[f.index(line, i)];
      re += v * cosine[static_cast<std::size_t>(i)];
      im += v * sine[static_cast<std::size_t>(i)];
    }
    power += re * re + im * im;
  }
  return power;
}

}  // namespace

double mode_excess(const std::vector<Field>& fields, bool along_x, int mode) {
  const auto power = [&](int k) {
    double sum = 1e-30;
    for (const Field& f : fields) sum += line_power(f, along_x, k);
    return sum;
  };
  // The geometric mean follows a spectrum that falls steeply.
  double beside = 0;
  for (int d : {-2, -1, 1, 2}) beside += 0.25 * std::log(power(mode + d));
  return power(mode) / std::exp(beside);
}

namespace {

constexpr int harmonics = 3;

/// The greatest excess of the modes up to the third harmonic of `period` that are multiples of it, or that
/// are not.
double greatest_excess(const std::vector<Field>& fields, int period, bool multiples) {
  double greatest = 0;
  for (bool along_x : {true, false}) {
    const int n = along_x ? fields[0].width : fields[0].height;
    for (int k = 3; k * period <= harmonics * n && k + 2 < n / 2; ++k)
      if ((k * period % n == 0) == multiples) greatest = std::max(greatest, mode_excess(fields, along_x, k));
  }
  return greatest;
}

}  // namespace

double imprint(const std::vector<Field>& fields, int period) { return greatest_excess(fields, period, true); }

double imprint_by_chance(const std::vector<Field>& fields, int period) {
  return greatest_excess(fields, period, false);
}

// ---- in front of walls
// ---------------------------------------------------------------------------------------------

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
