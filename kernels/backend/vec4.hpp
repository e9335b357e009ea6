#pragma once
/// Vectors of two or four consecutive values, which a GPU loads and stores with one instruction.

#include <cstring>

#include "kernels/base/macros.hpp"

namespace desert_sim {

template <class T, int count>
struct alignas(count * 4) PackedVec {
  static_assert(sizeof(T) == 4 && (count == 2 || count == 4));
  T values[count];
};
template <class T>
using Vec2 = PackedVec<T, 2>;
template <class T>
using Vec4 = PackedVec<T, 4>;

/// Vector loads and stores. `from` and `to` must be aligned to the size of the vector.
template <int count, class T>
DESERT_HD PackedVec<T, count> load_vec(const T* from) {
#if defined(__CUDA_ARCH__)
  return *reinterpret_cast<const PackedVec<T, count>*>(from);
#else
  PackedVec<T, count> values;
  memcpy(&values, from, sizeof values);
  return values;
#endif
}
template <class T>
DESERT_HD Vec4<T> load_vec4(const T* from) {
  return load_vec<4>(from);
}
template <class T, int count>
DESERT_HD void store_vec(T* to, const PackedVec<T, count>& values) {
#if defined(__CUDA_ARCH__)
  *reinterpret_cast<PackedVec<T, count>*>(to) = values;
#else
  memcpy(to, &values, sizeof values);
#endif
}
template <class T>
DESERT_HD void store_vec4(T* to, const Vec4<T>& four) {
  store_vec(to, four);
}

}  // namespace desert_sim
