#pragma once
/// Atomic operations on memory that several cells write to at once, on the CPU and on the GPU.

#include <omp.h>

#include "kernels/base/macros.hpp"
#include "kernels/base/quanta.hpp"

namespace desert_sim {

/// Adds to a value atomically, and returns what it was before. Integer addition commutes, so the sum does not
/// depend on the order of threads.
template <class Integer>
DESERT_HD Integer atomic_add(Integer* to, Integer amount) {
#if defined(__CUDA_ARCH__)
  if constexpr (sizeof(Integer) == 8) {
    return static_cast<Integer>(
        atomicAdd(reinterpret_cast<unsigned long long*>(to), static_cast<unsigned long long>(amount)));
  } else {
    return atomicAdd(to, amount);
  }
#else
  return __atomic_fetch_add(to, amount, __ATOMIC_RELAXED);
#endif
}

/// A sum that is spread over `count` words, a power of two, because additions of many threads to the same
/// word wait for each other. Each thread of a CPU has a word of its own, in a line of the cache of its own as
/// long as there are `count`/8 threads or fewer; the threads of a warp on a GPU add up their amounts, and one
/// of them adds these. `number` tells such sums apart.
DESERT_HD void add_to_spread_sum(long long* words, int count, int number, int cell, Quanta amount) {
#if defined(__CUDA_ARCH__)
  const int place = (cell / 32) & (count - 1);
#if __CUDA_ARCH__ >= 800
  const unsigned active = __activemask();
  int same = 0;
  __match_all_sync(active, number, &same);
  if (same != 0) {
    // In two halves, whose sums fit into a word each.
    const int low = __reduce_add_sync(active, amount & 0xffff),
              high = __reduce_add_sync(active, amount >> 16);
    if (static_cast<int>(threadIdx.x % 32) == __ffs(static_cast<int>(active)) - 1)
      atomic_add(&words[place], static_cast<long long>(high) * 65536 + low);
    return;
  }
#endif
  atomic_add(&words[place], static_cast<long long>(amount));
#else
  (void)number, (void)cell;
  constexpr int words_of_a_cache_line = 8;
  const int thread = omp_get_thread_num() * words_of_a_cache_line;
  atomic_add(&words[(thread + thread / count) & (count - 1)], static_cast<long long>(amount));
#endif
}

/// Adds to a value that only cells of one row of for_each_cell() write to, and returns what it was before. A
/// CPU works on a row with one thread.
DESERT_HD int add_in_row(int* to, int amount) {
#if defined(__CUDA_ARCH__)
  return atomicAdd(to, amount);
#else
  const int before = *to;
  *to = before + amount;
  return before;
#endif
}

/// Raises a value to at least `value`, atomically.
template <class Integer>
DESERT_HD void atomic_max(Integer* to, Integer value) {
#if defined(__CUDA_ARCH__)
  atomicMax(to, value);
#else
  Integer before = __atomic_load_n(to, __ATOMIC_RELAXED);
  while (before < value &&
         !__atomic_compare_exchange_n(to, &before, value, true, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {
  }
#endif
}

/// Flags, 0 or 1, that several threads may raise at once. Testing a flag before raising it saves a write,
/// which would invalidate the cache line for all that only read it.
DESERT_HD bool is_flag_clear(const Quanta* flag) {
#if defined(__CUDA_ARCH__)
  return *flag == 0;
#else
  return __atomic_load_n(flag, __ATOMIC_RELAXED) == 0;
#endif
}
DESERT_HD void set_flag(Quanta* flag) {
#if defined(__CUDA_ARCH__)
  *flag = 1;
#else
  __atomic_store_n(flag, Quanta{1}, __ATOMIC_RELAXED);
#endif
}

}  // namespace desert_sim
