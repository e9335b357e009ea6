#pragma once
/// Parallel loops on the GPU; see for_each.hpp.

#include <cuda_runtime.h>

#include <algorithm>
#include <type_traits>
#include <utility>

#include "kernels/backend/for_each.hpp"
#include "kernels/base/quanta.hpp"
#include "src/core/error.hpp"

/// Before a kernel's parameter that no thread changes: what is found in it by an index, or through a pointer,
/// is read where it is. Without it each thread makes a copy of its own. Older ones do not know it.
#if CUDART_VERSION >= 12000 && (!defined(__CUDA_ARCH__) || __CUDA_ARCH__ >= 700)
#define DESERT_GRID_CONSTANT __grid_constant__
#else
#define DESERT_GRID_CONSTANT
#endif

namespace desert_sim {

inline void check_cuda(cudaError_t status, const char* what) {
  if (status != cudaSuccess)
    throw CudaError(std::string("CUDA: ") + what + ": " + cudaGetErrorString(status));
}

namespace cuda {

constexpr int block_x = 32, block_y = 8;

inline cudaStream_t stream(const CudaExec& exec) { return static_cast<cudaStream_t>(exec.stream()); }
inline dim3 block() { return dim3(block_x, block_y); }
inline dim3 blocks(const Grid& g) {
  return dim3((g.width + block_x - 1) / block_x, (g.height + block_y - 1) / block_y);
}

template <class Law, class = void>
struct CompactWarps : std::false_type {};
template <class Law>
struct CompactWarps<Law, std::enable_if_t<Law::compact_warps>> : std::true_type {};

/// Warps of a thread block. A warp usually covers 32 × 1 cells, and a block has eight. If a law defines
/// `compact_warps`, because some warps take much longer than others, a warp covers 8 × 4 cells and a block
/// has two: a block's resources are only freed when all of its warps are done.
template <class Law>
constexpr int warps_per_block = CompactWarps<Law>::value ? 2 : block_y;

template <class Law>
__global__ void cells_kernel(Grid grid, DESERT_GRID_CONSTANT const Law law) {
  int x = blockIdx.x * block_x + threadIdx.x, y = blockIdx.y * block_y + threadIdx.y;
  if constexpr (CompactWarps<Law>::value) {
    x = 8 * (blockIdx.x * warps_per_block<Law> + threadIdx.y) + threadIdx.x % 8;
    y = 4 * blockIdx.y + threadIdx.x / 8;
  }
  if (x < grid.width && y < grid.height) law(x, y);
}
template <class Law>
dim3 blocks_of(const Grid& g) {
  if (!CompactWarps<Law>::value) return blocks(g);
  constexpr int width = 8 * warps_per_block<Law>;
  return dim3((g.width + width - 1) / width, (g.height + 3) / 4);
}

struct AtomicSums {
  Quanta* sums;
  DESERT_HD void operator()(int cell, Quanta amount) const {
    if (amount != 0) atomic_add(&sums[cell], amount);
  }
  /// Adds to cell `south`, to the one east of it, and to those north of these two. This thread's eastern
  /// cells are mostly the next thread's western ones: then the next thread takes over the eastern amounts by
  /// a warp shuffle, and adds them together with its own.
  DESERT_HD void square(int south, int width, Quanta south_west, Quanta south_east, Quanta north_west,
                        Quanta north_east) const {
#if defined(__CUDA_ARCH__)
    const unsigned active = __activemask(), lane = threadIdx.x % 32;
    const int before = __shfl_up_sync(active, south, 1), after = __shfl_down_sync(active, south, 1);
    const Quanta received_south = __shfl_up_sync(active, south_east, 1),
                 received_north = __shfl_up_sync(active, north_east, 1);
    const bool receives = lane > 0 && (active >> (lane - 1) & 1u) && before + 1 == south;
    const bool sends = lane < 31 && (active >> (lane + 1) & 1u) && after == south + 1;
    (*this)(south, south_west + (receives ? received_south : 0));
    (*this)(south + width, north_west + (receives ? received_north : 0));
    if (!sends) {
      (*this)(south + 1, south_east);
      (*this)(south + width + 1, north_east);
    }
#else  // laws are compiled for the host, too, which never calls this
    (void)south, (void)width, (void)south_west, (void)south_east, (void)north_west, (void)north_east;
#endif
  }
};

template <class Law>
struct ScatterLaw {
  static constexpr bool compact_warps = CompactWarps<Law>::value;
  Law law;
  AtomicSums add;
  DESERT_HD void operator()(int x, int y) const {
    typename Law::template Parcels<1> parcel;
    law.prepare(x, y, parcel, 0);
    law.deliver(x, y, parcel, 0, add);
  }
};

/// The 256 threads of a block as the team that works on a tile. Its functions do what those of CpuTeam do.
/// They are marked for the host because laws are, but are empty there.
struct Team {
  static constexpr int patch_lanes = 1;
  char* scratch;

  template <class Body>
  DESERT_HD void for_each(int n, const Body& body) const {
#if defined(__CUDA_ARCH__)
    for (int i = threadIdx.y * block_x + threadIdx.x; i < n; i += block_x * block_y) body(i);
    __syncthreads();
#endif
  }
  template <class Value>
  DESERT_HD int min_of(int n, const Value& value) const {
#if defined(__CUDA_ARCH__)
    __shared__ int least;
    int mine = value(0);
    for (int i = threadIdx.y * block_x + threadIdx.x; i < n; i += block_x * block_y)
      mine = min(mine, value(i));
    if (threadIdx.x == 0 && threadIdx.y == 0) least = mine;
    __syncthreads();
    atomicMin(&least, mine);
    __syncthreads();
    mine = least;
    __syncthreads();
    return mine;
#else
    return 0;
#endif
  }
  template <class Value>
  DESERT_HD float max_of(int n, const Value& value) const {
    float greatest = 0;
#if defined(__CUDA_ARCH__)
    __shared__ int bits;  // floats that are not negative compare like their bits
    for (int i = threadIdx.y * block_x + threadIdx.x; i < n; i += block_x * block_y)
      greatest = fmaxf(greatest, value(i));
    if (threadIdx.x == 0 && threadIdx.y == 0) bits = 0;
    __syncthreads();
    atomicMax(&bits, __float_as_int(greatest));
    __syncthreads();
    greatest = __int_as_float(bits);
    __syncthreads();
#endif
    return greatest;
  }
  template <class Body>
  DESERT_HD void for_each(int width, int height, const Body& body) const {
    for_each(width * height, [&](int i) { body(i % width, i / width); });
  }
  template <class Value>
  DESERT_HD int min_of(int width, int height, const Value& value) const {
    return min_of(width * height, [&](int i) { return value(i % width, i / width); });
  }
  template <class Value>
  DESERT_HD void fetch_ahead(const Value*, int) const {}  ///< other threads work meanwhile
  /// Each warp takes one row at a time.
  template <class Body>
  DESERT_HD void for_each_row(const Body& body) const {
#if defined(__CUDA_ARCH__)
    for (int y = threadIdx.y; y < Tiles::side; y += block_y) body(y);
    __syncthreads();
#endif
  }
  template <int count, class Body>
  DESERT_HD void for_each_in_row(const Body& body) const {
#if defined(__CUDA_ARCH__)
    const int x = static_cast<int>(threadIdx.x);
    body(x / count, x % count);
#endif
  }
};
static_assert(Tiles::side == block_x, "a warp works along a row of a tile");

template <class Law>
__global__ void tiles_kernel(Law law) {
  extern __shared__ __align__(16) char scratch[];
  law(Team{scratch}, blockIdx.x, blockIdx.y);
}

template <class Law>
__global__ void items_kernel(int count, DESERT_GRID_CONSTANT const Law law) {
  const int n = blockIdx.x * blockDim.x + threadIdx.x;
  if (n < count) law(n);
}

/// Places of its own that a block has where a line has several, and lines that it then passes at once. More
/// places keep a multiprocessor longer for each line, and fewer lines take more launches: 64 and 32 were the
/// fastest from 512 to 4096 places (doc/notebook/kernel_experiments.md).
constexpr int places_of_a_line_block = 64, lines_at_once = 32;
/// Threads of a block that passes over lines.
template <class Law>
constexpr int longest_line_block = places_of_a_line_block + lines_at_once * 2 * Law::reach;

/// Where a block of threads passes over lines: its own places and, where a line has several blocks, `margin`
/// more at either side, so that it knows without the other blocks what reaches its own.
struct LineBlock {
  int first, end, length;  ///< of the lines, and of a line
  int own, margin;
  bool around;

  /// The place of a thread, which on a ring may lie a round before or behind.
  DESERT_HD int place(int block, int thread) const { return block * own - margin + thread; }
  DESERT_HD bool is_own(int block, int place) const {
    return place >= block * own && place < (block + 1) * own && place < length;
  }
};

/// What a thread of such a block finds in the line before. The places that can be seen do not change from
/// line to line, so that a compiler finds them once.
template <class Law, bool ring>
struct LineBefore {
  const Law& law;
  const typename Law::Word* words;
  int pitch, thread;
  int length;       ///< of a ring
  int first, last;  ///< threads at the ends of a line that is not one, or of the block

  DESERT_HD typename Law::Word operator()(int word, int further = 0) const {
    const int wanted = thread + further;
    if (ring) {
      int there = wanted;  // a ring of one place is passed as often as the law reaches
      for (int n = 0; n < Law::reach; ++n) there = wrap_once(there, length);
      return words[word * pitch + there];
    }
    const int there = wanted < first ? first : wanted > last ? last : wanted;
    const typename Law::Word value = words[word * pitch + there];
    return there == wanted ? value : law.beyond(word, value);
  }
};

/// What a thread hands on.
template <class Word>
struct LineAfter {
  Word* words;
  int pitch;

  DESERT_HD Word& operator()(int word) const { return words[word * pitch]; }
};

/// The words of a line that has been passed, as law.complete() takes them.
template <class Before, class Word>
struct LinePassed {
  Before beside;
  LineAfter<Word> own;

  DESERT_HD Word operator()(int word, int further) const { return beside(word, further); }
  DESERT_HD Word& operator()(int word) const { return own(word); }
};

/// Each thread has a place of a line. What a line hands on lies in shared memory, and the loads of the next
/// `ahead` lines are under way while one is passed: they take several times as long as that. The first line
/// of the block finds `from`, or what the law says if it begins the sweep; `to` gets what the last one hands
/// on. `ring`: the block passes the whole of lines that are rings. Threads that have no place of their own
/// repeat one, and store nothing.
template <class Law, bool ring>
__global__ void __launch_bounds__(longest_line_block<Law>)
    lines_kernel(LineBlock block, bool begins, LineWords<typename Law::Word> from,
                 LineWords<typename Law::Word> to, Law law) {
  using Word = typename Law::Word;
  constexpr int ahead = 4, words = Law::words;
  extern __shared__ __align__(16) char scratch[];
  auto* const memory = reinterpret_cast<Word*>(scratch);
  const int thread = threadIdx.x, pitch = blockDim.x, length = block.length;
  const int of_first = block.place(blockIdx.x, 0), width = block.own + 2 * block.margin;
  const int unwrapped = of_first + thread;
  const int place = block.around ? wrap(unwrapped, length) : clamp_index(unwrapped, length);
  const bool own = thread < width && block.is_own(blockIdx.x, unwrapped);
  const int first_thread = block.around ? 0 : max(0, -of_first),
            last_thread = block.around ? width - 1 : min(width, length - of_first) - 1;

  for (int w = 0; w < words; ++w)
    memory[w * pitch + thread] = begins ? law.before_first(w, place) : from(w, place);
  typename Law::Loaded loaded[ahead];
  const auto load = [&](int line) { return law.load(min(line, block.end - 1), place); };
#pragma unroll
  for (int d = 0; d < ahead; ++d) loaded[d] = load(block.first + d);
  __syncthreads();
  for (int first = block.first; first < block.end; first += ahead) {
#pragma unroll
    for (int d = 0; d < ahead; ++d) {
      const int line = first + d;
      if (line >= block.end) break;
      static_assert(ahead % 2 == 0, "lines take turns with two parts of the memory");
      Word* const old_words = memory + d % 2 * words * pitch;
      Word* const new_words = memory + (1 - d % 2) * words * pitch;
      using Before = LineBefore<Law, ring>;
      const auto of = [&](const Word* line_words) {
        return Before{law, line_words, pitch, thread, length, first_thread, last_thread};
      };
      const LineAfter<Word> after{new_words + thread, pitch};
      const auto result = law.pass(loaded[d], of(old_words), after);
      __syncthreads();
      if constexpr (CompletesLines<Law>::value) {
        law.complete(LinePassed<Before, Word>{of(new_words), after});
        __syncthreads();
      }
      loaded[d] = load(line + ahead);
      if (own) law.store(line, place, result);
    }
  }
  if (!own) return;
  const int last_part = (block.end - block.first) % 2 * words * pitch;
  for (int w = 0; w < words; ++w) to(w, place) = memory[last_part + w * pitch + thread];
}

template <class Law>
__global__ void sum_kernel(Grid grid, Law law, long long* total) {
  long long mine = 0;
  for (int y = blockIdx.y * block_y + threadIdx.y; y < grid.height; y += gridDim.y * block_y)
    for (int x = blockIdx.x * block_x + threadIdx.x; x < grid.width; x += gridDim.x * block_x)
      mine += law(x, y);
  for (int o = 16; o > 0; o /= 2) mine += __shfl_down_sync(0xffffffffu, mine, o);
  if (threadIdx.x == 0 && mine != 0) atomic_add(total, mine);
}

/// The maximum of the floats' bits, because floats that are not negative compare like their bits.
template <class Law>
__global__ void max_kernel(Grid grid, Law law, long long* largest) {
  float mine = 0;
  for (int y = blockIdx.y * block_y + threadIdx.y; y < grid.height; y += gridDim.y * block_y)
    for (int x = blockIdx.x * block_x + threadIdx.x; x < grid.width; x += gridDim.x * block_x) {
      const float value = law(x, y);
      mine = value > mine ? value : mine;
    }
  int bits = __float_as_int(mine);
  for (int o = 16; o > 0; o /= 2) bits = max(bits, __shfl_down_sync(0xffffffffu, bits, o));
  if (threadIdx.x == 0) atomicMax(reinterpret_cast<int*>(largest), bits);
}

inline dim3 reduction_blocks(const Grid& g) {
  const dim3 all = blocks(g);
  return dim3(all.x < 32 ? all.x : 32, all.y < 32 ? all.y : 32);
}

}  // namespace cuda

template <class Law>
void for_each_cell(CudaExec& exec, const Grid& grid, const Law& law) {
  const dim3 threads(cuda::block_x, cuda::warps_per_block<Law>);
  cuda::cells_kernel<<<cuda::blocks_of<Law>(grid), threads, 0, cuda::stream(exec)>>>(grid, law);
  check_cuda(cudaGetLastError(), "launch over cells");
}

template <class Law>
void for_each_cell_scatter(CudaExec& exec, const Grid& grid, Quanta* sums, const Law& law) {
  exec.set_zero(sums, sizeof(Quanta) * static_cast<std::size_t>(grid.cells()));
  for_each_cell(exec, grid, cuda::ScatterLaw<Law>{law, {sums}});
}

template <class Tiling, class Law>
void for_each_tile(CudaExec& exec, const Tiling& tiles, const Law& law) {
  constexpr int bytes = Law::template scratch_bytes<cuda::Team>;
  check_cuda(
      cudaFuncSetAttribute(cuda::tiles_kernel<Law>, cudaFuncAttributeMaxDynamicSharedMemorySize, bytes),
      "asking for shared memory");
  cuda::tiles_kernel<<<dim3(tiles.columns(), tiles.rows()), cuda::block(), bytes, cuda::stream(exec)>>>(law);
  check_cuda(cudaGetLastError(), "launch over tiles");
}

/// A short line is passed by a single block. The blocks of a longer one pass as many lines as their margins
/// allow without waiting for each other.
template <class Law>
void for_each_line_in_turn(CudaExec& exec, int first, int end, int length, typename Law::Word* words,
                           const Law& law) {
  using Words = LineWords<typename Law::Word>;
  const bool whole = length <= cuda::longest_line_block<Law>;
  cuda::LineBlock block{first, end, length, length, 0, law.around()};
  if (!whole) {
    block.margin = Law::reach * cuda::lines_at_once;
    block.own = cuda::places_of_a_line_block;
  }
  const int blocks = (length + block.own - 1) / block.own;
  const int threads = (block.own + 2 * block.margin + 31) / 32 * 32;
  const auto bytes = static_cast<std::size_t>(2 * Law::words * threads) * sizeof(typename Law::Word);
  Words from{words, length, Law::reach},
      to{words + words_of_line(Law::words, Law::reach, length), length, Law::reach};
  const auto kernel = whole && block.around ? cuda::lines_kernel<Law, true> : cuda::lines_kernel<Law, false>;
  for (int line = first; line < end; line = block.end) {
    block.first = line;
    block.end = whole ? end : std::min(line + cuda::lines_at_once, end);
    kernel<<<blocks, threads, bytes, cuda::stream(exec)>>>(block, line == first, from, to, law);
    check_cuda(cudaGetLastError(), "launch over lines");
    std::swap(from, to);
  }
}

template <class Law>
void for_each_item(CudaExec& exec, int count, const Law& law) {
  if (count == 0) return;
  constexpr int block = 128;
  cuda::items_kernel<<<(count + block - 1) / block, block, 0, cuda::stream(exec)>>>(count, law);
  check_cuda(cudaGetLastError(), "launch over items");
}

template <class Law>
long long sum_cells(CudaExec& exec, const Grid& grid, const Law& law) {
  exec.set_zero(exec.reduction_word(), sizeof(long long));
  cuda::sum_kernel<<<cuda::reduction_blocks(grid), cuda::block(), 0, cuda::stream(exec)>>>(
      grid, law, exec.reduction_word());
  check_cuda(cudaGetLastError(), "launch of a sum");
  return exec.read_reduction_word();
}

template <class Law>
float max_cells(CudaExec& exec, const Grid& grid, const Law& law) {
  exec.set_zero(exec.reduction_word(), sizeof(long long));
  cuda::max_kernel<<<cuda::reduction_blocks(grid), cuda::block(), 0, cuda::stream(exec)>>>(
      grid, law, exec.reduction_word());
  check_cuda(cudaGetLastError(), "launch of a maximum");
  const int bits = static_cast<int>(exec.read_reduction_word());
  float value;
  memcpy(&value, &bits, sizeof value);
  return value;
}

}  // namespace desert_sim
