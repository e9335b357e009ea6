#pragma once
/// Random commands that set parameters and wind, for tests of undo.

#include <random>
#include <string>

#include "src/simulation/commands/command.hpp"

namespace desert_sim::test {

/// Of every kind, in any order; some are refused. The layers of `run.hold_time` are left alone: after a
/// change of what holds them they are found anew.
class RandomSettings {
 public:
  explicit RandomSettings(unsigned seed) : random_(seed) {}
  Command next(const std::string& stroke);
  std::size_t below(std::size_t n) { return random_() % n; }
  float between(float low, float high) { return std::uniform_real_distribution<float>(low, high)(random_); }

 private:
  std::string setting();
  std::mt19937 random_;
};

}  // namespace desert_sim::test
