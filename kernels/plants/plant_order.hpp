#pragma once
/// Keeps plants sorted by their key in the neighbour look-up, so that neighbours are close in memory. The
/// sort is stable, so that the order of plants, and with it every sum, depends on the state alone.

#include "kernels/plants/workspace.hpp"

namespace desert_sim::plants {

/// Sorts the first `all` plants of next_state() by key into plants(); `dead` of them have died and are
/// dropped.
template <class E>
void sort_plants(E& exec, int all, int dead, Workspace& work);

}  // namespace desert_sim::plants
