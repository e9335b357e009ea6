/// What resists the wind, and what time makes of it; compiled once for each backend.
#include "kernels/slabs/resistance.hpp"

#include "kernels/backend/loops.hpp"
#include "src/core/elementary.hpp"

namespace desert_sim::slabs {

template <class E>
void find_resistance(E& exec, const TerrainView& t, const StepInputs& in, const Lattice& lattice,
                     float* found) {
  if (in.kind == SlabKind::nield_baas)
    for_each_cell(exec, t.grid,
                  ResistanceOfPlants{lattice, t.real(Layer::grass), t.real(Layer::mesquite),
                                     t.real(Layer::shrub), found});
  if (in.kind == SlabKind::snow)
    for_each_cell(exec, t.grid,
                  ResistanceOfSnow{lattice, t.real(Layer::snow_density),
                                   fresh_density(in.snow.fall_temperature), in.snow.packed_density, found});
}

template <class E>
void change_resistance(E& exec, const TerrainView& t, const StepInputs& in) {
  const auto growing = [&](Layer layer) {
    return Growing{t.real(layer), static_cast<float>(info(layer).lowest),
                   static_cast<float>(info(layer).highest)};
  };
  if (in.kind == SlabKind::nield_baas && in.years > 0)
    for_each_cell(exec, t.grid,
                  GrowPlants{t.grid,
                             in.curves,
                             {growing(Layer::grass), growing(Layer::mesquite), growing(Layer::shrub)},
                             static_cast<float>(in.years),
                             t.quantum,
                             t.quanta(Layer::burial)});
  if (in.kind == SlabKind::snow && in.settlings > 0) {
    const double rate = in.snow.settling_rate *
                        elementary::exp(in.snow.settling_warmth * static_cast<double>(in.snow.temperature));
    for_each_cell(exec, t.grid,
                  SettleSnow{t.grid,
                             {in.snow.loose_density, in.snow.stiffening},
                             static_cast<float>(rate * in.settlings * in.snow.settling_time),
                             t.real(Layer::snow_density)});
  }
}

template <class E>
void lay_fresh_snow(E& exec, const TerrainView& t, const SlabSnowParameters& snow) {
  for_each_cell(exec, t.grid,
                FillDensity{t.grid, fresh_density(snow.fall_temperature), t.real(Layer::snow_density)});
}

template void find_resistance(Backend&, const TerrainView&, const StepInputs&, const Lattice&, float*);
template void change_resistance(Backend&, const TerrainView&, const StepInputs&);
template void lay_fresh_snow(Backend&, const TerrainView&, const SlabSnowParameters&);

}  // namespace desert_sim::slabs
