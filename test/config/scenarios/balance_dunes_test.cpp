// No shipped scenario makes or loses material: books close to the last quantum. The tests of landforms check
// that of the scenarios that they run.

#include <gtest/gtest.h>

#include <string>

#include "test/support/running.hpp"

namespace desert_sim {
namespace {

class Balance : public ::testing::TestWithParam<const char*> {};

TEST_P(Balance, ClosesExactly) {
  Running scene(shipped(GetParam(), {"grid.width=128", "grid.height=128"}));
  scene.run(1000).expect_balanced();
}

const auto name_of = [](const auto& test) { return std::string(test.param); };

INSTANTIATE_TEST_SUITE_P(Scenarios, Balance, ::testing::Values("climbing_dune", "venturi"), name_of);
#if DESERT_WITH_IO
INSTANTIATE_TEST_SUITE_P(OfRasters, Balance, ::testing::Values("dem"), name_of);
#endif

}  // namespace
}  // namespace desert_sim
