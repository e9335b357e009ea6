#pragma once
/// Four values beside each other, which a GPU moves at once.

#include <cstring>

#include "desert_sim/kernels/macros.hpp"

namespace desert_sim {

template <class T>
struct alignas(16) Four {
  T values[4];
};
/// `from`: aligned to 16 bytes.
template <class T>
DESERT_HD Four<T> four_at(const T* from) {
#if defined(__CUDA_ARCH__)
  return *reinterpret_cast<const Four<T>*>(from);
#else
  Four<T> four;
  memcpy(&four, from, sizeof four);
  return four;
#endif
}
template <class T>
DESERT_HD void put_four(T* to, const Four<T>& four) {
#if defined(__CUDA_ARCH__)
  *reinterpret_cast<Four<T>*>(to) = four;
#else
  memcpy(to, &four, sizeof four);
#endif
}

}  // namespace desert_sim
