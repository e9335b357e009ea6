#pragma once
/// Slab models of dunes: sand in slabs of equal height, stacked on the cells, of which one at a time is blown
/// a hop downwind. They take the place of saltation, reptation and avalanching.
///
///   poll       a cell that has a slab gives it to the wind; on average each is polled once in `poll_time`
///   hop        L cells downwind, again and again until the slab stays
///   stay       in the wind's shadow always, else with probability p_s where there is a slab, p_ns where not
///   shadow     cells below a line that falls by the angle `shadow_deg` from a cell upwind
///   repose     where a slab is taken or put down, the steepest slope to one of the four neighbours that is
///              steeper than `repose_deg` makes it roll down, or one from above takes its place
///
/// werner (Werner 1995) has hops of one length L_0 = `hop_time` · speed of the undisturbed wind. In momiji
/// (Momiji et al. 2000) and bishop (Bishop et al. 2002) no slab is taken from cells in the shadow, and hops
/// are longer over high ground: for a start at h, in slabs above h_ref,
///
///   L = L_0 + C_1 (h − h_ref) + C_2 (h − h_ref)²        the square only for h > h_ref
///
/// with h_ref the mean height h̄ of the ground (momiji), or h̄ − ½ mean |h − h̄| (bishop).
///
/// nield_baas (Nield & Baas 2008) and snow are werner with a resistance of the cells, by plants or as packed
/// snow, which the layer `sand` then holds; see resistance.hpp. Where plants are effective enough, repose is
/// `held_repose_deg`: on slopes down from such cells.
///
/// Slopes are those before the slab moves: seen after, no slope would be steep enough for a shadow.
///
/// Sequential models in parallel: 16 times in a `poll_time` all cells have their turn, colour by colour
/// (colours.hpp), so that no two that are worked on at once see each other. In its turn a cell is polled, as
/// often as Poisson's law has it. A slab or hole that rolls does so from cell to cell, in the turns of these.
/// After all colours, all slabs that were taken fly over resting ground to where they stay, and what they set
/// rolling has another turn. The shadow is found four times in a `poll_time`. Order and dice follow from the
/// seed: neither threads nor backends change a bit.
///
/// With `forced_erosion` further turns follow until as many slabs were taken as cells were polled, within the
/// scatter of Poisson's law, √polls. The last turns are shortened by the share of polls that took a slab in
/// the turn before. They end after a `poll_time` in which no slab was taken, or after 64 times as many turns.
///
/// Wind may blow in any direction: hops and shadows go along lines of cells (downwind.hpp) to the nearest
/// cell, each cell in exactly one line. A slab that flies against rock steeper than repose falls down before
/// it. Over an open edge slabs leave, and `saltation.influx` brings others.
///
/// Reads bedrock, soil, obstacle and sand; writes sand, the layers of resistance.hpp, and the undisturbed
/// wind to wind_x and wind_y.

#include "kernels/backend/buffer.hpp"
#include "kernels/field/dice.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/ledger.hpp"
#include "kernels/slabs/growth_curves.hpp"
#include "kernels/slabs/slab_parameters.hpp"
#include "kernels/wind/vector.hpp"

namespace desert_sim::slabs {

/// Turns in the time in which each cell is polled once, and turns for which the shadow is taken to be the
/// same. With 8 turns momiji's dunes grow visibly sooner than one poll after the other, with more no better.
constexpr int turns_a_poll = 16, turns_a_shadow = 4;
/// Bound of the turns of a step with forced erosion, over those without.
constexpr int most_forced_turns = 64;

/// Fields in the order of Lattice.
struct Workspace {
  Buffer<Quanta> height, base;        ///< of the surface, and of what slabs lie on [quanta]
  Buffer<Quanta> shade;               ///< height of the shadow over a cell [quanta]
  Buffer<std::uint8_t> state;         ///< whether a cell has a slab, and is in the shadow
  Buffer<std::uint32_t> pending;      ///< slabs that have come and do not rest yet, and holes · 2¹⁶
  Buffer<std::uint32_t> taken_cells;  ///< from which slabs were taken in a turn, line by line
  Buffer<int> taken_counts;           ///< of a line
  Buffer<Quanta> cliffs;              ///< whether there is any rock steeper than repose
  Buffer<float> resistance;           ///< R; empty for models without

  std::size_t bytes() const {
    return height.bytes() + base.bytes() + shade.bytes() + state.bytes() + pending.bytes() +
           taken_cells.bytes() + taken_counts.bytes() + cliffs.bytes() + resistance.bytes();
  }
};

/// `resists`: for a model with resistance.
Workspace make_workspace(Exec& exec, const Grid& grid, bool resists);

struct StepInputs {
  SlabKind kind;
  SlabModelParameters model;
  SlabPlantParameters plants;
  SlabSnowParameters snow;
  GrowthCurves curves;
  float influx;        ///< [m²/s] over an open windward edge
  float time_step;     ///< [s]
  wind::Vector above;  ///< undisturbed wind [m/s]
  int years = 0;       ///< that end with the step, after which plants grow
  int settlings = 0;   ///< settling times that end with it, after which snow settles
};

/// ρ_fresh of snow that fell at this temperature [°C; kg/m³].
float fresh_density(float temperature);

/// Writes wind_x and wind_y.
template <class E>
void blow(E& exec, const TerrainView& t, wind::Vector above);

/// Fills snow_density with that of fresh snow.
template <class E>
void lay_fresh_snow(E& exec, const TerrainView& t, const SlabSnowParameters& snow);

template <class E>
void step(E& exec, const TerrainView& t, const StepInputs& in, const Dice& dice, LedgerView ledger,
          Workspace& work);

}  // namespace desert_sim::slabs
