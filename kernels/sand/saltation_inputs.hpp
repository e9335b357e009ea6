#pragma once
/// Layers that the laws of saltation read, and the factor by which moisture reduces lift and deposition.

#include "kernels/base/math.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/sand/abrasion.hpp"
#include "kernels/sand/repose.hpp"

namespace desert_sim::saltation {

DESERT_HD float dryness(float relative_moisture) {
  return clamp(1.0f - 10.0f * relative_moisture, 0.0f, 1.0f);
}

/// Layers that the laws read. `bare` is a desert of rock and sand alone, without the optional layers and
/// without abrasion; laws for it are compiled without the tests for these.
template <bool bare>
struct Inputs {
  Grid grid;
  float quantum, quanta_per_metre;
  float hop_time;   ///< T [s]
  float hop_share;  ///< φ, at most 1
  const float *wind_x, *wind_y, *wind_shadow, *echo, *vegetation, *obstacle;
  const Quanta *water, *soil;
  repose::RelativeMoisture relative_moisture;

  Inputs(const TerrainView& t, const ReposeParameters& repose, float time, float share)
      : grid(t.grid),
        quantum(t.quantum),
        quanta_per_metre(t.quanta_per_metre),
        hop_time(time),
        hop_share(share),
        wind_x(t.real(Layer::wind_x)),
        wind_y(t.real(Layer::wind_y)),
        wind_shadow(t.real(Layer::wind_shadow)),
        echo(t.real(Layer::echo)),
        vegetation(t.real(Layer::vegetation)),
        obstacle(t.real(Layer::obstacle)),
        water(t.quanta(Layer::water)),
        soil(t.quanta(Layer::soil)),
        relative_moisture(t, repose) {}

  template <class Value>
  DESERT_HD Value value_if_present(const Value* layer, int i) const {
    return bare ? Value{} : value_or_zero(layer, i);
  }
  DESERT_HD float plants(int i) const { return value_if_present(vegetation, i); }
  DESERT_HD float echo_value(int i) const { return value_if_present(echo, i); }
  DESERT_HD bool solid(int i) const { return value_if_present(obstacle, i) > 0.0f; }
  DESERT_HD float moisture(int i) const { return bare ? 0.0f : relative_moisture(i); }
  DESERT_HD bool flooded(int i) const { return value_if_present(water, i) * quantum > wet_depth; }
};

inline bool is_bare(const TerrainView& t, const AbrasionParameters& a) {
  if (a.wears_ground()) return false;
  for (Layer layer : {Layer::echo, Layer::vegetation, Layer::obstacle})
    if (t.real(layer)) return false;
  for (Layer layer : {Layer::water, Layer::soil, Layer::moisture})
    if (t.quanta(layer)) return false;
  return true;
}

/// Abrasion by what the wind carries in `time` [s].
inline abrasion::Abrade abrade_for(const TerrainView& t, const AbrasionParameters& a, float time, Die die,
                                   LedgerView ledger) {
  return {a.rate * time,
          a.rate_of_soil() * time,
          to_quanta_at_most(a.cover, t.quanta_per_metre, wall_height),
          t.quantum,
          t.quanta_per_metre,
          t.quanta(Layer::bedrock),
          t.quanta(Layer::soil),
          t.quanta(Layer::sand),
          t.real(Layer::erosion_resistance),
          die,
          ledger};
}

}  // namespace desert_sim::saltation
