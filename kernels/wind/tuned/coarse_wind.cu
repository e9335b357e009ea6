/// All passes of wind::transform_pass_by_pass() in one cooperative kernel: the same laws, and between them
/// the lines of the coarse grid are transformed in shared memory. The coarse grid is small (180 × 180 values
/// for a terrain of 1024 m), and the launches of its passes take longer than their work.
///
/// A thread block transforms two lines at a time. Between the stages of the table all blocks synchronise
/// across the grid; therefore no more blocks are launched than the GPU can hold at once.
///
// clang-format off
///      lines                       from memory        in shared memory, → is a transform        to memory
///   1  columns x, x + 1            means of rows      rise →                                    spectrum
///   2  rows j, j + 1               spectrum           → responses of the terrain →              responses
///   3  columns x, x + 1            responses          → warped wind, its flux →                 spectrum
///   4  rows j, −j                  spectrum           → projection →                            flux
///   5  columns x, x + 1            flux               →                                         flux, sums
// clang-format on
///
/// Without responses stages 1 and 2 are skipped, and stage 3 reads the means of rows. In inverse transforms
/// real and imaginary parts of the values are exchanged (LineTransform).

#include <cooperative_groups.h>

#include <algorithm>

#include "kernels/backend/for_each_cuda.cuh"
#include "kernels/wind/tuned/coarse_wind.hpp"

namespace desert_sim::wind {

#if CUDART_VERSION < 12000  // never called, because CudaExec::memory_for_lines() is 0
void transform_in_one_kernel(CudaExec&, const CoarseLaws&, Workspace&) { throw Error("lines need CUDA 12"); }
#else
namespace tuned {
namespace {

/// The laws run with 192 threads a line, one for each value (180 in the example above). The transforms run
/// with a team of two warps a line (180 values need 36, 30 and 30 butterflies in the three stages).
constexpr int threads_per_line = 192, threads = threads_per_line * lines_per_block, team = 64,
              teams = threads / team;

struct Axis {
  LineTransform transform;
  const Complex* roots;
};

struct Arguments {
  CoarseLaws laws;
  Axis x, y;

  __host__ __device__ int longest() const { return max(laws.warp.coarse.width, laws.warp.coarse.height); }
  __host__ __device__ int responses() const { return laws.response.fields(); }
  /// Lines that a thread block holds in shared memory: those of every response, if there are any.
  __host__ __device__ int lines() const { return lines_per_block * max(1, responses()); }
};

/// Two buffers for each line of a block, between which its transform alternates, followed by the roots of
/// unity of x and y.
extern __shared__ Complex shared[];

/// A thread block and its lines in shared memory.
struct Block {
  const Arguments& s;
  const CoarseGrid& coarse;
  int longest, width, height;
  int buffer_index = 0;  ///< which of the two buffers holds the lines

  __device__ explicit Block(const Arguments& arguments)
      : s(arguments),
        coarse(arguments.laws.warp.coarse),
        longest(arguments.longest()),
        width(coarse.width),
        height(coarse.height) {
    Complex* const roots = shared + line(s.lines(), 0);
    for (int n = threadIdx.x; n < width; n += threads) roots[n] = s.x.roots[n];
    for (int n = threadIdx.x; n < height; n += threads) roots[width + n] = s.y.roots[n];
  }

  __device__ int line(int n, int at) const { return (2 * n + at) * longest; }
  __device__ Complex& current_value(int n, int i) const { return shared[line(n, buffer_index) + i]; }
  __device__ Complex& other_buffer_value(int n, int i) const { return shared[line(n, 1 - buffer_index) + i]; }

  /// Calls body(c, x + c, y) for the values of columns x and x + 1, where these exist. Adjacent threads
  /// access adjacent values in memory (coalesced).
  template <class Body>
  __device__ void columns(int x, const Body& body) const {
    const int c = static_cast<int>(threadIdx.x) % lines_per_block;
    if (x + c < width)
      for (int y = static_cast<int>(threadIdx.x) / lines_per_block; y < height; y += threads_per_line)
        body(c, x + c, y);
  }
  /// Calls body(c, i, row) for the values of row j and, if it is not negative, of row `other`.
  template <class Body>
  __device__ void rows(int j, int other, const Body& body) const {
    const int c = static_cast<int>(threadIdx.x) / threads_per_line, row = c == 0 ? j : other;
    if (row >= 0)
      for (int i = static_cast<int>(threadIdx.x) % threads_per_line; i < width; i += threads_per_line)
        body(c, i, row);
  }

  /// Transforms `count` lines.
  __device__ void transform(const Axis& axis, int roots, int count) {
    const LineTransform& law = axis.transform;
    const int first = static_cast<int>(threadIdx.x) % team;
    __syncthreads();
    for (int n = 0; n < law.count; ++n) {
      for (int l = static_cast<int>(threadIdx.x) / team; l < count; l += teams)
        law.butterflies(law.stages[n], first, team, shared + line(s.lines(), 0) + roots,
                        shared + line(l, buffer_index), shared + line(l, 1 - buffer_index));
      buffer_index = 1 - buffer_index;
      __syncthreads();
    }
  }
};

/// The stages of the table above.
enum Stage { rises, slopes, warping, projecting, fluxes, stage_count };

/// The other line that a block processes together with line n of a stage, or −1.
__device__ int other_line(const Block& b, int stage, int n) {
  if (stage == slopes) return n + 1 < b.height ? n + 1 : -1;
  if (n > 0) return b.height - n;
  return b.height % 2 == 0 ? b.height / 2 : -1;  // that row is its own mirror, as row 0 is
}

/// Loads the lines from global memory.
__device__ void load_lines(Block& b, int stage, int n, int other) {
  const CoarseLaws& laws = b.s.laws;
  const Complex* const spectrum = laws.columns.spectrum;
  const int width = b.width, values = b.coarse.values();
  if (stage == rises) {
    b.columns(n, [&](int c, int x, int y) { b.current_value(c, y) = {laws.columns.rise_at(x, y), 0.0f}; });
  } else if (stage == warping) {
    for (int r = 0; r < b.s.responses(); ++r)
      b.columns(n, [&](int c, int x, int y) {
        b.current_value(lines_per_block * r + c, y) =
            laws.response.out[r * values + y * width + b.coarse.mirrored_column(x)];
      });
    if (b.s.responses() == 0) b.columns(n, [&](int, int x, int y) { laws.columns.rise_at(x, y); });
  } else if (stage == fluxes) {
    b.columns(n, [&](int c, int x, int y) { b.current_value(c, y) = laws.project.out[y * width + x]; });
  } else {
    b.rows(n, other, [&](int c, int i, int row) { b.current_value(c, i) = spectrum[row * width + i]; });
  }
}

/// Applies the law of a stage to its transformed lines, before these are transformed once more.
__device__ void apply_law(Block& b, int stage, int n, int other) {
  const CoarseLaws& laws = b.s.laws;
  const int width = b.width, responses = b.s.responses();
  if (stage == slopes) {
    b.rows(n, other, [&](int c, int i, int row) {
      const Complex h = b.current_value(c, i);
      for (int r = 0; r < responses; ++r)
        b.other_buffer_value(lines_per_block * r + c, i) = swap_re_im(laws.response.of_mode(r, i, row, h));
    });
  } else if (stage == warping) {
    b.columns(n, [&](int c, int x, int y) {
      const int ground = b.coarse.mirrored_row(y);
      b.other_buffer_value(c, y) = laws.warp.warp_wind(
          x, y, [&](int r) { return swap_re_im(b.current_value(lines_per_block * r + c, ground)); });
    });
  } else {
    b.rows(n, other, [&](int c, int i, int row) {
      const Complex mirror = b.current_value(n > 0 ? 1 - c : c, i == 0 ? 0 : width - i);
      b.other_buffer_value(c, i) = swap_re_im(laws.project.of_mode(i, row, b.current_value(c, i), mirror));
    });
  }
  b.buffer_index = 1 - b.buffer_index;
}

/// Stores two columns of the flux, and books what they add to the sums of the mean.
__device__ void store_flux(const Block& b, int n) {
  const MeanWind& mean = b.s.laws.mean;
  MeanWind::Sums sums;
  b.columns(n, [&](int c, int x, int y) {
    const Complex flux = swap_re_im(b.current_value(c, y));
    b.s.laws.project.out[y * b.width + x] = flux;
    if (mean.sums && x < b.coarse.columns && y < b.coarse.rows) mean.add(sums, y * b.width + x, flux);
  });
  if (!mean.sums) return;
  for (int lanes = 16; lanes > 0; lanes /= 2) {
    sums.x += __shfl_down_sync(0xffffffffu, sums.x, lanes);
    sums.y += __shfl_down_sync(0xffffffffu, sums.y, lanes);
    sums.factor += __shfl_down_sync(0xffffffffu, sums.factor, lanes);
  }
  if (threadIdx.x % 32 == 0) mean.book(sums);
}

__device__ void store(const Block& b, int stage, int n, int other) {
  const CoarseLaws& laws = b.s.laws;
  Complex *const spectrum = laws.columns.spectrum, *const out = laws.project.out;
  const int width = b.width, values = b.coarse.values();
  if (stage == slopes) {
    for (int r = 0; r < b.s.responses(); ++r)
      b.rows(n, other, [&](int c, int i, int row) {
        laws.response.out[r * values + row * width + i] = b.current_value(lines_per_block * r + c, i);
      });
  } else if (stage == projecting) {
    b.rows(n, other, [&](int c, int i, int row) { out[row * width + i] = b.current_value(c, i); });
  } else if (stage == fluxes) {
    store_flux(b, n);
  } else {
    b.columns(n, [&](int c, int x, int y) { spectrum[y * width + x] = b.current_value(c, y); });
  }
}

__global__ void __launch_bounds__(threads, 1) coarse_wind_kernel(DESERT_GRID_CONSTANT const Arguments s) {
  Block b(s);
  const bool has_responses = s.responses() > 0, has_projection = s.laws.projected;
  if (s.laws.mean.sums && blockIdx.x == 0 && threadIdx.x < 3) s.laws.mean.sums[threadIdx.x] = 0;
  for (int stage = has_responses ? rises : warping; stage < (has_projection ? stage_count : projecting);
       ++stage) {
    const bool along_y = stage == rises || stage == warping || stage == fluxes;
    const int lines = along_y ? b.width : stage == slopes ? b.height : b.height / 2 + 1;
    // In the stage of the projection each pair of a row and its mirror is visited once.
    const int step = along_y || stage == slopes ? lines_per_block : 1;
    for (int n = step * static_cast<int>(blockIdx.x); n < lines; n += step * static_cast<int>(gridDim.x)) {
      const int other = along_y ? -1 : other_line(b, stage, n);
      if (stage == projecting && other == n) continue;  // it is processed together with row 0
      __syncthreads();
      load_lines(b, stage, n, other);
      const int from_memory = stage == warping ? s.responses() : 1;
      const bool twice = stage != rises && stage != fluxes;
      for (int time = from_memory > 0 ? 0 : 1; time < (twice ? 2 : 1); ++time) {
        if (time == 1) {
          __syncthreads();
          apply_law(b, stage, n, other);
          if (stage == warping && !has_projection) break;
        }
        const int of_each = time == 0 ? from_memory : stage == slopes ? s.responses() : 1;
        b.transform(along_y ? s.y : s.x, along_y ? b.width : 0, lines_per_block * of_each);
      }
      if (stage != warping || has_projection) store(b, stage, n, other);
    }
    if (stage + 1 < (has_projection ? stage_count : projecting)) cooperative_groups::this_grid().sync();
  }
}

}  // namespace
}  // namespace tuned

void transform_in_one_kernel(CudaExec& exec, const CoarseLaws& laws, Workspace& work) {
  using namespace tuned;
  const CoarseGrid& coarse = work.coarse;
  Arguments kernel_arguments{
      laws, {work.lines_along_x, work.roots_x.data()}, {work.lines_along_y, work.roots_y.data()}};
  const std::size_t bytes = bytes_for_lines(coarse, laws.response.fields());
  // All that there is, because a simulation in another thread asks for the same kernel.
  check_cuda(cudaFuncSetAttribute(coarse_wind_kernel, cudaFuncAttributeMaxDynamicSharedMemorySize,
                                  static_cast<int>(exec.shared_memory_of_a_block())),
             "asking for shared memory");
  int device = 0, multiprocessors = 0, blocks_per_multiprocessor = 0;
  check_cuda(cudaGetDevice(&device), "asking for the device");
  check_cuda(cudaDeviceGetAttribute(&multiprocessors, cudaDevAttrMultiProcessorCount, device),
             "asking for the device");
  check_cuda(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&blocks_per_multiprocessor, coarse_wind_kernel,
                                                           threads, bytes),
             "asking how many blocks fit");
  const int blocks =
      std::min(kernel_arguments.longest() / lines_per_block + 1, multiprocessors * blocks_per_multiprocessor);
  void* arguments[] = {&kernel_arguments};
  check_cuda(cudaLaunchCooperativeKernel(reinterpret_cast<const void*>(coarse_wind_kernel), dim3(blocks),
                                         dim3(threads), arguments, bytes, cuda::stream(exec)),
             "launch of the coarse wind");
}
#endif

}  // namespace desert_sim::wind
