#pragma once
/// Sand in slabs that random events move: the stochastic model of Paris et al. 2019 §5. Its expected values
/// are saltation.hpp, whose parameters it shares, except that slabs creep, that the wind is slower in the
/// shadow of higher ground, and that a slab on bare rock is taken again after ε/L on average, not after T.
///
///   lift       slabs of the depth ε leave a cell as a Poisson process of the rate L/(T ε), L being the lift
///              of saltation.hpp; the last one takes what is left of the sand
///   hop        by w (1 − r_s) T from where the slab is in the cell, with the standard deviation `hop_spread`
///              along each axis
///   deposit    with the probability p of saltation.hpp; otherwise the slab hops on, any number of times
///   abrasion   each bounce wears the ground as abrasion.hpp has it, p being 0 because the slab has bounced
///   reptation  each impact, of a bounce or a deposit, starts an event of creep.hpp with probability 1 − v,
///              which moves the depth `reptation.slab`
///
/// What is too steep then slides (avalanching.hpp). The paper's program works on one event after the other.
/// Here all events of an interval see the ground with which it began: a cell gives a slab once in at least
/// four intervals, a longer step is divided, and wind, shadow and avalanches follow each interval.
/// `ctest -R Desertscape` compares that with one event after the other.
///
/// The paper's probability of a deposit grows as plants vanish (f_V(x) = 1 − x), against its own text and
/// figures; here plants raise it to 1. A slab that has not come down after 64 bounces, which happens over
/// obstacles, stays in airborne_sand and flies on in the next step, as does sand that another model left
/// there.
///
/// Slabs are whole quanta. Cells take them from their own sand and add them to that of others, so that
/// neither threads nor backends change a bit. Slabs leave over open edges; `saltation.influx` brings slabs.
///
/// Reads and writes what saltation.hpp does, but neither tangents of repose nor the impact strength.

#include "kernels/backend/buffer.hpp"
#include "kernels/field/dice.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/ledger.hpp"
#include "kernels/sand/saltation.hpp"

namespace desert_sim {

struct DesertscapeParameters {
  float slab = 0.1f;
};

constexpr auto parameter_table(const DesertscapeParameters*) {
  using P = DesertscapeParameters;
  return std::make_tuple(
      parameter("slab", &P::slab, 0.001, 10, "m", "Sand that the wind lifts in one event (epsilon_S)."));
}
static_assert(table_is_complete<DesertscapeParameters>());

namespace desertscape {

struct Workspace {
  Buffer<Quanta> aloft;    ///< what leaves a cell [quanta]
  Buffer<Quanta> bounced;  ///< on it [quanta]

  std::size_t bytes() const { return aloft.bytes() + bounced.bytes(); }
};

Workspace make_workspace(Exec& exec, const Grid& grid);

/// Longest step [s], in which a fourth of the open cells gives a slab. Infinity where nothing is lifted.
float longest_step(const DesertscapeParameters& p, const SaltationParameters& saltation);

struct StepInputs {
  DesertscapeParameters desertscape;
  SaltationParameters saltation;
  AbrasionParameters abrasion;
  ReposeParameters repose;  ///< for the ground's capacity of moisture
  EchoDuneParameters echo;  ///< for the lift where sand is held
  float creeping;           ///< depth that an impact sets creeping [m]
  float time_step;          ///< [s]
  float flux_time;          ///< over which the layers flux_x and flux_y are a mean [s]
  Quanta* landed;           ///< scratch, one value a cell [quanta]
};

template <class E>
void step(E& exec, const TerrainView& t, const StepInputs& in, const Dice& dice, LedgerView ledger,
          Workspace& work);

}  // namespace desertscape
}  // namespace desert_sim
