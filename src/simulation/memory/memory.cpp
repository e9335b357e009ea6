#include "src/simulation/memory/memory.hpp"

#include <algorithm>
#include <cstdio>

#include "kernels/backend/fft.hpp"
#include "src/core/error.hpp"
#include "src/core/host_memory.hpp"
#include "src/simulation/processes/processes.hpp"

namespace desert_sim {

namespace {

// ---- planning

/// cuFFT's transforms take about as much as their values; those by lines need the roots of unity of both
/// axes.
class PlannedFft final : public Fft {
 public:
  PlannedFft(int width, int height, int fields, FftMethod method)
      : values_(method == FftMethod::library ? static_cast<std::size_t>(width) * height * fields
                                             : static_cast<std::size_t>(width) + height) {}
  void forward(Complex*) override { throw_error(); }
  void inverse(Complex*) override { throw_error(); }
  int rows_given() const override { throw_error(); }
  std::size_t bytes() const override { return values_ * sizeof(Complex); }

 private:
  [[noreturn]] static void throw_error() { throw Error("a planned transform cannot be executed"); }
  std::size_t values_;
};

/// Hands out addresses that nothing may touch.
class PlanningExec final : public Exec {
 public:
  Device device() const override { return Device::none; }
  std::string device_name() const override { return "none"; }
  std::size_t memory_available() const override { return 0; }
  void* allocate_host(std::size_t) override { throw_error(); }
  void release_host(void*) noexcept override {}
  void set_zero(void*, std::size_t) override {}
  void copy(void*, const void*, std::size_t) override {}
  void upload(void*, const void*, std::size_t) override {}
  void download(void*, const void*, std::size_t) override { throw_error(); }
  void synchronise() override {}
  std::unique_ptr<Fft> make_fft(int width, int height, int fields, FftMethod method) override {
    return std::make_unique<PlannedFft>(width, height, fields, method);
  }

 protected:
  void* allocate_memory(std::size_t) override { return this; }
  void free_memory(void*) noexcept override {}

 private:
  [[noreturn]] static void throw_error() { throw Error("planned memory cannot be accessed"); }
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

std::string grid_text(const Scenario& s) {
  return s.name + ": the grid of " + std::to_string(s.grid.width) + " x " + std::to_string(s.grid.height) +
         " cells ";
}

/// Throws ConfigError if so many bytes are not there.
void check_available(const Scenario& scenario, double needed, std::size_t available,
                     const std::string& where) {
  if (needed <= static_cast<double>(available)) return;
  char each[40];
  std::snprintf(each, sizeof each, ", %.1f bytes per cell, ", needed / scenario.make_grid().cells());
  throw ConfigError(grid_text(scenario) + "needs " + amount(needed) + each + where +
                    "; available: " + amount(static_cast<double>(available)));
}

void require_cells(const Scenario& scenario) {
  const Grid grid = scenario.make_grid();
  const long long cells = static_cast<long long>(grid.width) * grid.height;
  if (cells > max_grid_cells)
    throw ConfigError(grid_text(scenario) + "has " + std::to_string(cells) +
                      ", which cannot be indexed (allowed: at most " + std::to_string(max_grid_cells) + ")");
}

}  // namespace

std::vector<MemoryPart> memory_of(const SimulationState& state, const Pipeline& pipeline,
                                  const Views& views) {
  std::vector<MemoryPart> parts;
  const std::size_t layer_bytes =
      static_cast<std::size_t>(state.terrain.grid().cells()) * sizeof(std::uint32_t);
  for (Layer layer : state.layers_in_use()) parts.push_back({info(layer).name, layer_bytes});
  for (MemoryPart& part : pipeline.memory()) parts.push_back(std::move(part));
  if (state.plants) parts.push_back({"plants", state.plants.bytes()});
  parts.push_back({"ledger", state.ledger_words.bytes()});
  for (MemoryPart& part : views.memory()) parts.push_back(std::move(part));
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
  for (Layer layer : layers_filled(scenario)) terrain.allocate(layer);
  SimulationState state(scenario, std::move(terrain));
  Pipeline pipeline(state, process_table());
  const Views views(state, pipeline);
  return memory_of(state, pipeline, views);
}

double bytes_to_build(const Scenario& scenario) {
  constexpr double upload_bytes = sizeof(std::uint32_t);  // one layer at a time; a raster's are freed before
  return static_cast<double>(layers_filled(scenario).size()) * sizeof(double) + upload_bytes;
}

void require_memory(const Exec& exec, const Scenario& scenario, double host_bytes) {
  require_cells(scenario);
  const double on_device = static_cast<double>(total_bytes(planned_memory(scenario)));
  require_bytes(exec, scenario, on_device, host_bytes * scenario.make_grid().cells(),
                "while the terrain is built");
}

void require_bytes(const Exec& exec, const Scenario& scenario, double on_device, double on_host,
                   const std::string& what) {
  check_available(scenario, on_device, exec.memory_available(),
                  std::string("on the ") + exec.backend() + " backend " + what);
  const double besides = exec.device() == Device::cpu ? on_device : 0.0;
  check_available(scenario, on_host + besides, host_memory_available(), "on the host " + what);
}

void require_more_memory(const SimulationState& state, const Scenario& scenario) {
  require_cells(scenario);
  const double more = static_cast<double>(total_bytes(planned_memory(scenario))) -
                      static_cast<double>(total_bytes(planned_memory(state.scenario)));
  check_available(scenario, more, state.exec().memory_available(),
                  std::string("more on the ") + state.exec().backend() + " backend");
}

}  // namespace desert_sim
