#pragma once
/// Means of a field over a part of its cells, and the share of them that such a part is.

#include "src/metrics/field.hpp"

namespace desert_sim {

/// A box of cells, from the first to before the last.
struct Box {
  int west, east, south, north;
};

inline double mean_in(const Field& field, const Box& box) {
  double sum = 0;
  for (int y = box.south; y < box.north; ++y)
    for (int x = box.west; x < box.east; ++x) sum += static_cast<double>(field.at(x, y));
  return sum / ((box.east - box.west) * (box.north - box.south));
}

/// `holds(i)`: whether cell i belongs to the part. The mean of no cells is 0.
template <class Holds>
double mean_over(const Field& field, const Holds& holds) {
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < field.values.size(); ++i)
    if (holds(i)) sum += static_cast<double>(field.values[i]), ++count;
  return count > 0 ? sum / count : 0;
}

template <class Holds>
double share_where(const Field& field, const Holds& holds) {
  double count = 0;
  for (std::size_t i = 0; i < field.values.size(); ++i) count += holds(i) ? 1 : 0;
  return count / static_cast<double>(field.values.size());
}

}  // namespace desert_sim
