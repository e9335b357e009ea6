// No shipped scenario makes or loses material: books close to the last quantum.

#include <gtest/gtest.h>

#include <string>

#include "dunes/running.hpp"

namespace desert_sim {
namespace {

class Balance : public ::testing::TestWithParam<const char*> {};

TEST_P(Balance, ClosesExactly) {
#if !DESERT_WITH_IO
  if (std::string(GetParam()) == "dem") GTEST_SKIP() << "needs a raster";
#endif
  Running scene(shipped(GetParam(), {"grid.width=128", "grid.height=128"}));
  scene.run(1000).expect_balanced();
}

INSTANTIATE_TEST_SUITE_P(Scenarios, Balance,
                         ::testing::Values("barchan", "transverse", "linear", "star", "nebkha", "echo_dune",
                                           "climbing_dune", "yardang", "venturi", "dem"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace desert_sim
