#pragma once
/// Atomic operations on memory that several cells write to at once, on the CPU and on the GPU.

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
