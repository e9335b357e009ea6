#pragma once
/// Worlds for tests: a scenario from YAML text, a simulation on a backend, its layers; and a fixture that
/// runs each test body on every backend.

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "src/scenario/scenario.hpp"
#include "src/simulation/simulation.hpp"

namespace desert_sim::test {

/// Parsed and resolved; throws what the loader throws.
Scenario scenario_of(const std::string& yaml);
/// As scenario_of(), but not resolved.
Scenario parsed(const std::string& yaml);

std::unique_ptr<Simulation> simulate(Exec& exec, const std::string& yaml);
void run(Simulation& simulation, int steps);

/// A layer as stored; all 0 if it is not in use.
std::vector<Quanta> quanta(const Simulation& simulation, Layer layer);
std::vector<float> real(const Simulation& simulation, Layer layer);
std::vector<Layer> persistent_layers(const Simulation& simulation);

/// Expects mass residuals of exactly 0, no negative depth, nothing that is not finite.
void expect_sound(Simulation& simulation, const std::string& when);

/// Whether DESERT_REQUIRE_GPU=1: a missing GPU is then a failure, not a skip.
bool gpu_required();

/// Runs each test body on "cpu" and on "cuda"; see DESERT_ON_EACH_BACKEND.
class OnBackend : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override;
  Exec& exec() { return *exec_; }
  std::unique_ptr<Simulation> simulation(const std::string& yaml) { return simulate(*exec_, yaml); }

 private:
  std::unique_ptr<Exec> exec_;
};

/// For tests that need the GPU beside the CPU: false if there is none, after skipping (or failing) the test.
#define DESERT_NEED_GPU()                                                  \
  do {                                                                     \
    const CudaStatus status_ = cuda_status();                              \
    if (!status_.usable && test::gpu_required()) FAIL() << status_.reason; \
    if (!status_.usable) GTEST_SKIP() << status_.reason;                   \
  } while (false)

/// Has both backends.
class OnBoth : public ::testing::Test {
 protected:
  void SetUp() override {
    DESERT_NEED_GPU();
    cpu_ = make_exec("cpu", 2);
    cuda_ = make_exec("cuda");
  }
  Exec& cpu() { return *cpu_; }
  Exec& cuda() { return *cuda_; }

 private:
  std::unique_ptr<Exec> cpu_, cuda_;
};

inline std::string backend_name(const ::testing::TestParamInfo<const char*>& info) { return info.param; }

#define DESERT_ON_EACH_BACKEND(Suite) \
  INSTANTIATE_TEST_SUITE_P(On, Suite, ::testing::Values("cpu", "cuda"), ::desert_sim::test::backend_name)

}  // namespace desert_sim::test
