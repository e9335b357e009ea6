#pragma once
/// Layers that the laws of saltation read, and the factor by which moisture reduces lift and deposition.

#include "kernels/base/math.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/sand/abrasion.hpp"
#include "kernels/sand/repose.hpp"
#include "kernels/sand/saltation.hpp"

namespace desert_sim::saltation {

/// M of saltation.hpp.
struct Dryness {
  float per_moisture;  ///< 1/m_c

  explicit Dryness(float moisture_cutoff) : per_moisture(1.0f / moisture_cutoff) {}
  DESERT_HD float operator()(float relative_moisture) const {
    return clamp(1.0f - per_moisture * relative_moisture, 0.0f, 1.0f);
  }
};

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
  Dryness dryness_of;
  float sticky_lift;  ///< share of the lift that is left where sand is held

  Inputs(const TerrainView& t, const ReposeParameters& repose, const SaltationParameters& p,
         const EchoDuneParameters& echo_dunes, float time, float share)
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
        relative_moisture(t, repose),
        dryness_of(p.moisture_cutoff),
        sticky_lift(echo_dunes.sticky_lift) {}

  template <class Value>
  DESERT_HD Value value_if_present(const Value* layer, int i) const {
    return bare ? Value{} : value_or_zero(layer, i);
  }
  DESERT_HD float plants(int i) const { return value_if_present(vegetation, i); }
  DESERT_HD float echo_value(int i) const { return value_if_present(echo, i); }
  DESERT_HD bool solid(int i) const { return value_if_present(obstacle, i) > 0.0f; }
  DESERT_HD float moisture(int i) const { return bare ? 0.0f : relative_moisture(i); }
  DESERT_HD float dryness(float m) const { return bare ? 1.0f : dryness_of(m); }
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
          1.0f / a.moisture_cutoff,
          a.most_bouncing,
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
