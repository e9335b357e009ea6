#include "src/simulation/pipeline/memory.hpp"

#include <algorithm>
#include <cstdio>

#include "kernels/backend/fft.hpp"
#include "src/core/error.hpp"

namespace desert_sim {

namespace {

template <class T>
std::size_t bytes_of(const Buffer<T>& buffer) {
  return buffer.bytes();
}

template <class... Buffers>
std::size_t bytes_of_all(const Buffers&... buffers) {
  return (std::size_t{0} + ... + bytes_of(buffers));
}

std::size_t bytes_of_wind(const wind::Workspace& work) {
  std::size_t bytes = bytes_of_all(work.row_means, work.rise, work.spectrum, work.turned, work.correction,
                                   work.gradients, work.roots_x, work.roots_y);
  for (const std::unique_ptr<Fft>* transform : {&work.one, &work.all_radii})
    bytes += *transform ? (*transform)->bytes() : 0;
  for (int r = 0; r < ShortList::capacity; ++r) bytes += bytes_of_all(work.along_x[r], work.along_y[r]);
  return bytes;
}

std::size_t bytes_of_avalanches(const avalanching::Workspace& work) {
  std::size_t bytes =
      bytes_of_all(work.share, work.given, work.received, work.open.ask, work.open.found, work.open.progress);
  for (const avalanching::Level& level : work.coarse)
    bytes += bytes_of_all(level.ground, level.sand, level.sand_before, level.repose);
  return bytes;
}

// ---- planning

/// cuFFT's transforms take about as much as their values; kernels that transform lines need none, which a
/// plan does not know.
class PlannedFft final : public Fft {
 public:
  PlannedFft(int width, int height, int fields)
      : values_(static_cast<std::size_t>(width) * height * fields) {}
  void forward(Complex*) override { refuse(); }
  void inverse(Complex*) override { refuse(); }
  std::size_t bytes() const override { return values_ * sizeof(Complex); }

 private:
  [[noreturn]] static void refuse() { throw Error("a transform that is only planned"); }
  std::size_t values_;
};

/// Hands out addresses that nothing may touch.
class PlanningExec final : public Exec {
 public:
  const char* backend() const override { return "none"; }
  std::string device() const override { return "none"; }
  std::size_t memory_available() const override { return 0; }
  void* allocate_host(std::size_t) override { refuse(); }
  void release_host(void*) noexcept override {}
  void set_zero(void*, std::size_t) override {}
  void copy(void*, const void*, std::size_t) override {}
  void upload(void*, const void*, std::size_t) override {}
  void download(void*, const void*, std::size_t) override { refuse(); }
  void synchronise() override {}
  std::unique_ptr<Fft> make_fft(int width, int height, int fields) override {
    return std::make_unique<PlannedFft>(width, height, fields);
  }

 protected:
  void* take(std::size_t) override { return this; }
  void give_back(void*) noexcept override {}

 private:
  [[noreturn]] static void refuse() { throw Error("memory that is only planned"); }
};

/// Layers that the terrain steps fill, and bedrock and sand.
std::vector<Layer> layers_filled(const Scenario& scenario) {
  std::vector<Layer> layers{Layer::bedrock, Layer::sand};
  const auto add = [&layers](Layer layer) {
    if (std::count(layers.begin(), layers.end(), layer) == 0) layers.push_back(layer);
  };
  for (const TerrainStep& step : scenario.terrain)
    std::visit(
        [&add](const auto& s) {
          if constexpr (std::is_same_v<std::decay_t<decltype(s)>, ObstacleStep>)
            add(Layer::obstacle);  // and bedrock
          else
            add(layer_by_name(s.layer));
        },
        step);
  return layers;
}

// ---- refusing

std::string amount(double bytes) {
  char text[64];
  std::snprintf(text, sizeof text, "%.0f bytes (%.1f GiB)", bytes, bytes / 1073741824.0);
  return text;
}

std::string name_of_grid(const Scenario& s) {
  return s.name + ": the grid of " + std::to_string(s.grid.width) + " x " + std::to_string(s.grid.height) +
         " cells ";
}

/// Throws ConfigError if so many bytes are not there.
void require(const Scenario& scenario, double needed, std::size_t available, const std::string& where) {
  if (needed <= static_cast<double>(available)) return;
  char each[40];
  std::snprintf(each, sizeof each, ", %.1f a cell, ", needed / scenario.make_grid().cells());
  throw ConfigError(name_of_grid(scenario) + "needs " + amount(needed) + each + where + "; there are " +
                    amount(static_cast<double>(available)));
}

void require_cells(const Scenario& scenario) {
  const Grid grid = scenario.make_grid();
  const std::string shape = name_of_grid(scenario);
  const long long cells = static_cast<long long>(grid.width) * grid.height;
  if (cells > most_cells)
    throw ConfigError(shape + "has " + std::to_string(cells) +
                      ", more than can be indexed (allowed: " + std::to_string(most_cells) + ")");
  if (!scenario.wind.warping && !scenario.wind.projection) return;
  const wind::CoarseGrid coarse = wind::coarse_grid(grid, scenario.wind);
  const long long values = static_cast<long long>(coarse.width) * coarse.height;
  if (values > most_cells)
    throw ConfigError(shape + "would need a transform of " + std::to_string(values) +
                      " values for its wind, more than can be indexed (allowed: " +
                      std::to_string(most_cells) + "; wind.coarsening makes it smaller)");
}

}  // namespace

std::vector<MemoryPart> Simulation::memory() const {
  std::vector<MemoryPart> parts;
  const std::size_t layer_bytes = static_cast<std::size_t>(terrain_.grid().cells()) * sizeof(std::uint32_t);
  for (Layer layer : layers_in_use()) parts.push_back({info(layer).name, layer_bytes});
  const auto add = [&parts](const char* name, std::size_t bytes) {
    if (bytes > 0) parts.push_back({name, bytes});
  };
  add("landed sand", landed_.bytes());
  add("strength of reptation", reptation_strength_.bytes());
  add("tangents of repose", repose_.bytes());
  add("wind's transforms", bytes_of_wind(wind_work_));
  add("wind's features", bytes_of_all(features_, perturbation_x_, perturbation_y_));
  add("heights", bytes_of_all(heights_.of_cells, heights_.highest));
  add("wind shadow's blocks",
      bytes_of_all(shadow_work_.reciprocals, shadow_work_.around, shadow_work_.courses));
  add("avalanches' levels", bytes_of_avalanches(avalanche_work_));
  add("avalanches of rock and soil", bytes_of_all(ground_work_.received, ground_work_.share));
  add("water's pipes", pipes_work_.held.bytes());
  add("capacity for sediment", erosion_work_.capacity.bytes());
  add("plants", plants_.bytes());
  add("ledger", ledger_.bytes());
  add("elevation that others hold", held_.bytes());
  add("costs that others hold", costs_.bytes());
  add("staging memory", staging_.bytes());
  return parts;
}

std::size_t total_bytes(const std::vector<MemoryPart>& parts) {
  std::size_t total = 0;
  for (const MemoryPart& part : parts) total += part.bytes;
  return total;
}

std::vector<MemoryPart> planned_memory(const Scenario& scenario) {
  PlanningExec exec;
  Terrain terrain(exec, scenario.make_grid(), HeightScale{});
  for (Layer layer : layers_filled(scenario)) terrain.require(layer);
  return Simulation(scenario, std::move(terrain)).memory();
}

double bytes_to_build(const Scenario& scenario) {
  constexpr double brought_over = sizeof(std::uint32_t);  // one layer at a time; a raster's are freed before
  return static_cast<double>(layers_filled(scenario).size()) * sizeof(double) + brought_over;
}

void require_memory(const Exec& exec, const Scenario& scenario, double host_bytes) {
  require_cells(scenario);
  const double on_device = static_cast<double>(total_bytes(planned_memory(scenario)));
  const std::string backend = exec.backend();
  require(scenario, on_device, exec.memory_available(), "on the " + backend + " backend");
  const double besides = backend == "cpu" ? on_device : 0.0;
  require(scenario, host_bytes * scenario.make_grid().cells() + besides, host_memory_available(),
          "on the host while the terrain is made");
}

void require_more_memory(const Simulation& simulation, const Scenario& scenario) {
  require_cells(scenario);
  const double more = static_cast<double>(total_bytes(planned_memory(scenario))) -
                      static_cast<double>(total_bytes(planned_memory(simulation.scenario())));
  require(scenario, more, simulation.exec().memory_available(),
          std::string("more on the ") + simulation.exec().backend() + " backend");
}

}  // namespace desert_sim
