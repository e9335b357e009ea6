#pragma once
/// Single cells of a layer: reads and writes the words of a list of cells, so that an edit of few cells need
/// not copy whole layers between device and host.

#include <cstdint>

#include "kernels/backend/exec.hpp"

namespace desert_sim::brush {

/// words[n] = layer[cells[n]] for n < count. All pointers are on the device.
template <class E>
void gather(E& exec, const std::uint32_t* layer, const int* cells, int count, std::uint32_t* words);

/// layer[cells[n]] = words[n] for n < count; no cell may be listed twice.
template <class E>
void scatter(E& exec, std::uint32_t* layer, const int* cells, int count, const std::uint32_t* words);

}  // namespace desert_sim::brush
