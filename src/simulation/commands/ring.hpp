#pragma once
/// The ring around an edit that conserves: what the shape gains, the ring loses, to the quantum.

#include <vector>

#include "kernels/base/quanta.hpp"

namespace desert_sim {

/// What the cells of a ring hold together.
struct RingTotals {
  long long cells = 0, stock = 0;  ///< [cells], [quanta]
};

/// `stock` has one value a cell: what it holds [quanta], or −1 where it is not of the ring.
RingTotals ring_totals(const std::vector<Quanta>& stock);

/// Changes the ring's cells by `amount` in all. Amounts that are given (> 0) are dealt in equal parts; what
/// is taken (< 0) comes in proportion to the stock and leaves no cell with less than nothing. Quanta that are
/// left over by rounding are dealt one by one, in the cells' order. There must be a cell, and with
/// amount < 0 a stock of at least −amount.
void distribute_to_ring(long long amount, const std::vector<Quanta>& stock, std::vector<Quanta>& change);

}  // namespace desert_sim
