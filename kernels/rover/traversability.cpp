/// The step of traversability.hpp; compiled once for each backend.
#include "kernels/rover/traversability.hpp"

#include "kernels/backend/loops.hpp"
#include "kernels/rover/traversability_laws.hpp"

namespace desert_sim::traversability {

template <class E>
void step(E& exec, const TerrainView& t, const Rover& rover, int first, int rows) {
  const Traversability traversability_law = make_law(t, rover);
  const Orientation orientation{traversability_law.roughness.surface, t.real(Layer::slope),
                                t.real(Layer::normal_x), t.real(Layer::normal_y), t.real(Layer::normal_z)};
  const auto run = [&](const auto& of_cell, bool wanted) {
    if (wanted) for_each_cell_of_rows(exec, t.grid, first, rows, of_cell);
  };
  run(orientation, orientation.slope || orientation.normal_x || orientation.normal_y || orientation.normal_z);
  run(traversability_law.roughness, traversability_law.roughness.roughness != nullptr);
  run(traversability_law.step_height, traversability_law.step_height.step_height != nullptr);
  const WheelLayers wheels{traversability_law.wheels, t.real(Layer::slip), t.real(Layer::slip_downhill),
                           t.real(Layer::slip_across), t.real(Layer::sinkage)};
  run(wheels, wheels.slip || wheels.slip_downhill || wheels.slip_across || wheels.sinkage);
  run(traversability_law, traversability_law.traversability != nullptr);
}

template void step(Backend&, const TerrainView&, const Rover&, int, int);

}  // namespace desert_sim::traversability
