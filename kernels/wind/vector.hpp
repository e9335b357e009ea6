#pragma once
/// A horizontal wind.

namespace desert_sim::wind {

/// A horizontal wind [m/s]; named `above`, the current high-altitude wind.
struct Vector {
  float x = 0, y = 0;
};

}  // namespace desert_sim::wind
