#include "src/simulation/views/snapshot.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/field/surface.hpp"
#include "kernels/plants/marking.hpp"
#include "kernels/rover/traversability.hpp"
#include "kernels/sand/saltation.hpp"
#include "kernels/view/layer_values.hpp"
#include "src/render/colour.hpp"
#include "src/scenario/appearance.hpp"
#include "src/simulation/views/view_sections.hpp"
#include "src/simulation/views/views.hpp"

namespace desert_sim {

const std::vector<float>* Snapshot::find(Layer layer) const {
  const auto found = layers.find(layer);
  return found == layers.end() ? nullptr : &found->second;
}

namespace {

/// What a band comes to on this grid.
bool on_request(Layer layer) { return info(layer).lifetime == Lifetime::on_request; }

}  // namespace

RowBand clamp_band(const RowBand& band, int height, bool periodic_y) {
  if (band.count <= 0 || (periodic_y && band.count >= height)) return {0, height};
  if (periodic_y) return band;
  const int first = clamp_index(band.first, height);
  return {first, std::max(1, std::min(band.first + band.count, height) - first)};
}

bool Views::shows(Layer layer) const {
  if (layer == Layer::plants) return static_cast<bool>(state_.plants);
  return on_request(layer) || state_.terrain.has(layer);
}

std::shared_ptr<Snapshot> Views::make_empty_snapshot(const std::vector<Layer>& layers,
                                                     const RowBand& rows) const {
  auto s = std::make_shared<Snapshot>();
  const GridParameters& g = state_.scenario.grid;
  const Grid& grid = state_.terrain.grid();
  s->width = g.width;
  s->height = rows.count;
  s->cell_size = g.cell_size;
  s->origin_x = g.origin_x;
  s->origin_y = g.origin_y + rows.first * g.cell_size;
  s->periodic_x = grid.periodic_x;
  s->periodic_y = grid.periodic_y && rows.count == grid.height;
  s->step = state_.steps;
  s->time = state_.time();
  s->wind_above = state_.wind_above();
  s->wind_features = state_.scenario.wind_features;
  s->micro_relief = {state_.scenario.get<MicroReliefParameters>(),
                     state_.scenario.seed,
                     state_.ripple_wind,
                     repose::Tangents::tangent(state_.scenario.get<ReposeParameters>().sand_deg),
                     state_.scenario.get<ReposeParameters>().moisture_capacity,
                     state_.scenario.get<ReposeParameters>().moisture_depth,
                     state_.scenario.get<SaltationParameters>().moisture_cutoff,
                     g.height,
                     rows.first,
                     g.origin_y,
                     grid.periodic_y,
                     static_cast<bool>(state_.plants)};
  for (const Species& species : state_.scenario.species) {
    const render::Colour crown = render::crown_colour(species.appearance.hue);
    s->crown_colours.push_back({crown.r, crown.g, crown.b});
  }
  const auto& appearance = state_.scenario.get<AppearanceParameters>();
  s->palette = palette_of(appearance);
  s->wind_arrows = appearance.wind_arrows;
  for (Layer layer : layers) s->layers[layer];
  return s;
}

PendingSnapshot Views::begin_snapshot(const std::vector<Layer>& layers, const RowBand& band, bool feet) {
  const Grid& grid = state_.terrain.grid();
  const RowBand rows = clamp_band(band, grid.height, grid.periodic_y);
  const std::shared_ptr<Snapshot> snapshot = make_empty_snapshot(layers, rows);
  update_layers(layers, rows);
  auto readback = std::make_shared<Readback>();
  if (feet && snapshot->micro_relief.needs_feet()) send_feet(*snapshot, rows, readback);
  if (layers.empty()) return {snapshot, readback};
  const std::size_t row_bytes =
      snapshot->layers.size() * static_cast<std::size_t>(snapshot->width) * sizeof(float);
  const int most = static_cast<int>(
      std::clamp<std::size_t>(staging_.slot_bytes() / row_bytes, 1, static_cast<std::size_t>(rows.count)));
  for (int row = 0; row < rows.count; row += most)
    send_rows(snapshot, {rows.first + row, std::min(most, rows.count - row)}, readback);
  return {snapshot, readback};
}

void Views::send_rows(const std::shared_ptr<Snapshot>& snapshot, const RowBand& rows,
                      const std::shared_ptr<Readback>& readback) {
  const std::size_t cells = static_cast<std::size_t>(snapshot->width) * static_cast<std::size_t>(rows.count),
                    bytes = snapshot->layers.size() * cells * sizeof(float);
  Staging::Slot& slot = staging_.acquire(bytes);
  float* to = reinterpret_cast<float*>(slot.device());
  for (const auto& entry : snapshot->layers) {
    const Layer layer = entry.first;
    with_backend(state_.exec(), [&](auto& e) {
      layer_values::step(e, state_.terrain.view(), layer, state_.terrain.metres(layer), rows.first,
                         rows.count, to);
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

namespace {

/// The rows of squares in which a band of a terrain's rows lies.
RowBand rows_of_squares(const micro_relief::Axis& squares, const RowBand& band, double cell_size) {
  const auto row = [&](int cell) {
    return static_cast<int>(std::floor(cell * cell_size * squares.parts_per_metre));
  };
  const int first = row(band.first);
  return clamp_band({first, row(band.first + band.count) + 1 - first}, squares.count, squares.periodic);
}

}  // namespace

void Views::send_feet(Snapshot& snapshot, const RowBand& rows, const std::shared_ptr<Readback>& readback) {
  using micro_relief::FootNumber;
  const micro_relief::Lattice squares =
      snapshot.micro_relief.bump_squares(snapshot.width, snapshot.cell_size, snapshot.periodic_x);
  const RowBand all = rows_of_squares(squares.y, rows, snapshot.cell_size);
  const auto feet = std::make_shared<PlantFeet>();
  feet->first_row = squares.row_anywhere(all.first);
  feet->rows = all.count;
  snapshot.feet = feet;
  const plants::View& view = state_.plants.plants();
  const micro_relief::Plants plants{view.x, view.y, view.radius, state_.plants.count};
  const std::size_t row_numbers = static_cast<std::size_t>(squares.x.count);
  const int most = static_cast<int>(std::clamp<std::size_t>(
      staging_.slot_bytes() / (row_numbers * sizeof(FootNumber)), 1, static_cast<std::size_t>(all.count)));
  for (int row = 0; row < all.count; row += most) {
    const int count = std::min(most, all.count - row);
    const std::size_t numbers = row_numbers * static_cast<std::size_t>(count),
                      bytes = numbers * sizeof(FootNumber);
    Staging::Slot& slot = staging_.acquire(bytes);
    with_backend(state_.exec(), [&](auto& e) {
      micro_relief::find_feet(e, squares, plants, squares.row_anywhere(all.first + row), count,
                              reinterpret_cast<FootNumber*>(slot.device()));
    });
    staging_.send(slot, bytes, readback,
                  [waited = std::weak_ptr<PlantFeet>(feet), bytes, numbers](auto& arrived) {
                    const std::shared_ptr<PlantFeet> found = waited.lock();
                    if (!found) return;
                    const auto* from = reinterpret_cast<const FootNumber*>(arrived.host(bytes));
                    found->widest.insert(found->widest.end(), from, from + numbers);
                  });
  }
}

PendingPlants Views::begin_plants() {
  auto list = std::make_shared<PlantList>();
  list->origin_x = state_.scenario.grid.origin_x;
  list->origin_y = state_.scenario.grid.origin_y;
  list->step = state_.steps;
  list->time = state_.time();
  if (state_.plants) list->species = state_.scenario.species;
  auto readback = std::make_shared<Readback>();
  const int most =
      static_cast<int>(std::max<std::size_t>(1, staging_.slot_bytes() / sizeof(plants::PlantRecord)));
  for (int first = 0; first < state_.plants.count; first += most) {
    const int count = std::min(most, state_.plants.count - first);
    const std::size_t bytes = static_cast<std::size_t>(count) * sizeof(plants::PlantRecord);
    Staging::Slot& slot = staging_.acquire(bytes);
    with_backend(state_.exec(), [&](auto& e) {
      plants::export_plants(e, state_.plants.plants(), state_.terrain.metres(Layer::bedrock), first, count,
                            reinterpret_cast<plants::PlantRecord*>(slot.device()));
    });
    staging_.send(slot, bytes, readback,
                  [waited = std::weak_ptr<PlantList>(list), bytes, count](auto& arrived) {
                    const std::shared_ptr<PlantList> all = waited.lock();
                    if (!all) return;
                    const auto* from = reinterpret_cast<const plants::PlantRecord*>(arrived.host(bytes));
                    all->plants.insert(all->plants.end(), from, from + count);
                  });
  }
  return {list, readback};
}

void Views::update_layers(const std::vector<Layer>& layers, const RowBand& rows) {
  pipeline_.refresh_derived();
  std::vector<Layer> requested;
  for (Layer layer : layers)
    if (on_request(layer) && shows(layer)) requested.push_back(layer);
  if (!requested.empty()) compute_requested_layers(requested, rows);
}

/// All of `layers` exist on request.
void Views::compute_requested_layers(const std::vector<Layer>& layers, const RowBand& rows) {
  for (Layer layer : layers) state_.terrain.allocate(layer);
  TerrainView view = state_.terrain.view();
  for (const LayerInfo& row : layer_table)
    if (on_request(row.layer) && std::count(layers.begin(), layers.end(), row.layer) == 0)
      view.layers[static_cast<int>(row.layer)] = nullptr;
  with_backend(state_.exec(), [&](auto& e) {
    surface::fill_elevation(e, view);
    traversability::step(e, view, rover_of(state_.scenario), rows.first, rows.count);
    if (view.quanta(Layer::water_surface)) surface::fill_water_surface(e, view, rows.first, rows.count);
    if (state_.plants && view.real(Layer::plants))
      plants::find_dominant_species(e, view, rows.first, rows.count, state_.plants.neighbourhood(),
                                    state_.plants.plants(), state_.plants.species.data());
  });
}

void Views::release_requested_layers() {
  state_.exec().synchronise();
  for (const LayerInfo& row : layer_table)
    if (on_request(row.layer)) state_.terrain.set_allocated(row.layer, false);
}

std::vector<MemoryPart> Views::memory() const {
  std::vector<MemoryPart> parts;
  const auto add = [&parts](const char* name, std::size_t bytes) {
    if (bytes > 0) parts.push_back({name, bytes});
  };
  std::size_t held = 0;
  for (const auto& entry : held_) held += entry.second.bytes();
  add("layers that subscribers hold", held);
  add("costs that subscribers hold", costs_.bytes());
  add("staging memory", staging_.bytes());
  return parts;
}

}  // namespace desert_sim
