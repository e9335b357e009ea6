#pragma once
/// What keeps slabs from the wind: plants (Nield & Baas 2008) and packed snow. Both are a resistance R of the
/// cell, with which the probabilities of bare sand become
///
///   p_e = 1 − R            that a slab that is polled is taken
///   p_d = p + R (1 − p)    that one that lands stays, with p = p_s or p_ns
///
/// both bounded to [0, 1].
///
/// Of plants, R is the sum of the layers grass, mesquite and shrub. At the end of a year each changes by its
/// growth curve (growth_curves.hpp) of the year's burial, within its range.
///
/// Of snow, R = (ρ − ρ_fresh) / (ρ_packed − ρ_fresh). Fresh snow has the density of Hedstrom & Pomeroy 1998,
///
///   ρ_fresh = 67.92 + 51.25 exp(T / 2.59)    [kg/m³], T: air temperature at which it fell [°C]
///
/// and settles by Anderson 1976, as in Jordan 1991 (c3, c4: there the coefficients of settling),
///
///   (1/ρ) dρ/dt = c3 exp(c4 T) · exp(−v (ρ − ρ_l))    the last only above ρ_l
///
/// T: its temperature [°C], c3 = `settling_rate`, c4 = `settling_warmth`, v = `stiffening`,
/// ρ_l = `loose_density`. The three numbers of ρ_fresh have no parameters: they are one fit to measurements.
/// Blown snow takes on the density of the cell that it comes to.

#include "kernels/field/layers.hpp"
#include "kernels/slabs/growth_curves.hpp"
#include "kernels/slabs/rolling.hpp"
#include "kernels/slabs/slab_model.hpp"

namespace desert_sim::slabs {

struct ResistanceOfPlants {
  Lattice lattice;
  const float *grass, *mesquite, *shrub;
  float* resistance;

  DESERT_HD void operator()(int x, int y) const {
    const int i = lattice.order.grid.index(x, y);
    resistance[lattice.slot_of(x, y)] = grass[i] + mesquite[i] + shrub[i];
  }
};

struct ResistanceOfSnow {
  Lattice lattice;
  const float* density;
  float fresh, packed;  ///< [kg/m³]
  float* resistance;

  DESERT_HD void operator()(int x, int y) const {
    const float above = density[lattice.order.grid.index(x, y)] - fresh;
    resistance[lattice.slot_of(x, y)] = above / (packed - fresh);
  }
};

/// One kind of plants, and the range of its effectiveness.
struct Growing {
  float* effectiveness;
  float lowest, highest;

  DESERT_HD void grow(int i, float change) const {
    effectiveness[i] = clamp(effectiveness[i] + change, lowest, highest);
  }
};

/// The growth of so many years with the same share each of the burial.
struct GrowPlants {
  Grid grid;
  GrowthCurves curves;
  Growing kinds[GrowthCurves::kinds];
  float years;
  float metres;  ///< of a quantum
  Quanta* burial;

  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    const float buried = static_cast<float>(burial[i]) * metres / years;
    burial[i] = 0;
    unrolled<GrowthCurves::kinds>([&](auto k)
                                      DESERT_INLINE { kinds[k].grow(i, years * curves.of[k].at(buried)); });
  }
};

/// The density of snow after x = c3 exp(c4 T) Δt. Below ρ_l it is exact; above, with ρ of its beginning in
/// dρ/dt, e^(v (ρ − ρ_l)) grows by v ρ x.
struct SettledSnow {
  float loose, slowing;  ///< ρ_l [kg/m³], v [m³/kg]

  static constexpr float least = 1.0f;  ///< there is no snow so light [kg/m³]

  DESERT_HD float operator()(float density, float x) const {
    if (density < least) return density;
    const float until_loose = density < loose ? logarithm(loose / density) : 0.0f;
    if (x < until_loose) return density / exp_negative(x);
    const float from = maximum(density, loose);
    const float slow = exp_negative(slowing * (from - loose));  // 1 / e^(v (ρ − ρ_l))
    return from + logarithm(1.0f + slow * slowing * from * (x - until_loose)) / slowing;
  }
};

struct SettleSnow {
  Grid grid;
  SettledSnow settled;
  float settling;  ///< x
  float* density;  ///< [kg/m³]

  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    density[i] = minimum(settled(density[i], settling), ice);
  }
  static constexpr float ice = 917.0f;  ///< [kg/m³]
};

struct FillDensity {
  Grid grid;
  float fresh;
  float* density;
  DESERT_HD void operator()(int x, int y) const { density[grid.index(x, y)] = fresh; }
};

/// R of all cells, for the models that have it.
template <class E>
void find_resistance(E& exec, const TerrainView& t, const StepInputs& in, const Lattice& lattice,
                     float* found);

/// Lets plants grow and snow settle, where their time ends with the step.
template <class E>
void change_resistance(E& exec, const TerrainView& t, const StepInputs& in);

}  // namespace desert_sim::slabs
