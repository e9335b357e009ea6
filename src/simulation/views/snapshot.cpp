/// Snapshots of a simulation.
#include "src/simulation/views/snapshot.hpp"

#include <algorithm>

#include "src/simulation/simulation.hpp"

namespace desert_sim {

const std::vector<float>* Snapshot::find(Layer layer) const {
  const auto found = layers.find(layer);
  return found == layers.end() ? nullptr : &found->second;
}

namespace {

/// What a band comes to on this grid.
RowBand held_to(const RowBand& band, const Grid& grid) {
  if (band.count <= 0 || (grid.periodic_y && band.count >= grid.height)) return {0, grid.height};
  if (grid.periodic_y) return band;
  const int first = clamp_index(band.first, grid.height);
  return {first, std::max(1, std::min(band.first + band.count, grid.height) - first)};
}

bool on_request(Layer layer) { return info(layer).lifetime == Lifetime::on_request; }

}  // namespace

bool Simulation::shows(Layer layer) const {
  if (layer == Layer::plants) return static_cast<bool>(plants_);
  return on_request(layer) || terrain_.has(layer);
}

std::shared_ptr<Snapshot> Simulation::frame_of(const std::vector<Layer>& layers, const RowBand& rows) const {
  auto s = std::make_shared<Snapshot>();
  const GridParameters& g = scenario_.grid;
  const Grid& grid = terrain_.grid();
  s->width = g.width;
  s->height = rows.count;
  s->cell_size = g.cell_size;
  s->origin_x = g.origin_x;
  s->origin_y = g.origin_y + rows.first * g.cell_size;
  s->periodic_x = grid.periodic_x;
  s->periodic_y = grid.periodic_y && rows.count == grid.height;
  s->step = steps_;
  s->time = time();
  s->wind_above = wind_above();
  for (const Species& species : scenario_.species) s->crown_colours.push_back(crown_colour(species.look));
  for (Layer layer : layers) s->layers[layer];
  return s;
}

PendingSnapshot Simulation::begin_snapshot(const std::vector<Layer>& layers, const RowBand& band) {
  const RowBand rows = held_to(band, terrain_.grid());
  const std::shared_ptr<Snapshot> snapshot = frame_of(layers, rows);
  refresh_derived();
  const bool judged = std::any_of(layers.begin(), layers.end(), on_request);
  if (judged) judge(layers, rows);
  auto readback = std::make_shared<Readback>();
  if (layers.empty()) return {snapshot, readback};
  const std::size_t row_bytes =
      snapshot->layers.size() * static_cast<std::size_t>(snapshot->width) * sizeof(float);
  const int most = static_cast<int>(
      std::clamp<std::size_t>(staging_.slot_bytes() / row_bytes, 1, static_cast<std::size_t>(rows.count)));
  for (int row = 0; row < rows.count; row += most)
    send_rows(snapshot, {rows.first + row, std::min(most, rows.count - row)}, readback);
  return {snapshot, readback};
}

void Simulation::send_rows(const std::shared_ptr<Snapshot>& snapshot, const RowBand& rows,
                           const std::shared_ptr<Readback>& readback) {
  const std::size_t cells = static_cast<std::size_t>(snapshot->width) * static_cast<std::size_t>(rows.count),
                    bytes = snapshot->layers.size() * cells * sizeof(float);
  Staging::Slot& slot = staging_.next(bytes);
  float* to = reinterpret_cast<float*>(slot.device());
  for (const auto& entry : snapshot->layers) {
    const Layer layer = entry.first;
    with_backend(exec(), [&](auto& e) {
      layer_values::step(e, terrain_.view(), layer, terrain_.metres(layer), rows.first, rows.count, to);
    });
    to += cells;
  }
  // If nobody waits for the snapshot any more, it is gone.
  staging_.send(slot, bytes, readback, [waited = std::weak_ptr<Snapshot>(snapshot), cells](auto& arrived) {
    const std::shared_ptr<Snapshot> s = waited.lock();
    if (!s) return;
    const float* from =
        reinterpret_cast<const float*>(arrived.host(s->layers.size() * cells * sizeof(float)));
    for (auto& [layer, values] : s->layers) {
      values.reserve(static_cast<std::size_t>(s->width) * static_cast<std::size_t>(s->height));
      values.insert(values.end(), from, from + cells);
      from += cells;
    }
  });
}

PendingPlants Simulation::begin_plants() {
  auto list = std::make_shared<PlantList>();
  list->origin_x = scenario_.grid.origin_x;
  list->origin_y = scenario_.grid.origin_y;
  list->step = steps_;
  list->time = time();
  if (plants_) list->species = scenario_.species;
  auto readback = std::make_shared<Readback>();
  const int most = static_cast<int>(std::max<std::size_t>(1, staging_.slot_bytes() / sizeof(plants::Listed)));
  for (int first = 0; first < plants_.count; first += most) {
    const int count = std::min(most, plants_.count - first);
    const std::size_t bytes = static_cast<std::size_t>(count) * sizeof(plants::Listed);
    Staging::Slot& slot = staging_.next(bytes);
    with_backend(exec(), [&](auto& e) {
      plants::list(e, plants_.plants(), terrain_.metres(Layer::bedrock), first, count,
                   reinterpret_cast<plants::Listed*>(slot.device()));
    });
    staging_.send(slot, bytes, readback,
                  [waited = std::weak_ptr<PlantList>(list), bytes, count](auto& arrived) {
                    const std::shared_ptr<PlantList> all = waited.lock();
                    if (!all) return;
                    const auto* from = reinterpret_cast<const plants::Listed*>(arrived.host(bytes));
                    all->plants.insert(all->plants.end(), from, from + count);
                  });
  }
  return {list, readback};
}

void Simulation::judge(const std::vector<Layer>& layers, const RowBand& rows) {
  for (Layer layer : layers)
    if (on_request(layer)) terrain_.require(layer);
  TerrainView view = terrain_.view();
  for (const LayerInfo& row : layer_table)
    if (on_request(row.layer) && std::count(layers.begin(), layers.end(), row.layer) == 0)
      view.layers[static_cast<int>(row.layer)] = nullptr;
  with_backend(exec(), [&](auto& e) {
    surface::fill_elevation(e, view);
    traversability::step(e, view, scenario_.traversability, scenario_.repose, rows.first, rows.count);
    if (view.quanta(Layer::water_surface)) surface::fill_water_surface(e, view, rows.first, rows.count);
    if (plants_ && view.real(Layer::plants))
      plants::mark_species(e, view, rows.first, rows.count, plants_.neighbourhood(), plants_.plants(),
                           plants_.species.data());
  });
}

void Simulation::release_requested_layers() {
  exec().synchronise();
  for (const LayerInfo& row : layer_table)
    if (on_request(row.layer)) terrain_.use(row.layer, false);
}

}  // namespace desert_sim
