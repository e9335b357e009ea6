/// wind::CoarsenRows for GPUs, with bit-identical results. The cells of a mean are adjacent, so threads that
/// each read the cells of their own mean access memory with a stride. Here adjacent threads load adjacent
/// cells into shared memory (coalesced), and form the means from there:
///
// clang-format off
///      a row of the terrain   | . . . . . . . . . | . . . . . . . . . |      a block's piece of it,
///                               0 1 2 … 63 0 1 2 …                           fetched by 64 threads
///      its means              |    0    |   1    |    2   |   3    | …       one a thread, `columns_a_block`
// clang-format on

#include <cmath>

#include "kernels/backend/for_each_cuda.cuh"
#include "kernels/wind/tuned/coarse_wind.hpp"

namespace desert_sim::wind {

namespace tuned {
namespace {

constexpr int columns_a_block = 60, threads_a_row = 64, rows_a_block = 4;

/// `room`: number of cells in shared memory for each row of a block.
__global__ void coarsen_rows_kernel(CoarsenRows law, int room) {
  extern __shared__ float pieces[];
  const CoarseGrid& coarse = law.coarse;
  const int first = static_cast<int>(blockIdx.x) * columns_a_block;
  const int columns = min(columns_a_block, coarse.columns - first);
  const int y = static_cast<int>(blockIdx.y) * rows_a_block + static_cast<int>(threadIdx.y);
  const int me = static_cast<int>(threadIdx.x), left = static_cast<int>(first * coarse.ratio_x);
  float* const piece = pieces + static_cast<int>(threadIdx.y) * room;
  const float* const row = law.heights + coarse.fine.index(0, y);
  const bool there = y < coarse.fine.height;
  const int end = there ? min(left + room, coarse.fine.width) : left;
  for (int x = left + me; x < end; x += threads_a_row) piece[x - left] = row[x];
  __syncthreads();
  if (there && me < columns) law.put_mean(first + me, y, [piece, left](int x) { return piece[x - left]; });
}

}  // namespace
}  // namespace tuned

void coarsen_rows(CudaExec& exec, const CoarsenRows& law) {
  using namespace tuned;
  const CoarseGrid& coarse = law.coarse;
  const int room = static_cast<int>(std::ceil(columns_a_block * coarse.ratio_x)) + 2;
  const std::size_t bytes = sizeof(float) * static_cast<std::size_t>(room * rows_a_block);
  constexpr std::size_t everywhere = 48 << 10;  // shared memory [bytes] that a block has on every GPU
  if (bytes > everywhere) return for_each_cell(exec, law.grid(), law);
  const dim3 blocks((coarse.columns + columns_a_block - 1) / columns_a_block,
                    (coarse.fine.height + rows_a_block - 1) / rows_a_block);
  coarsen_rows_kernel<<<blocks, dim3(threads_a_row, rows_a_block), bytes, cuda::stream(exec)>>>(law, room);
  check_cuda(cudaGetLastError(), "launch over rows");
}

}  // namespace desert_sim::wind
