#pragma once
/// Putting items in order by a number, and counting places for them: a radix sort and prefix sums, CUB's on
/// the GPU. Both give the same result on every backend with any number of threads.

#include <cstdint>

#include "kernels/backend/buffer.hpp"

namespace desert_sim {

/// Memory for ordering up to `items` items and for sums over up to `values` values.
struct Ordering {
  /// Each has the number to sort by in its upper half, and an item's own number in the lower.
  Buffer<std::uint64_t> words, other;
  Buffer<char> temporary;

  Ordering() = default;
  Ordering(Exec& exec, int items, int values);
  std::size_t bytes() const { return words.bytes() + other.bytes() + temporary.bytes(); }
};

/// Sorts the first `count` of ordering.words by their upper half, of which the lowest `bits` bits count.
/// Items of the same number keep their order.
void sort_words(CpuExec& exec, Ordering& ordering, int count, int bits);
/// sums[n] = Σ of values[0 … n − 1], for n = 0 … count − 1.
void prefix_sums(CpuExec& exec, Ordering& ordering, const int* values, int* sums, int count);
#if DESERT_WITH_CUDA
void sort_words(CudaExec& exec, Ordering& ordering, int count, int bits);
void prefix_sums(CudaExec& exec, Ordering& ordering, const int* values, int* sums, int count);
#endif

/// How many bits numbers up to `most` have.
constexpr int bits_up_to(std::uint32_t most) {
  int bits = 1;
  while (bits < 32 && (most >> bits) != 0) ++bits;
  return bits;
}

}  // namespace desert_sim
