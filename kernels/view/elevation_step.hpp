#pragma once
/// How an elevation that somebody holds follows the terrain, in steps. The one who sends them and the one who
/// takes them compute the same bits.

#include "kernels/backend/macros.hpp"

namespace desert_sim {

/// What a cell that held `held` holds after `change` steps of `resolution` [m]; a whole number, −128 … 127.
DESERT_HD float changed_elevation(float held, float change, float resolution) {
  return static_cast<float>(static_cast<double>(held) +
                            static_cast<double>(change) * static_cast<double>(resolution));
}

/// The largest change that so many bits tell, in steps.
DESERT_HD constexpr int most_steps(int bits) { return (1 << (bits - 1)) - 1; }

}  // namespace desert_sim
