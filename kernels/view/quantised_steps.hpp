#pragma once
/// Incremental updates of a value in quantised steps. Sender and receiver compute the same bits.

#include "kernels/base/macros.hpp"

namespace desert_sim {

/// New value of a cell that held `held`, after `change` steps of `resolution`; `change` is a whole number,
/// −128 … 127.
DESERT_HD float apply_steps(float held, float change, float resolution) {
  return static_cast<float>(static_cast<double>(held) +
                            static_cast<double>(change) * static_cast<double>(resolution));
}

/// Largest change, in steps, that a signed integer of `bits` bits can express.
DESERT_HD constexpr int max_steps(int bits) { return (1 << (bits - 1)) - 1; }

}  // namespace desert_sim
