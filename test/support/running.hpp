#pragma once
/// Runs scenarios for the tests of dunes, and takes fields from them.

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <string>

#include "src/metrics/correlation.hpp"
#include "src/metrics/crest_orientation.hpp"
#include "src/metrics/slip_faces.hpp"
#include "src/simulation/session.hpp"
#include "test/support/dune_shape.hpp"
#if DESERT_WITH_IO
#include "src/io/raster_loader.hpp"
#endif

namespace desert_sim {

/// The repository; who carries the programs elsewhere says where it is there (scripts/test_gpu).
inline std::string source_folder() {
  const char* elsewhere = std::getenv("DESERT_SOURCE_DIR");
  return elsewhere ? elsewhere : DESERT_SOURCE_DIR;
}

/// A scenario of config/scenarios, changed by settings ("path=value").
inline Scenario shipped(const std::string& name, const Settings& settings = {}) {
  return load_scenario(source_folder() + "/config/scenarios/" + name + ".yaml", settings);
}

/// A running scenario on the CPU. One thread by default: tests share the machine.
class Running {
 public:
  explicit Running(const Scenario& scenario, int threads = 1)
      : session_(std::make_unique<Session>(scenario, rasters(), "cpu", threads)) {}

  Running& run(int steps) {
    for (int n = 0; n < steps; ++n) session_->step();
    return *this;
  }
  Simulation& simulation() { return session_->simulation(); }

  Field field(Layer layer) {
    const auto snapshot = simulation().views().snapshot({layer});
    Field f;
    f.width = snapshot->width;
    f.height = snapshot->height;
    f.cell_size = snapshot->cell_size;
    f.periodic = simulation().scenario().grid.boundary == Boundary::periodic;
    f.values = *snapshot->find(layer);
    return f;
  }

  /// That every material's books close exactly.
  void expect_balanced() {
    const auto balance = simulation().state().balance();
    for (std::size_t m = 0; m < balance.size(); ++m) EXPECT_EQ(balance[m].residual(), 0) << material_names[m];
  }

 private:
  static RasterLoader rasters() {
#if DESERT_WITH_IO
    return gdal_raster_loader();
#else
    return no_raster_loader;
#endif
  }
  std::unique_ptr<Session> session_;
};

/// What a test measured, for the log.
#define DESERT_REPORT(...)       \
  do {                           \
    std::printf("  measured: "); \
    std::printf(__VA_ARGS__);    \
    std::printf("\n");           \
  } while (0)

}  // namespace desert_sim
