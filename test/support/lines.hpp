#pragma once
/// Lines transformed on the host, as a GPU's team of threads does it, one thread after the other.

#include <vector>

#include "kernels/backend/line_transform.hpp"

namespace desert_sim::test {

using Line = std::vector<Complex>;

/// `roots`: the transform's.
inline Line transformed(const LineTransform& transform, const Line& roots, Line line, int threads = 1) {
  Line other(line.size());
  for (int s = 0; s < transform.count; ++s) {
    for (int thread = 0; thread < threads; ++thread)
      transform.butterflies(transform.stages[s], thread, threads, roots.data(), line.data(), other.data());
    line.swap(other);
  }
  return line;
}

}  // namespace desert_sim::test
