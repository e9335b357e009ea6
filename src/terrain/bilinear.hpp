#pragma once
/// Bilinear interpolation between the centres of cells, constant beyond the outermost ones.

#include <algorithm>
#include <cmath>

namespace desert_sim {

/// Where a point lies along an axis of the grid.
struct BilinearAxis {
  int first, second;  ///< cells between whose centres it lies
  double share;       ///< 0 at the first … 1 at the second
};

/// `cells`: the point's distance from the grid's edge, in cells. The axis has `count` of them.
inline BilinearAxis bilinear_axis(double cells, int count, bool periodic) {
  if (periodic) {
    const double centre = cells - 0.5, whole = std::floor(centre),
                 wrapped = whole - count * std::floor(whole / count);
    const int first = std::min(static_cast<int>(wrapped), count - 1);
    return {first, (first + 1) % count, centre - whole};
  }
  const double centre = std::clamp(cells - 0.5, 0.0, count - 1.0);
  const int first = std::min(static_cast<int>(centre), count > 1 ? count - 2 : 0);
  return {first, std::min(first + 1, count - 1), centre - first};
}

/// `value(i, j)` is that of a cell. One of weight 0 may be unknown (NaN).
template <class Value>
double bilinear(const BilinearAxis& a, const BilinearAxis& b, const Value& value) {
  const auto part = [&](double weight, int i, int j) { return weight > 0 ? weight * value(i, j) : 0.0; };
  return part((1 - a.share) * (1 - b.share), a.first, b.first) +
         part(a.share * (1 - b.share), a.second, b.first) + part((1 - a.share) * b.share, a.first, b.second) +
         part(a.share * b.share, a.second, b.second);
}

}  // namespace desert_sim
