#pragma once
/// Random commands of every kind, with values at, near and beyond the limits of their ranges.

#include <random>
#include <string>
#include <type_traits>
#include <vector>

#include "src/simulation/simulation.hpp"

namespace desert_sim::test {

/// Of commands that can belong to a stroke.
template <class C, class = void>
constexpr bool has_stroke = false;
template <class C>
constexpr bool has_stroke<C, std::void_t<decltype(C::stroke)>> = true;

class RandomCommands {
 public:
  explicit RandomCommands(unsigned seed) : random_(seed) {}

  /// `checkpoints`, `scenarios`: files that may be loaded; those kinds of commands come only where there are
  /// any.
  Command next(const Simulation& simulation, const std::vector<std::string>& checkpoints,
               const std::vector<std::string>& scenarios);

  std::size_t below(std::size_t n) { return n > 0 ? random_() % n : 0; }
  bool one_in(std::size_t n) { return below(n) == 0; }
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  /// A number of a range, often a limit of it; rarely one out of it.
  double number(double lowest, double highest);
  template <class P>
  void randomise(P& parameters);

 private:
  command::SetWindSchedule schedule();
  command::EditWind wind_edit(const Simulation& simulation);
  command::EditTerrain terrain_edit(const Simulation& simulation);
  command::EditPlants plant_edit(const Simulation& simulation);
  std::string stroke();
  command::SetParameters settings(const Simulation& simulation);
  template <class Edit>
  void place(Edit& edit, const Simulation& simulation);
  template <class Edit>
  void add_points(Edit& edit);

  std::mt19937 random_;
};

}  // namespace desert_sim::test
