#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_scan.cuh>
#include <string>

#include "kernels/backend/for_each_cuda.cuh"
#include "kernels/backend/radix_sort.hpp"

namespace desert_sim {

namespace {

/// Calls call(memory, bytes) twice, as CUB requires: first to learn how much temporary memory it needs, then
/// with that memory.
template <class Call>
void with_temporary(const SortWorkspace& work, const char* what, const Call& call) {
  std::size_t bytes = 0;
  check_cuda(call(nullptr, bytes), what);
  if (bytes > work.temporary.bytes())
    throw CudaError(std::string("CUDA: ") + what + " takes " + std::to_string(bytes) + " bytes; there are " +
                    std::to_string(work.temporary.bytes()));
  bytes = work.temporary.bytes();
  check_cuda(call(work.temporary.data(), bytes), what);
}

}  // namespace

void sort_by_key(CudaExec& exec, SortWorkspace& work, int count, int bits) {
  cub::DoubleBuffer<std::uint64_t> words(work.sort_keys.data(), work.sort_keys_buffer.data());
  with_temporary(work, "sorting", [&](void* memory, std::size_t& bytes) {
    return cub::DeviceRadixSort::SortKeys(memory, bytes, words, count, 32, 32 + bits, cuda::stream(exec));
  });
  if (words.Current() != work.sort_keys.data()) work.sort_keys.swap(work.sort_keys_buffer);
}

void prefix_sums(CudaExec& exec, SortWorkspace& work, const int* values, int* sums, int count) {
  with_temporary(work, "summing", [&](void* memory, std::size_t& bytes) {
    return cub::DeviceScan::ExclusiveSum(memory, bytes, values, sums, count, cuda::stream(exec));
  });
}

}  // namespace desert_sim
