#pragma once
/// Ripples and bumps of a scene in the memory of a backend. Cells are computed when beams may reach them, a
/// tile at a time, and kept until the state of the terrain is another.

#include <memory>
#include <vector>

#include "kernels/backend/buffer.hpp"
#include "kernels/backend/exec.hpp"
#include "kernels/rover/ray_micro_relief.hpp"
#include "src/simulation/views/micro_relief_cells.hpp"

namespace desert_sim {

class SceneMicroRelief {
 public:
  /// Keeps a reference to `exec`.
  SceneMicroRelief(Exec& exec, std::shared_ptr<const MicroReliefSource> source);
  /// Another state of the same grid.
  void set(std::shared_ptr<const MicroReliefSource> source);

  /// The ground for so many beams that go at most `reach` metres from a point of the terrain's frame, with
  /// the device's pointers; until the next call of within() or set().
  ray_march::RippledGround within(double x, double y, double reach, std::size_t beams);
  /// Cells that have been computed since set().
  std::size_t computed_cells() const { return computed_cells_; }

 private:
  using Rectangle = MicroReliefSource::Rectangle;
  static constexpr int side = 32;  ///< of a tile [cells]

  void take_feet();
  std::vector<char> tiles_along(double place, double reach, const micro_relief::Axis& axis) const;
  void compute_cells(double x, double y, double reach);
  void compute(const Rectangle& cells);
  static micro_relief::SquareBox squares_around(const micro_relief::Lattice& lattice, double x, double y,
                                                double reach, std::size_t beams);
  void upload(const std::vector<float>& values, const Rectangle& cells, float* layer);

  Exec& exec_;
  std::shared_ptr<const MicroReliefSource> source_;
  micro_relief::Relief relief_;
  std::unique_ptr<const MicroReliefCells> law_;
  const int columns_, rows_;    ///< of tiles
  std::vector<char> computed_;  ///< whether a tile has its values
  std::size_t computed_cells_ = 0;
  std::vector<Buffer<float>> layers_;      ///< those of relief_.cells, of the whole grid
  std::shared_ptr<const PlantFeet> feet_;  ///< those in feet_numbers_
  Buffer<micro_relief::FootNumber> feet_numbers_;
  Buffer<micro_relief::RipplePatch> patches_;  ///< of the last call of within()
  Buffer<micro_relief::Bump> bumps_;
  Buffer<float> staging_;  ///< values on their way to the device
};

}  // namespace desert_sim
