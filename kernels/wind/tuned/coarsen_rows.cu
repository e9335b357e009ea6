/// wind::CoarsenRows for GPUs, with bit-identical results. The cells of a mean are adjacent, so threads that
/// each read the cells of their own mean access memory with a stride. Here adjacent threads load adjacent
/// cells into shared memory (coalesced), and form the means from there:
///
// clang-format off
///      a row of the terrain   | . . . . . . . . . | . . . . . . . . . |      a block's segment of it,
///                               0 1 2 … 63 0 1 2 …                           fetched by 64 threads
///      its means              |    0    |   1    |    2   |   3    | …       1 a thread, columns_per_block
// clang-format on

#include <cmath>

#include "kernels/backend/for_each_cuda.cuh"
#include "kernels/wind/tuned/coarse_wind.hpp"

namespace desert_sim::wind {

namespace tuned {
namespace {

constexpr int columns_per_block = 60, threads_per_row = 64, rows_per_block = 4;

/// `row_capacity`: number of cells in shared memory for each row of a block.
__global__ void coarsen_rows_kernel(CoarsenRows law, int row_capacity) {
  extern __shared__ float row_segments[];
  const CoarseGrid& coarse = law.coarse;
  const int first = static_cast<int>(blockIdx.x) * columns_per_block;
  const int columns = min(columns_per_block, coarse.columns - first);
  const int y = static_cast<int>(blockIdx.y) * rows_per_block + static_cast<int>(threadIdx.y);
  const int thread_in_row = static_cast<int>(threadIdx.x), left = static_cast<int>(first * coarse.ratio_x);
  float* const row_segment = row_segments + static_cast<int>(threadIdx.y) * row_capacity;
  const float* const row = law.heights + coarse.fine.index(0, y);
  const bool row_exists = y < coarse.fine.height;
  const int end = row_exists ? min(left + row_capacity, coarse.fine.width) : left;
  for (int x = left + thread_in_row; x < end; x += threads_per_row) row_segment[x - left] = row[x];
  __syncthreads();
  if (row_exists && thread_in_row < columns)
    law.store_mean(first + thread_in_row, y, [row_segment, left](int x) { return row_segment[x - left]; });
}

}  // namespace
}  // namespace tuned

void coarsen_rows(CudaExec& exec, const CoarsenRows& law) {
  using namespace tuned;
  const CoarseGrid& coarse = law.coarse;
  const int row_capacity = static_cast<int>(std::ceil(columns_per_block * coarse.ratio_x)) + 2;
  const std::size_t bytes = sizeof(float) * static_cast<std::size_t>(row_capacity * rows_per_block);
  // Shared memory that a block has on every GPU [bytes].
  constexpr std::size_t default_shared_bytes = 48 << 10;
  if (bytes > default_shared_bytes) return for_each_cell(exec, law.grid(), law);
  const dim3 blocks((coarse.columns + columns_per_block - 1) / columns_per_block,
                    (coarse.fine.height + rows_per_block - 1) / rows_per_block);
  coarsen_rows_kernel<<<blocks, dim3(threads_per_row, rows_per_block), bytes, cuda::stream(exec)>>>(
      law, row_capacity);
  check_cuda(cudaGetLastError(), "launch over rows");
}

}  // namespace desert_sim::wind
