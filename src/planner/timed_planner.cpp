#include "src/planner/timed_planner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <tuple>
#include <utility>

#include "src/core/elementary.hpp"
#include "src/core/error.hpp"

namespace desert_sim {

namespace {

constexpr double never = std::numeric_limits<double>::infinity();

const CostGrid& first_grid(const TimedCosts& costs, const TimedParameters& p) {
  if (costs.grids.empty() || costs.grids.size() != costs.times.size())
    throw ConfigError("a forecast needs a grid of costs for each of its moments, and one at least");
  for (std::size_t n = 1; n < costs.times.size(); ++n) {
    if (!(costs.times[n] > costs.times[n - 1])) throw ConfigError("the times of a forecast do not rise");
    if (!(costs.grids[n]->frame() == costs.grids[0]->frame()))
      throw ConfigError("the grids of a forecast have different frames");
  }
  if (!(p.speed > 0) || !(p.slowing >= 0)) throw ConfigError("speed must be above 0, and slowing at least 0");
  return *costs.grids.front();
}

}  // namespace

/// A cell that can be reached at a time, in the safe interval that begins with a slot.
struct TimedPlanner::Label {
  double bound;  ///< arrival and what the way to the goal takes at least
  double arrival;
  CellIndex cell;
  std::size_t first;
  bool operator<(const Label& o) const {  // the next one is the largest
    return std::tie(bound, o.arrival, cell, first) > std::tie(o.bound, arrival, o.cell, o.first);
  }
};

struct TimedPlanner::Search {
  struct Reached {
    double arrival = never, departed = 0;  ///< departed: from the cell before
    std::uint32_t before = 0;              ///< number of that cell's interval
    bool closed = false;
  };
  std::size_t slots, begin;  ///< begin: number of the interval in which the rover is at first
  CellIndex goal;
  const std::vector<bool>& within;
  std::vector<Reached> reached = {};  ///< by cell, and first slot of the interval
  std::priority_queue<Label> open = {};
};

TimedPlanner::TimedPlanner(TimedCosts costs, const TimedParameters& parameters)
    : costs_(std::move(costs)), parameters_(parameters), frame_(first_grid(costs_, parameters)) {
  for (std::size_t n = 0; n < costs_.grids.size(); ++n) {
    std::vector<std::uint8_t> slot = costs_.grids[n]->costs();
    if (n + 1 < costs_.grids.size()) {
      const std::vector<std::uint8_t>& next = costs_.grids[n + 1]->costs();
      for (std::size_t i = 0; i < slot.size(); ++i)
        slot[i] = slot[i] == CostGrid::lethal || next[i] == CostGrid::lethal ? CostGrid::lethal
                                                                             : std::max(slot[i], next[i]);
    }
    worst_ = std::max<double>(worst_, *std::max_element(slot.begin(), slot.end()));
    slots_.push_back(std::move(slot));
  }
}

double TimedPlanner::end_of(std::size_t slot) const {
  return slot + 1 < costs_.times.size() ? costs_.times[slot + 1] : never;
}

std::size_t TimedPlanner::slot_at(double time) const {
  const auto after = std::upper_bound(costs_.times.begin(), costs_.times.end(), time);
  return static_cast<std::size_t>(std::max<std::ptrdiff_t>(after - costs_.times.begin() - 1, 0));
}

std::size_t TimedPlanner::first_of(CellIndex cell, std::size_t slot) const {
  while (slot > 0 && cost(cell, slot - 1) != CostGrid::lethal) --slot;
  return slot;
}

std::size_t TimedPlanner::last_of(CellIndex cell, std::size_t slot) const {
  while (slot + 1 < slots_.size() && cost(cell, slot + 1) != CostGrid::lethal) ++slot;
  return slot;
}

std::optional<double> TimedPlanner::arrival(CellIndex from, CellIndex to, double time, double length) const {
  const double range = std::max(worst_ - CostGrid::cheapest, 1.0);
  double rest = length;
  for (std::size_t slot = slot_at(time);; ++slot) {
    const std::uint8_t c = cost(from, slot);
    if (c == CostGrid::lethal || cost(to, slot) == CostGrid::lethal) return std::nullopt;
    const double speed = parameters_.speed / (1 + parameters_.slowing * (c - CostGrid::cheapest) / range);
    const double end = end_of(slot);
    if (time + rest / speed <= end) return time + rest / speed;
    rest -= (end - time) * speed;
    time = end;
  }
}

void TimedPlanner::expand(Search& search, const Label& label) const {
  const double cell_size = frame_.frame().cell_size;
  const std::size_t last = last_of(label.cell, label.first);
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      if (dx == 0 && dy == 0) continue;
      const auto to = static_cast<CellIndex>(static_cast<int>(label.cell) + dy * frame_.stride() + dx);
      if (!search.within.empty() && !search.within[to]) continue;
      const double length = (dx != 0 && dy != 0 ? std::sqrt(2.0) : 1.0) * cell_size;
      for (std::size_t slot = slot_at(label.arrival); slot <= last; ++slot) {
        if (cost(to, slot) == CostGrid::lethal) continue;
        const std::size_t first = first_of(to, slot);
        const double departure = std::max(label.arrival, costs_.times[slot]);
        slot = last_of(to, slot);  // the rest of this interval leads to nothing earlier
        const auto time = arrival(label.cell, to, departure, length);
        Search::Reached& there = search.reached[to * search.slots + first];
        if (!time || there.closed || *time >= there.arrival) continue;
        there.arrival = *time;
        there.departed = departure;
        there.before = static_cast<std::uint32_t>(label.cell * search.slots + label.first);
        const GridPoint p = frame_.centre(to), q = frame_.centre(search.goal);
        search.open.push(
            {*time + elementary::hypot(q.x - p.x, q.y - p.y) / parameters_.speed, *time, to, first});
      }
    }
}

void TimedPlanner::let_flee(CellIndex start) {
  constexpr int reach = 20;  // [cells]
  const int sx = frame_.x_of(start), sy = frame_.y_of(start);
  const GridFrame& f = frame_.frame();
  for (int y = std::max(sy - reach, 0); y <= std::min(sy + reach, f.height - 1); ++y)
    for (int x = std::max(sx - reach, 0); x <= std::min(sx + reach, f.width - 1); ++x) {
      const CellIndex cell = frame_.cell(x, y);
      if (slots_[0][cell] == CostGrid::lethal && frame_.cost(cell) != CostGrid::lethal)
        slots_[0][cell] = static_cast<std::uint8_t>(worst_);
    }
}

std::vector<TimedPoint> TimedPlanner::path_to(const Search& search, std::size_t interval,
                                              double departure) const {
  std::vector<TimedPoint> path;
  for (std::size_t at = interval;; at = search.reached[at].before) {
    const Search::Reached& r = search.reached[at];
    path.push_back({frame_.centre(static_cast<CellIndex>(at / search.slots)), r.arrival, departure});
    if (at == search.begin) break;
    departure = r.departed;
  }
  std::reverse(path.begin(), path.end());
  return path;
}

std::vector<TimedPoint> TimedPlanner::plan(CellIndex start, CellIndex goal, const std::vector<bool>& within) {
  expanded_ = 0;
  shelter_.clear();
  if (cost(start, 0) == CostGrid::lethal) let_flee(start);
  if (cost(start, 0) == CostGrid::lethal) return {};
  Search search{slots_.size(), start * slots_.size(), goal, within};
  search.reached.resize(frame_.size() * search.slots);
  const double now = costs_.times.front();
  search.reached[search.begin].arrival = now;
  search.open.push({now, now, start, 0});
  const GridPoint q = frame_.centre(goal);
  std::size_t shelter = search.begin;
  double nearest = never;
  while (!search.open.empty()) {
    const Label label = search.open.top();
    search.open.pop();
    const std::size_t interval = label.cell * search.slots + label.first;
    Search::Reached& here = search.reached[interval];
    if (here.closed) continue;
    here.closed = true;
    ++expanded_;
    if (label.cell == goal) return path_to(search, interval, here.arrival);
    expand(search, label);
    const GridPoint p = frame_.centre(label.cell);
    const double distance = elementary::hypot(q.x - p.x, q.y - p.y);
    if (distance < nearest && last_of(label.cell, label.first) + 1 == search.slots) {
      nearest = distance;
      shelter = interval;
    }
  }
  if (nearest < never) shelter_ = path_to(search, shelter, never);
  return {};
}

}  // namespace desert_sim
