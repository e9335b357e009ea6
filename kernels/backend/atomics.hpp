#pragma once
/// Memory that several cells write to at once, on the CPU and on the GPU.

#include "kernels/backend/macros.hpp"
#include "kernels/field/quanta.hpp"

namespace desert_sim {

/// Adds to memory that other cells add to as well, and returns what was there before. Integers commute, so
/// the order can't matter to the sum.
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

/// Raises memory that other cells raise as well.
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

/// Flags, 0 or 1, that other cells may raise as well. Whoever asks first spares those who only read a write.
DESERT_HD bool is_lowered(const Quanta* flag) {
#if defined(__CUDA_ARCH__)
  return *flag == 0;
#else
  return __atomic_load_n(flag, __ATOMIC_RELAXED) == 0;
#endif
}
DESERT_HD void raise_flag(Quanta* flag) {
#if defined(__CUDA_ARCH__)
  *flag = 1;
#else
  __atomic_store_n(flag, Quanta{1}, __ATOMIC_RELAXED);
#endif
}

}  // namespace desert_sim
