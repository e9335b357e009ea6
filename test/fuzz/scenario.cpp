// Scenarios: one that is accepted is written, and read again as the same.
#include "src/scenario/scenario.hpp"

#include "src/scenario/raster_grid.hpp"
#include "test/fuzz/fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace desert_sim;
  return fuzz::accept_or_refuse([&] {
    Scenario scenario = parse_scenario_text(std::string(reinterpret_cast<const char*>(data), size), "fuzz");
    resolve_grid(scenario, no_raster_loader);
    const std::string text = dump_scenario(scenario);
    try {
      if (dump_scenario(parse_scenario_text(text, "again")) != text) std::abort();
    } catch (const ConfigError&) {
      std::abort();  // what is accepted must be accepted again
    }
  });
}
