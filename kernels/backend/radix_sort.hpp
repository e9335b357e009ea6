#pragma once
/// Stable radix sort and prefix sums; on the GPU those of CUB. Results are the same on every backend and with
/// any number of threads.

#include <cstdint>

#include "kernels/backend/buffer.hpp"

namespace desert_sim {

/// Work memory for sorting up to `items` items, and for prefix sums over up to `values` values.
struct SortWorkspace {
  /// Each word has an item's key in its upper 32 bits, and the item's number in the lower 32.
  Buffer<std::uint64_t> words, other;
  Buffer<char> temporary;

  SortWorkspace() = default;
  SortWorkspace(Exec& exec, int items, int values);
  std::size_t bytes() const { return words.bytes() + other.bytes() + temporary.bytes(); }
};

/// Sorts the first `count` of ordering.words by their keys, of which only the lowest `bits` bits count. The
/// sort is stable: items with the same key keep their order.
void sort_by_key(CpuExec& exec, SortWorkspace& ordering, int count, int bits);
/// Exclusive prefix sums: sums[n] = Σ values[0 … n − 1] for n = 0 … count − 1.
void prefix_sums(CpuExec& exec, SortWorkspace& ordering, const int* values, int* sums, int count);
#if DESERT_WITH_CUDA
void sort_by_key(CudaExec& exec, SortWorkspace& ordering, int count, int bits);
void prefix_sums(CudaExec& exec, SortWorkspace& ordering, const int* values, int* sums, int count);
#endif

/// Number of bits of integers from 0 to `most`.
constexpr int bit_width_of(std::uint32_t most) {
  int bits = 1;
  while (bits < 32 && (most >> bits) != 0) ++bits;
  return bits;
}

}  // namespace desert_sim
