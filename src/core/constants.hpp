#pragma once
/// Mathematical constants.

namespace desert_sim {

constexpr double pi = 3.14159265358979323846;

}  // namespace desert_sim
