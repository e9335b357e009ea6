#include "test/support/bench_terrain.hpp"

#include <cstring>

namespace desert_sim::test {

BenchTerrain::BenchTerrain(Exec& exec, int width, int height, double cell_size, bool periodic)
    : terrain(exec, Grid{width, height, static_cast<float>(cell_size), periodic, periodic}, HeightScale{}),
      ledger_words(exec, LedgerView::words),
      landed(exec, cells()),
      strength(exec, cells()),
      repose(exec, cells()),
      cliff(exec, cells()),
      heights(surface::make_heights(exec, grid())),
      dice_keys_(exec, static_cast<std::size_t>(Roll::count)) {
  ledger_words.set_zero();
  for (Buffer<float>* buffer : {&strength, &repose, &cliff}) buffer->set_zero();
  for (Layer layer : {Layer::wind_shadow, Layer::echo}) terrain.allocate(layer);
}

Dice BenchTerrain::roll_dice() {
  return with_backend(exec(), [&](auto& e) { return dice::roll(e, 1, rolls_++, dice_keys_.data()); });
}

BenchTerrain& BenchTerrain::set(Layer layer, const std::function<double(int, int)>& f) {
  std::vector<double> values;
  for (int y = 0; y < grid().height; ++y)
    for (int x = 0; x < grid().width; ++x) values.push_back(f(x, y));
  terrain.set_values(layer, values);
  return *this;
}

BenchTerrain& BenchTerrain::set(Layer layer, double value) {
  return set(layer, [value](int, int) { return value; });
}

BenchTerrain& BenchTerrain::set_quanta(Layer layer, const std::function<Quanta(int, int)>& f) {
  std::vector<std::uint32_t> words;
  for (int y = 0; y < grid().height; ++y)
    for (int x = 0; x < grid().width; ++x) words.push_back(static_cast<std::uint32_t>(f(x, y)));
  terrain.set_raw_words(layer, words);
  return *this;
}

namespace {
void fill(Buffer<float>& buffer, const Grid& grid, const std::function<double(int, int)>& f) {
  std::vector<float> values;
  for (int y = 0; y < grid.height; ++y)
    for (int x = 0; x < grid.width; ++x) values.push_back(static_cast<float>(f(x, y)));
  buffer.upload(values);
}
}  // namespace

void BenchTerrain::set_strength(const std::function<double(int, int)>& f) { fill(strength, grid(), f); }
void BenchTerrain::set_repose(const std::function<double(int, int)>& f) { fill(repose, grid(), f); }

double BenchTerrain::at(Layer layer, int x, int y) const {
  return terrain.values(layer)[static_cast<std::size_t>(grid().index(x, y))];
}

std::vector<Quanta> BenchTerrain::quanta(Layer layer) const {
  std::vector<Quanta> values(cells(), 0);
  if (terrain.has(layer))
    std::memcpy(values.data(), terrain.raw_words(layer).data(), cells() * sizeof(Quanta));
  return values;
}

Quanta BenchTerrain::quanta_at(Layer layer, int x, int y) const {
  return quanta(layer)[static_cast<std::size_t>(grid().index(x, y))];
}

long long BenchTerrain::total(Layer layer) const {
  long long sum = 0;
  for (Quanta v : quanta(layer)) sum += v;
  return sum;
}

long long BenchTerrain::booked(Material material, int side) const {
  const std::vector<long long> words = ledger_words.download();
  const int account = static_cast<int>(material) * 2 + side;
  long long sum = 0;
  for (int n = 0; n < LedgerView::stripes; ++n)
    sum += words[static_cast<std::size_t>(account * LedgerView::stripes + n)];
  return sum;
}

void BenchTerrain::surface() {
  with_backend(exec(), [&](auto& e) {
    surface::fill_elevation(e, terrain.view());
    surface::compute_heights(e, terrain.view(), heights);
  });
}

void BenchTerrain::shadow(const WindShadowParameters& p, bool whole_marches) {
  surface();
  wind_shadow::Workspace work = wind_shadow::make_workspace(exec(), grid(), p);
  if (whole_marches) work.highest_nearby = {};
  with_backend(exec(), [&](auto& e) { wind_shadow::step(e, terrain.view(), p, heights, work); });
}

void BenchTerrain::judge(const TraversabilityParameters& p) {
  for (const LayerInfo& row : layer_table)
    if (row.lifetime == Lifetime::on_request) terrain.allocate(row.layer);
  with_backend(exec(), [&](auto& e) {
    traversability::step(e, terrain.view(), {p, {}, {}}, 0, grid().height);
  });
}
void BenchTerrain::echo(const EchoDuneParameters& p) {
  surface();
  with_backend(exec(), [&](auto& e) { echo_dunes::step(e, terrain.view(), p, heights, cliff.data()); });
}

void BenchTerrain::saltation(const SaltationParameters& p, const AbrasionParameters& a,
                             const ReposeParameters& r, float time_step, const EchoDuneParameters& echo) {
  with_backend(exec(), [&](auto& e) {
    const reptation::Angle angle({}, r, repose.data());
    const saltation::StepInputs in{
        p, a, r, echo, time_step, time_step, landed.data(), {angle, strength.data()}};
    saltation::step(e, terrain.view(), in, roll_dice(), ledger());
  });
}

void BenchTerrain::reptation(const ReptationParameters& p, const ReposeParameters& r, float time_step,
                             std::uint64_t tick) {
  with_backend(exec(), [&](auto& e) {
    reptation::set_angles(e, terrain.view(), reptation::Angle(p, r, repose.data()), r, strength.data());
    reptation::step(e, terrain.view(), p, {time_step, 1, tick, strength.data(), landed.data()}, roll_dice());
  });
}

int BenchTerrain::avalanche(const AvalanchingParameters& p, std::uint64_t tick) {
  avalanching::Workspace work = avalanching::make_workspace(exec(), grid(), p);
  with_backend(exec(),
               [&](auto& e) { avalanching::step(e, terrain.view(), p, tick, repose.data(), nullptr, work); });
  exec().synchronise();
  return work.iterations + static_cast<int>(work.counted_iterations());
}

void BenchTerrain::avalanche_soil(const AvalanchingParameters& p, const ReposeParameters& r) {
  avalanching::GroundWorkspace work = avalanching::make_ground_workspace(exec(), grid());
  Buffer<Quanta> given(exec(), static_cast<std::size_t>(grid().cells()));
  with_backend(exec(), [&](auto& e) { avalanching::step_soil(e, terrain.view(), p, r, given.data(), work); });
  exec().synchronise();
}

void BenchTerrain::avalanche_bedrock(const AvalanchingParameters& p, const ReposeParameters& r) {
  avalanching::GroundWorkspace work = avalanching::make_ground_workspace(exec(), grid());
  Buffer<Quanta> given(exec(), static_cast<std::size_t>(grid().cells()));
  with_backend(exec(), [&](auto& e) {
    avalanching::step_bedrock(e, terrain.view(), p, r, ledger(), given.data(), work);
  });
  exec().synchronise();
}

void BenchTerrain::flow(const WaterParameters& p, float time_step, double time, Quanta sea_level) {
  for (Layer layer : {Layer::water, Layer::water_flux_x, Layer::water_flux_y, Layer::water_velocity_x,
                      Layer::water_velocity_y, Layer::wind_x, Layer::wind_y})
    terrain.allocate(layer);
  const face_flow::StepInputs in{time_step, time, 7, rolls_++, sea_level, landed.data()};
  with_backend(exec(), [&](auto& e) {
    if (p.model == WaterModel::pipes) {
      virtual_pipes::Workspace work{Buffer<float>(exec(), cells())};
      virtual_pipes::step(e, terrain.view(), p, in, ledger(), work);
    } else {
      shallow_water::Workspace work(exec(), grid());
      shallow_water::step(e, terrain.view(), p, in, ledger(), work);
    }
  });
  exec().synchronise();
}

void BenchTerrain::erode(const HydraulicErosionParameters& p, float time_step) {
  for (Layer layer :
       {Layer::water, Layer::suspended_sediment, Layer::water_velocity_x, Layer::water_velocity_y})
    terrain.allocate(layer);
  hydraulic_erosion::Workspace work{Buffer<float>(exec(), cells())};
  with_backend(exec(), [&](auto& e) {
    hydraulic_erosion::step(e, terrain.view(), p, time_step, roll_dice(), ledger(), work);
  });
  exec().synchronise();
}

void BenchTerrain::soak(const MoistureParameters& p, float capacity, float time_step, float depth) {
  ReposeParameters r;
  r.moisture_capacity = capacity;
  r.moisture_depth = depth;
  for (Layer layer : {Layer::water, Layer::moisture}) terrain.allocate(layer);
  with_backend(exec(), [&](auto& e) {
    moisture::step(e, terrain.view(), p, {time_step, r, landed.data()}, roll_dice(), ledger());
  });
}

void BenchTerrain::develop_soil(const SoilParameters& p, const ReposeParameters& r, float time_step) {
  terrain.allocate(Layer::soil);
  with_backend(exec(),
               [&](auto& e) { soil::step(e, terrain.view(), p, r, time_step, roll_dice(), ledger()); });
}

void BenchTerrain::blow(const WindParameters& p, wind::Vector above, Quanta reference) {
  surface();
  wind::Workspace work = wind::make_workspace(exec(), grid(), p);
  const auto cells = static_cast<std::size_t>(grid().cells());
  Buffer<float> scratch(exec(), 2 * cells);
  with_backend(exec(), [&](auto& e) {
    wind::step(e, terrain.view(), p, {above, heights, reference}, {scratch.data(), scratch.data() + cells},
               work);
  });
  exec().synchronise();
}

void BenchTerrain::evaporate(float rate, float time_step) {
  with_backend(exec(), [&](auto& e) {
    water_sources::evaporate(e, terrain.view(), rate, time_step, roll_dice(), ledger());
  });
}

}  // namespace desert_sim::test
