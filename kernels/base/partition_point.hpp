#pragma once
/// Binary search, on the CPU and on the GPU.

#include "kernels/base/macros.hpp"

namespace desert_sim {

/// The first n = 0 … count − 1 for which before(n) does not hold, or `count`; before() holds for all numbers
/// below it and for none from it on. As std::partition_point.
template <class Before>
DESERT_HD int partition_point(int count, const Before& before) {
  int first = 0, last = count;
  while (first < last) {
    const int middle = first + (last - first) / 2;
    if (before(middle))
      first = middle + 1;
    else
      last = middle;
  }
  return first;
}

}  // namespace desert_sim
