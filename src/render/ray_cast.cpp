#include "src/render/ray_cast.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace desert_sim::render {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The part of a ray for which a coordinate is between two bounds, as an interval of the ray's parameter [m].
struct Interval {
  double begin = 0, end = infinity;

  void clip(double origin, double direction, double low, double high) {
    if (direction == 0) {
      if (!(origin >= low && origin <= high)) end = -infinity;
      return;
    }
    const double at_low = (low - origin) / direction, at_high = (high - origin) / direction;
    begin = std::max(begin, std::min(at_low, at_high));
    end = std::min(end, std::max(at_low, at_high));
  }
};

/// The smallest root of c0 + c1 s + c2 s² in [-slack, end + slack]; infinite if there is none.
double first_root(double c0, double c1, double c2, double end, double slack) {
  double roots[2] = {infinity, infinity};
  const double discriminant = c1 * c1 - 4 * c2 * c0;
  if (discriminant >= 0) {
    // This form loses no digits where c2 is small, and is the linear equation's where it is 0.
    const double q = -0.5 * (c1 + std::copysign(std::sqrt(discriminant), c1));
    if (q != 0) roots[0] = c0 / q;
    if (c2 != 0) roots[1] = q / c2;
    if (q == 0 && c0 == 0) roots[0] = 0;
  }
  double first = infinity;
  for (const double root : roots)
    if (root >= -slack && root <= end + slack) first = std::min(first, root);
  return first == infinity ? first : std::clamp(first, 0.0, end);
}

/// A ray above a grid, in units of cells, in which the centres of cells have whole numbers.
struct Walk {
  const HeightField& field;
  double u, v, z, du, dv, dz;  ///< origin and direction; a parameter of 1 is a metre

  /// The parameter at which the ray meets the surface between the centres of the cells (i, j) and (i + 1, j
  /// + 1), from `begin` to `end`; infinite if it does not. Beyond the grid, the outermost cells count.
  double hit(int i, int j, double begin, double end) const {
    const auto height = [&](int x, int y) {
      return static_cast<double>(
          field.at(std::clamp(x, 0, field.width - 1), std::clamp(y, 0, field.height - 1)));
    };
    const double sw = height(i, j), se = height(i + 1, j), nw = height(i, j + 1), ne = height(i + 1, j + 1);
    const double low = std::min({sw, se, nw, ne}), high = std::max({sw, se, nw, ne});
    const double from = z + begin * dz, to = z + end * dz, slack = 1e-9 * (1 + begin);
    if (std::min(from, to) > high + slack || std::max(from, to) < low - slack) return infinity;
    // The height is sw + x a + y b + xy a b at the fractions a and b, which are linear along the ray.
    const double x = se - sw, y = nw - sw, xy = ne - se - nw + sw;
    const double a = u + begin * du - i, b = v + begin * dv - j;
    const double c0 = from - (sw + x * a + y * b + xy * a * b),
                 c1 = dz - (x * du + y * dv + xy * (a * dv + b * du)), c2 = -xy * du * dv;
    return begin + first_root(c0, c1, c2, end - begin, slack);  // NaN in a height makes all comparisons false
  }
};

}  // namespace

std::optional<Point> first_hit(const HeightField& field, const Ray& ray) {
  const Point &o = ray.origin, &d = ray.direction;
  const double length = d.norm();
  if (field.empty() || !(length > 0)) return std::nullopt;
  const double per_metre = 1 / (field.cell_size * length);
  const Walk walk{field,
                  o.x() / field.cell_size - 0.5,
                  o.y() / field.cell_size - 0.5,
                  o.z(),
                  d.x() * per_metre,
                  d.y() * per_metre,
                  d.z() / length};
  Interval inside;
  inside.clip(walk.u, walk.du, -0.5, field.width - 0.5);
  inside.clip(walk.v, walk.dv, -0.5, field.height - 0.5);
  if (!(inside.begin <= inside.end)) return std::nullopt;

  const auto first_index = [&](double origin, double direction, int count) {
    return std::clamp(static_cast<int>(std::floor(origin + inside.begin * direction)), -1, count - 1);
  };
  int i = first_index(walk.u, walk.du, field.width), j = first_index(walk.v, walk.dv, field.height);
  const int step_i = walk.du < 0 ? -1 : 1, step_j = walk.dv < 0 ? -1 : 1;
  double t = inside.begin;
  while (t <= inside.end && i >= -1 && i < field.width && j >= -1 && j < field.height) {
    const auto exit = [&](double origin, double direction, int index) {
      return direction == 0 ? infinity : (index + (direction > 0) - origin) / direction;
    };
    const double exit_u = exit(walk.u, walk.du, i), exit_v = exit(walk.v, walk.dv, j);
    const double end = std::max(t, std::min({exit_u, exit_v, inside.end}));
    const double hit = walk.hit(i, j, t, end);
    if (hit < infinity) {
      return o + hit / length * d;
    }
    (exit_u <= exit_v ? i : j) += exit_u <= exit_v ? step_i : step_j;
    if (end == inside.end) break;
    t = end;
  }
  return std::nullopt;
}

}  // namespace desert_sim::render
