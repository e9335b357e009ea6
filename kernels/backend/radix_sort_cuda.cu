#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_scan.cuh>
#include <string>

#include "kernels/backend/for_each_cuda.cuh"
#include "kernels/backend/radix_sort.hpp"

namespace desert_sim {

namespace {

/// Calls work(memory, bytes) twice, as CUB requires: first to learn how much temporary memory it needs, then
/// with that memory.
template <class Work>
void with_temporary(const SortWorkspace& ordering, const char* what, const Work& work) {
  std::size_t bytes = 0;
  check_cuda(work(nullptr, bytes), what);
  if (bytes > ordering.temporary.bytes())
    throw CudaError(std::string("CUDA: ") + what + " takes " + std::to_string(bytes) + " bytes; there are " +
                    std::to_string(ordering.temporary.bytes()));
  bytes = ordering.temporary.bytes();
  check_cuda(work(ordering.temporary.data(), bytes), what);
}

}  // namespace

void sort_by_key(CudaExec& exec, SortWorkspace& ordering, int count, int bits) {
  cub::DoubleBuffer<std::uint64_t> words(ordering.words.data(), ordering.other.data());
  with_temporary(ordering, "sorting", [&](void* memory, std::size_t& bytes) {
    return cub::DeviceRadixSort::SortKeys(memory, bytes, words, count, 32, 32 + bits, cuda::stream(exec));
  });
  if (words.Current() != ordering.words.data()) ordering.words.swap(ordering.other);
}

void prefix_sums(CudaExec& exec, SortWorkspace& ordering, const int* values, int* sums, int count) {
  with_temporary(ordering, "summing", [&](void* memory, std::size_t& bytes) {
    return cub::DeviceScan::ExclusiveSum(memory, bytes, values, sums, count, cuda::stream(exec));
  });
}

}  // namespace desert_sim
