#pragma once
/// Worlds and random edits for tests of undo.

#include <random>
#include <string>
#include <vector>

#include "test/support/world.hpp"

namespace desert_sim::test {

/// A world in which much moves, by name: "dunes" (sand on rock, periodic), "valley" (soil, water and
/// obstacles, open), "garden" (plants that grow and spread), "meadow" (slabs and their plants).
std::string undo_world(const std::string& name);
constexpr const char* undo_worlds[] = {"dunes", "valley", "garden", "meadow"};

/// Random edits of everything that the world has, in all shapes and merges; some are refused.
class RandomStrokes {
 public:
  RandomStrokes(const Simulation& simulation, unsigned seed) : simulation_(simulation), random_(seed) {}
  Command next(const std::string& stroke);
  std::size_t below(std::size_t n) { return random_() % n; }
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

 private:
  template <class Edit>
  void place(Edit& edit);

  const Simulation& simulation_;
  std::mt19937 random_;
};

}  // namespace desert_sim::test
