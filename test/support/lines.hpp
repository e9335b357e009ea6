#pragma once
/// Lines transformed on the host, as a GPU's team of threads does it, one thread after the other.

#include <vector>

#include "kernels/backend/line_transform.hpp"

namespace desert_sim::test {

using Line = std::vector<Complex>;

/// `roots`: the transform's.
inline Line transformed(const LineTransform& transform, const Line& roots, Line line, int threads = 1) {
  struct Values {
    Complex* values;
    Complex get(int i) const { return values[i]; }
    void set(int i, Complex value) const { values[i] = value; }
  };
  Line other(line.size());
  for (int s = 0; s < transform.count; ++s) {
    const LineTransform::Stage& stage = transform.stages[s];
    const Values in{line.data()}, out{other.data()};
    if (!stage.in_registers())
      for (int b = 0; b < transform.length / stage.radix; ++b) {
        const LineTransform::PrimeButterfly butterfly(transform, stage, b);
        for (int q = 1; q <= butterfly.pairs(); ++q) butterfly.fold(q, roots.data(), in);
        for (int m = 0; m <= butterfly.pairs(); ++m) butterfly.modes(m, roots.data(), in, out);
      }
    else
      for (int thread = 0; thread < threads; ++thread)
        transform.butterflies(stage, thread, threads, roots.data(), line.data(), other.data());
    line.swap(other);
  }
  return line;
}

}  // namespace desert_sim::test
