#include "src/simulation/undo/stroke.hpp"

#include <algorithm>

#include "src/core/error.hpp"

namespace desert_sim {

Material material_of(Layer layer) {
  switch (layer) {
    case Layer::bedrock:
      return Material::bedrock;
    case Layer::soil:
      return Material::soil;
    case Layer::sand:
    case Layer::airborne_sand:
      return Material::sand;
    case Layer::water:
      return Material::water;
    case Layer::moisture:
      return Material::moisture;
    default:
      throw Error(std::string("the layer ") + info(layer).name + " is no material that brushes edit");
  }
}

namespace {

/// The sums of two lists; cells that come to 0 are left out.
std::vector<CellAmount> sums(const std::vector<CellAmount>& a, const std::vector<CellAmount>& b) {
  std::vector<CellAmount> all;
  all.reserve(a.size() + b.size());
  auto p = a.begin(), q = b.begin();
  while (p != a.end() || q != b.end()) {
    if (q == b.end() || (p != a.end() && p->cell < q->cell)) {
      all.push_back(*p++);
    } else if (p == a.end() || q->cell < p->cell) {
      all.push_back(*q++);
    } else {
      if (p->amount + q->amount != 0) all.push_back({p->cell, p->amount + q->amount});
      ++p, ++q;
    }
  }
  return all;
}

}  // namespace

void Stroke::add(Layer layer, const std::vector<CellAmount>& cells, bool conserve) {
  auto at = std::find_if(materials.begin(), materials.end(),
                         [layer](const MaterialChange& change) { return change.layer == layer; });
  if (at == materials.end()) at = materials.insert(at, MaterialChange{layer, {}, 0, 0, true});
  at->cells = sums(at->cells, cells);
  if (conserve) return;
  at->conserving = false;
  for (const CellAmount& c : cells) (c.amount > 0 ? at->in : at->out) += std::abs(c.amount);
}

bool Stroke::has_room(Layer layer, const std::vector<CellAmount>& cells) const {
  for (const MaterialChange& change : materials) {
    if (change.layer != layer) continue;
    auto held = change.cells.begin();
    for (const CellAmount& c : cells) {
      while (held != change.cells.end() && held->cell < c.cell) ++held;
      if (held == change.cells.end()) break;
      if (held->cell == c.cell && std::abs(static_cast<long long>(held->amount) + c.amount) >= wall_height)
        return false;
    }
  }
  return true;
}

bool Stroke::changed(Layer layer) const {
  const auto is_it = [layer](const auto& change) { return change.layer == layer; };
  return std::any_of(materials.begin(), materials.end(), is_it) ||
         std::any_of(painted.begin(), painted.end(), is_it);
}

std::vector<PaintedCell>& Stroke::painted_in(Layer layer) {
  const auto at = std::find_if(painted.begin(), painted.end(),
                               [layer](const PaintedLayer& other) { return other.layer == layer; });
  return (at == painted.end() ? painted.emplace_back(PaintedLayer{layer, {}}) : *at).cells;
}

std::size_t Stroke::bytes() const {
  std::size_t total = sizeof(Stroke) + name.size();
  for (const MaterialChange& change : materials)
    total += sizeof(MaterialChange) + change.cells.size() * sizeof(CellAmount);
  for (const PaintedLayer& layer : painted) total += layer.cells.size() * sizeof(PaintedCell);
  for (const ChangedSetting& setting : settings)
    total += sizeof(ChangedSetting) + setting.key.size() + (setting.before ? setting.before->size() : 0) +
             (setting.after ? setting.after->size() : 0);
  for (const std::string& kind : species) total += sizeof(std::string) + kind.size();
  total += new_layers.size() * sizeof(Layer);
  total += (plants.added.size() + plants.removed.size() + plants.passed.size()) * sizeof(ChangedPlant);
  return total;
}

}  // namespace desert_sim
