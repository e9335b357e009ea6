#include "src/simulation/undo/material_return.hpp"

#include <algorithm>
#include <numeric>

#include "src/simulation/commands/ring.hpp"
#include "src/simulation/undo/cell_list.hpp"

namespace desert_sim {

namespace {

/// Those of the column, whose heights add up; and the others.
constexpr Layer column_layers[] = {Layer::bedrock, Layer::soil, Layer::sand, Layer::water},
                other_layers[] = {Layer::moisture, Layer::airborne_sand};
constexpr Quanta highest = wall_height - 1;

std::vector<int> cells_of(const std::vector<MaterialChange>& changes) {
  std::vector<int> cells;
  for (const MaterialChange& change : changes)
    for (const CellAmount& c : change.cells) cells.push_back(c.cell);
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

/// The columns of some cells, on the host.
class Columns {
 public:
  Columns(const std::vector<int>& cells, const Terrain& terrain)
      : cells_(cells), list_(terrain.exec(), cells), terrain_(terrain) {
    for (Layer layer : column_layers) read(layer, true);
    for (Layer layer : other_layers) read(layer, false);
  }

  std::size_t place_of(int cell) const {
    return static_cast<std::size_t>(std::lower_bound(cells_.begin(), cells_.end(), cell) - cells_.begin());
  }
  /// What can be taken from a layer.
  Quanta available(Layer layer, std::size_t place) const {
    const Quanta held = at(layer)[place];
    return std::max(0, layer == Layer::bedrock ? held + highest : held);
  }
  /// What can be put on it: neither the layer nor its column may rise above the highest height.
  Quanta room(Layer layer, std::size_t place) const {
    long long height = 0;
    for (const auto& depths : depths_)
      if (depths.in_column) height += depths.quanta[place];
    if (std::count(std::begin(other_layers), std::end(other_layers), layer) > 0) height = 0;
    const long long most = highest - std::max<long long>(height, at(layer)[place]);
    return static_cast<Quanta>(std::clamp<long long>(most, 0, highest));
  }
  void change(Layer layer, std::size_t place, Quanta by) { at(layer)[place] += by; }
  void write_back(Layer layer) const {
    const std::vector<Quanta>& quanta = at(layer);
    list_.write(terrain_.data(layer), std::vector<std::uint32_t>(quanta.begin(), quanta.end()));
  }

 private:
  struct Depths {
    Layer layer;
    bool in_column;
    std::vector<Quanta> quanta;
  };
  void read(Layer layer, bool in_column) {
    if (terrain_.has(layer))
      depths_.push_back({layer, in_column, as_quanta(list_.read(terrain_.data(layer)))});
  }
  static std::vector<Quanta> as_quanta(const std::vector<std::uint32_t>& words) {
    return std::vector<Quanta>(words.begin(), words.end());
  }
  const std::vector<Quanta>& at(Layer layer) const {
    return std::find_if(depths_.begin(), depths_.end(), [&](const Depths& d) { return d.layer == layer; })
        ->quanta;
  }
  std::vector<Quanta>& at(Layer layer) {
    return const_cast<std::vector<Quanta>&>(static_cast<const Columns*>(this)->at(layer));
  }

  const std::vector<int>& cells_;
  CellList list_;
  const Terrain& terrain_;
  std::vector<Depths> depths_;
};

/// The return of one layer's change: what each cell shall get (> 0) or lose (< 0), and what it did.
class LayerReturn {
 public:
  LayerReturn(MaterialChange& change, Columns& columns) : change_(change), columns_(columns) {
    for (const CellAmount& c : change.cells) places_.push_back(columns.place_of(c.cell));
    done_.assign(change.cells.size(), 0);
  }

  void take() {
    for (std::size_t k = 0; k < done_.size(); ++k) {
      if (wanted(k) >= 0) continue;
      done_[k] = -std::min(-wanted(k), columns_.available(change_.layer, places_[k]));
      columns_.change(change_.layer, places_[k], done_[k]);
    }
  }

  void give() {
    std::vector<Quanta> possible(done_.size(), -1);  // −1: of a cell that gets nothing, as of a ring
    for (std::size_t k = 0; k < done_.size(); ++k)
      if (wanted(k) > 0) possible[k] = std::min(wanted(k), columns_.room(change_.layer, places_[k]));
    if (change_.conserving) balance(possible);
    for (std::size_t k = 0; k < done_.size(); ++k) {
      if (possible[k] <= 0) continue;
      done_[k] = possible[k];
      columns_.change(change_.layer, places_[k], done_[k]);
    }
  }

  Layer layer() const { return change_.layer; }
  /// Writes the layer and makes the change what was done. Books it in the accounts.
  MaterialReturn commit(std::vector<long long>& accounts) {
    MaterialReturn told;
    long long untaken = 0, ungiven = 0;
    for (std::size_t k = 0; k < done_.size(); ++k) {
      (done_[k] > 0 ? told.added : told.removed) += std::abs(done_[k]);
      (wanted(k) > 0 ? ungiven : untaken) += std::abs(wanted(k) - done_[k]);
    }
    // What is missing in one place is missing in another, too, where material is conserved.
    told.missing = change_.conserving ? std::max(untaken, ungiven) : untaken + ungiven;
    book(untaken, ungiven, accounts);
    columns_.write_back(change_.layer);
    std::vector<CellAmount> cells;
    for (std::size_t k = 0; k < done_.size(); ++k)
      if (done_[k] != 0) cells.push_back({change_.cells[k].cell, done_[k]});
    change_.cells = std::move(cells);
    return told;
  }

 private:
  Quanta wanted(std::size_t k) const { return -change_.cells[k].amount; }

  /// Lets cells get as much as others lose: of the two sums the lesser.
  void balance(std::vector<Quanta>& possible) {
    std::vector<Quanta> taken(done_.size(), -1);
    for (std::size_t k = 0; k < done_.size(); ++k)
      if (wanted(k) < 0) taken[k] = -done_[k];
    const long long to_give = ring_totals(possible).stock, to_take = ring_totals(taken).stock,
                    moved = std::min(to_give, to_take);
    if (to_give > moved) possible = shares(moved, possible);
    if (to_take == moved) return;
    const std::vector<Quanta> kept = shares(moved, taken);
    for (std::size_t k = 0; k < done_.size(); ++k) {
      if (taken[k] < 0) continue;
      columns_.change(change_.layer, places_[k], taken[k] - kept[k]);
      done_[k] = -kept[k];
    }
  }
  static std::vector<Quanta> shares(long long amount, const std::vector<Quanta>& stock) {
    std::vector<Quanta> parts(stock.size(), 0);
    distribute_to_ring(-amount, stock, parts);
    for (Quanta& part : parts) part = -part;
    return parts;
  }

  /// Turns the bookings back. What could not be taken has stayed in the terrain, and what could not be given
  /// has stayed outside: a booking that would have told the opposite is lessened first.
  void book(long long untaken, long long ungiven, std::vector<long long>& accounts) {
    if (change_.conserving) return;
    long long in = -change_.in, out = -change_.out;
    const long long less_out = std::min(untaken, std::max(out, 0LL)),
                    less_in = std::min(ungiven, std::max(in, 0LL));
    out += ungiven - less_in - less_out;
    in += untaken - less_out - less_in;
    const auto account = 2 * static_cast<std::size_t>(material_of(change_.layer));
    accounts[account] += in;
    accounts[account + 1] += out;
    change_.in = in;
    change_.out = out;
  }

  MaterialChange& change_;
  Columns& columns_;
  std::vector<std::size_t> places_;
  std::vector<Quanta> done_;
};

}  // namespace

struct MaterialTurn::Work {
  SimulationState& state;
  std::vector<int> cells;
  Columns columns;
  std::vector<LayerReturn> layers;

  Work(std::vector<MaterialChange>& changes, SimulationState& of)
      : state(of), cells(cells_of(changes)), columns(cells, of.terrain) {
    layers.reserve(changes.size());
    for (MaterialChange& change : changes) layers.emplace_back(change, columns);
    // First all that is taken, so that columns never rise above what they were.
    for (LayerReturn& layer : layers) layer.take();
    for (LayerReturn& layer : layers) layer.give();
  }
};

MaterialTurn::MaterialTurn(std::vector<MaterialChange>& changes, SimulationState& state)
    : work_(changes.empty() ? nullptr : std::make_unique<Work>(changes, state)) {}
MaterialTurn::~MaterialTurn() = default;

MaterialReturns MaterialTurn::commit() {
  MaterialReturns told;
  if (!work_) return told;
  std::vector<long long> accounts = work_->state.read_ledger();
  for (LayerReturn& layer : work_->layers)
    told[static_cast<std::size_t>(material_of(layer.layer()))] += layer.commit(accounts);
  work_->state.write_ledger(accounts);
  return told;
}

}  // namespace desert_sim
