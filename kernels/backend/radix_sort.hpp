#pragma once
/// Stable radix sort and prefix sums; on the GPU those of CUB. Results are the same on every backend and with
/// any number of threads.

#include <cstdint>

#include "kernels/backend/buffer.hpp"

namespace desert_sim {

/// Work memory for sorting up to `items` items, and for prefix sums over up to `values` values.
struct SortWorkspace {
  /// Each word has an item's key in its upper 32 bits, and the item's number in the lower 32.
  Buffer<std::uint64_t> sort_keys, sort_keys_buffer;
  Buffer<char> temporary;

  SortWorkspace() = default;
  SortWorkspace(Exec& exec, int items, int values);
  std::size_t bytes() const { return sort_keys.bytes() + sort_keys_buffer.bytes() + temporary.bytes(); }
};

/// Sorts the first `count` of work.sort_keys by their keys, of which only the lowest `bits` bits count. The
/// sort is stable: items with the same key keep their order.
void sort_by_key(CpuExec& exec, SortWorkspace& work, int count, int bits);
/// Exclusive prefix sums: sums[n] = Σ values[0 … n − 1] for n = 0 … count − 1.
void prefix_sums(CpuExec& exec, SortWorkspace& work, const int* values, int* sums, int count);
#if DESERT_WITH_CUDA
void sort_by_key(CudaExec& exec, SortWorkspace& work, int count, int bits);
void prefix_sums(CudaExec& exec, SortWorkspace& work, const int* values, int* sums, int count);
#endif

/// Number of bits of integers from 0 to `most`.
constexpr int bit_width_of(std::uint32_t most) {
  int bits = 1;
  while (bits < 32 && (most >> bits) != 0) ++bits;
  return bits;
}

}  // namespace desert_sim
