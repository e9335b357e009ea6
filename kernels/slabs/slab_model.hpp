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
/// Slopes are those before the slab moves: seen after, no slope would be steep enough for a shadow.
///
/// Sequential models in parallel: the terrain is divided into blocks of at least 8 × 8 cells, anew in each
/// step, and the blocks have four colours like a chessboard of two. Those of one colour lie at least 8 cells
/// apart. One thread polls a block's cells in turn, and rolls slabs at most four cells out of it; from there
/// the block they have come to goes on. Then all slabs that were taken fly over resting ground and are
/// counted where they land, and come to rest when that block's turn comes. Each colour has its turn 16 times
/// in a `poll_time`, and the shadow is found four times. Order and dice follow from the seed: neither threads
/// nor backends change a bit.
///
/// Wind may blow in any direction: hops and shadows go along lines of cells (downwind.hpp) to the nearest
/// cell, each cell in exactly one line. A slab that flies against rock steeper than repose falls down before
/// it. Over an open edge slabs leave, and `saltation.influx` brings others.
///
/// Reads bedrock, soil, obstacle and sand; writes sand, and the undisturbed wind to wind_x and wind_y.

#include "kernels/backend/buffer.hpp"
#include "kernels/field/dice.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/ledger.hpp"
#include "kernels/slabs/slab_parameters.hpp"
#include "kernels/wind/vector.hpp"

namespace desert_sim::slabs {

/// Rounds of turns of all colours in the time in which each cell is polled once, and rounds for which the
/// shadow is taken to be the same. With 8 rounds dunes grow visibly later than one poll after the other; with
/// more than 16 no earlier.
constexpr int rounds_a_poll = 16, rounds_a_shadow = 4;

/// Fields in the order of a sweep downwind.
struct Workspace {
  Buffer<Quanta> height, sand;     ///< of the surface, and of the sand in it [quanta]
  Buffer<Quanta> shade;            ///< height of the shadow over a cell [quanta]
  Buffer<std::uint32_t> arriving;  ///< slabs that come to rest here, and holes · 2¹⁶ that roll on from here
  Buffer<int> taken;               ///< cells from which slabs were taken in a turn, or −1
  Buffer<Quanta> lines;            ///< of the sweep
  Buffer<Quanta> cliffs;           ///< whether there is any rock steeper than repose

  std::size_t bytes() const {
    return height.bytes() + sand.bytes() + shade.bytes() + arriving.bytes() + taken.bytes() + lines.bytes() +
           cliffs.bytes();
  }
};

Workspace make_workspace(Exec& exec, const Grid& grid);

struct StepInputs {
  SlabModelParameters model;
  float influx;        ///< [m²/s] over an open windward edge
  float time_step;     ///< [s]
  wind::Vector above;  ///< undisturbed wind [m/s]
};

/// Writes wind_x and wind_y.
template <class E>
void blow(E& exec, const TerrainView& t, wind::Vector above);

template <class E>
void step(E& exec, const TerrainView& t, const StepInputs& in, const Dice& dice, LedgerView ledger,
          Workspace& work);

}  // namespace desert_sim::slabs
