#pragma once
/// A small terrain with what single processes work with, for tests that run one process at a time.

#include <functional>
#include <vector>

#include "kernels/avalanching/avalanching.hpp"
#include "kernels/avalanching/soil_and_bedrock.hpp"
#include "kernels/edit/brush_smooth.hpp"
#include "kernels/field/random.hpp"
#include "kernels/field/statistics.hpp"
#include "kernels/field/surface.hpp"
#include "kernels/plants/cover.hpp"
#include "kernels/plants/illumination.hpp"
#include "kernels/plants/life.hpp"
#include "kernels/plants/marking.hpp"
#include "kernels/rover/traversability.hpp"
#include "kernels/sand/reptation.hpp"
#include "kernels/sand/saltation.hpp"
#include "kernels/soil/moisture.hpp"
#include "kernels/soil/soil.hpp"
#include "kernels/view/held_costs.hpp"
#include "kernels/view/held_layer.hpp"
#include "kernels/view/layer_values.hpp"
#include "kernels/water/hydraulic_erosion.hpp"
#include "kernels/water/rain.hpp"
#include "kernels/water/shallow_water.hpp"
#include "kernels/water/virtual_pipes.hpp"
#include "kernels/water/water_sources.hpp"
#include "kernels/wind/echo_dunes.hpp"
#include "kernels/wind/wind.hpp"
#include "kernels/wind/wind_features.hpp"
#include "kernels/wind/wind_shadow.hpp"
#include "src/terrain/terrain.hpp"

namespace desert_sim::test {

class BenchTerrain {
 public:
  BenchTerrain(Exec& exec, int width, int height, double cell_size = 1, bool periodic = true);

  Terrain terrain;
  Buffer<long long> ledger_words;
  Buffer<Quanta> landed;
  Buffer<float> strength, repose, cliff;
  surface::Heights heights;

  Exec& exec() const { return terrain.exec(); }
  const Grid& grid() const { return terrain.grid(); }
  std::size_t cells() const { return static_cast<std::size_t>(grid().cells()); }
  LedgerView ledger() const { return {ledger_words.data()}; }
  /// New dice at each call, as a simulation has in each step.
  Dice roll_dice();

  /// Sets a layer from f(x, y), in its unit.
  BenchTerrain& set(Layer layer, const std::function<double(int, int)>& f);
  BenchTerrain& set(Layer layer, double value);
  BenchTerrain& set_quanta(Layer layer, const std::function<Quanta(int, int)>& f);
  void set_strength(const std::function<double(int, int)>& f);
  void set_repose(const std::function<double(int, int)>& f);

  double at(Layer layer, int x, int y) const;  ///< in the layer's unit
  Quanta quanta_at(Layer layer, int x, int y) const;
  std::vector<Quanta> quanta(Layer layer) const;
  long long total(Layer layer) const;  ///< [quanta]
  /// Booked in (side 0) or out (side 1) of a material [quanta].
  long long booked(Material material, int side) const;

  void surface();
  /// `whole_marches`: no piece of a march is left out.
  void shadow(const WindShadowParameters& p = {}, bool whole_marches = false);
  /// Every layer that exists on request.
  void judge(const TraversabilityParameters& p = {});
  void echo(const EchoDuneParameters& p);
  void saltation(const SaltationParameters& p = {}, const AbrasionParameters& a = {},
                 const ReposeParameters& r = {}, float time_step = 1, const EchoDuneParameters& echo = {});
  void reptation(const ReptationParameters& p = {}, const ReposeParameters& r = {}, float time_step = 1,
                 std::uint64_t tick = 0);
  /// With the tangents in `repose`; returns the sweeps it took.
  int avalanche(const AvalanchingParameters& p, std::uint64_t tick = 0);
  void avalanche_soil(const AvalanchingParameters& p = {}, const ReposeParameters& r = {});
  void avalanche_bedrock(const AvalanchingParameters& p = {}, const ReposeParameters& r = {});
  /// Water flows for `time_step` from `time` on; brings what it needs into use.
  void flow(const WaterParameters& p, float time_step, double time = 0, Quanta sea_level = 0);
  void erode(const HydraulicErosionParameters& p, float time_step = 1);
  void soak(const MoistureParameters& p, float capacity = 0.3f, float time_step = 1, float depth = 1);
  void develop_soil(const SoilParameters& p, const ReposeParameters& r = {}, float time_step = 1);
  void blow(const WindParameters& p, wind::Vector above, Quanta reference = 0);
  void evaporate(float rate, float time_step = 1);

 private:
  Buffer<std::uint32_t> dice_keys_;
  std::uint64_t rolls_ = 0;
};

}  // namespace desert_sim::test
