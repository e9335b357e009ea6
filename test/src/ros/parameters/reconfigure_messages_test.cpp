// What requests of dynamic_reconfigure change, and which of step_rate and run.acceleration wins.

#include "src/ros/parameters/reconfigure_messages.hpp"

#include <algorithm>

#include "test/support/refusal.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

dynamic_reconfigure::Config request(const std::vector<std::pair<std::string, double>>& values) {
  dynamic_reconfigure::Config config;
  for (const auto& [name, value] : values) {
    config.doubles.emplace_back();
    config.doubles.back().name = name;
    config.doubles.back().value = value;
  }
  return config;
}

LiveParameters present(const std::string& run) {
  LiveParameters live;
  live.scenario = test::scenario_of("grid: {width: 16, height: 16}\nrun: {" + run + "}\n");
  live.step_rate = 10;
  return live;
}

TEST(Reconfigure, TheStepAndTheAccelerationAreLiveParameters) {
  const LiveParameters live = present("time_step: 0.05, acceleration: 0.5");
  const dynamic_reconfigure::Config values = reconfigure_values(live);
  for (const auto& [name, value] :
       {std::pair("run__time_step", 0.05), std::pair("run__acceleration", 0.5), std::pair("step_rate", 10.0)})
    EXPECT_EQ(std::count_if(values.doubles.begin(), values.doubles.end(),
                            [&, n = name, v = value](const auto& d) { return d.name == n && d.value == v; }),
              1)
        << name;
  const LiveChange change = reconfigure_change(request({{"run__acceleration", 0.25}}), live);
  EXPECT_EQ(change.settings, Settings{"run.acceleration=0.25"});
}

TEST(Reconfigure, ARateBesideAnAccelerationIsRefused) {
  const LiveParameters tied = present("time_step: 0.05, acceleration: 0.5");
  EXPECT_NE(test::refusal([&] {
              reconfigure_change(request({{"step_rate", 20}}), tied);
            })
                .find("step_rate: 20 steps/s has no effect while run.acceleration = 0.5 and run.time_step = "
                      "0.05 s make 10 steps/s (allowed: any rate once run.acceleration is 0)"),
            std::string::npos);
  EXPECT_NE(test::refusal([] {
              reconfigure_change(request({{"step_rate", 20}, {"run__acceleration", 3}}), present(""));
            }).find("run.acceleration = 3"),
            std::string::npos);
  const LiveChange both = reconfigure_change(request({{"step_rate", 20}, {"run__acceleration", 0}}), tied);
  EXPECT_EQ(both.step_rate, 20);
  EXPECT_EQ(both.settings, Settings{"run.acceleration=0"});
  EXPECT_EQ(reconfigure_change(request({{"step_rate", 10}}), tied).settings, Settings()) << "as it is";
}

}  // namespace
}  // namespace desert_sim
