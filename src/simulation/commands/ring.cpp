#include "src/simulation/commands/ring.hpp"

#include <cmath>

namespace desert_sim {

RingTotals ring_totals(const std::vector<Quanta>& stock) {
  RingTotals totals;
  for (const Quanta held : stock) {
    if (held < 0) continue;
    ++totals.cells;
    totals.stock += held;
  }
  return totals;
}

namespace {

void add_evenly(long long amount, long long cells, const std::vector<Quanta>& stock,
                std::vector<Quanta>& change) {
  const long long part = amount / cells;
  long long remaining = amount % cells;
  for (std::size_t k = 0; k < stock.size(); ++k)
    if (stock[k] >= 0) change[k] = static_cast<Quanta>(part + (remaining-- > 0 ? 1 : 0));
}

void remove_proportionally(long long amount, long long held, const std::vector<Quanta>& stock,
                           std::vector<Quanta>& change) {
  // A little less than the exact share, so that rounding never takes too much.
  const double share = static_cast<double>(amount) / static_cast<double>(held) * (1 - std::ldexp(1.0, -50));
  long long remaining = amount;
  for (std::size_t k = 0; k < stock.size(); ++k)
    if (stock[k] >= 0) {
      change[k] = -static_cast<Quanta>(std::floor(stock[k] * share));
      remaining += change[k];
    }
  while (remaining > 0)
    for (std::size_t k = 0; k < stock.size() && remaining > 0; ++k)
      if (stock[k] + change[k] > 0 && stock[k] >= 0) --change[k], --remaining;
}

}  // namespace

void distribute_to_ring(long long amount, const std::vector<Quanta>& stock, std::vector<Quanta>& change) {
  const RingTotals totals = ring_totals(stock);
  if (amount > 0) add_evenly(amount, totals.cells, stock, change);
  if (amount < 0) remove_proportionally(-amount, totals.stock, stock, change);
}

}  // namespace desert_sim
