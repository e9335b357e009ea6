#pragma once
/// Two or four values beside each other, which a GPU moves at once.

#include <cstring>

#include "kernels/backend/macros.hpp"

namespace desert_sim {

template <class T, int count>
struct alignas(count * 4) Beside {
  static_assert(sizeof(T) == 4 && (count == 2 || count == 4));
  T values[count];
};
template <class T>
using Two = Beside<T, 2>;
template <class T>
using Four = Beside<T, 4>;

/// `from`: aligned to the size of what is read; likewise `to`.
template <int count, class T>
DESERT_HD Beside<T, count> beside_at(const T* from) {
#if defined(__CUDA_ARCH__)
  return *reinterpret_cast<const Beside<T, count>*>(from);
#else
  Beside<T, count> values;
  memcpy(&values, from, sizeof values);
  return values;
#endif
}
template <class T>
DESERT_HD Four<T> four_at(const T* from) {
  return beside_at<4>(from);
}
template <class T, int count>
DESERT_HD void put_beside(T* to, const Beside<T, count>& values) {
#if defined(__CUDA_ARCH__)
  *reinterpret_cast<Beside<T, count>*>(to) = values;
#else
  memcpy(to, &values, sizeof values);
#endif
}
template <class T>
DESERT_HD void put_four(T* to, const Four<T>& four) {
  put_beside(to, four);
}

}  // namespace desert_sim
