/// ~set_weather, on a paused node with the scenario corner.yaml, which has no water before.
#include <desert_sim/SetWeather.h>
#include <desert_sim/SimulationStatus.h>

#include <cmath>

#include "test/support/ros/service_tests.hpp"

namespace {

using namespace desert_sim;
using namespace node_test;

TEST_F(Services, SetWeatherLetsItRainOnATerrainWithoutWater) {
  SetWeather::Request request;
  request.change = {"rain_rate", "evaporation"};
  request.rain_rate = 1e-3;
  request.evaporation = 0;
  EXPECT_TRUE(call<SetWeather>("set_weather", request).success);
  step(10);
  // 64 x 48 cells of 4 m²; over the open edges some has left.
  Listener<SimulationStatus> statuses("status");
  EXPECT_TRUE(statuses.wait_for([](const SimulationStatus& s) {
    for (const MaterialVolume& volume : s.volumes)
      if (volume.material == "water") return std::abs(volume.entered - 10e-3 * 64 * 48 * 4) < 0.1;
    return false;
  }));
}

TEST_F(Services, SetWeatherRampsAndTheStatusTellsOfIt) {
  SetWeather::Request request;
  request.change = {"rain_rate"};
  request.rain_rate = 1e-4;
  request.ramp = 1000;
  EXPECT_TRUE(call<SetWeather>("set_weather", request).success);
  Listener<SimulationStatus> statuses("status");
  EXPECT_TRUE(statuses.wait_for([](const SimulationStatus& s) {
    return s.changes.find("rain.rate -> 0.0001 until") != std::string::npos;
  }));
  request.ramp = 0;
  EXPECT_TRUE(call<SetWeather>("set_weather", request).success);
  EXPECT_TRUE(statuses.wait_for([](const SimulationStatus& s) { return s.changes.empty(); }));
}

TEST_F(Services, SetWeatherTakesSpringsAndTheSea) {
  SetWeather::Request request;
  request.change = {"springs", "sea", "sea_level"};
  request.springs.resize(1);
  request.springs[0].x = 50;
  request.springs[0].y = 20;
  request.springs[0].radius = 5;
  request.springs[0].discharge = 2;
  request.sea = "border";
  request.sea_level = 2;
  EXPECT_TRUE(call<SetWeather>("set_weather", request).success);
  step(2);
  request = SetWeather::Request();
  request.change = {"springs"};
  EXPECT_TRUE(call<SetWeather>("set_weather", request).success);
}

TEST_F(Services, SetWeatherRefuses) {
  SetWeather::Request request;
  expect_refused<SetWeather>("set_weather", request, "change", "is empty");
  request.change = {"snow"};
  expect_refused<SetWeather>("set_weather", request, "change: 'snow'", "rain_rate");
  request.change = {"rain_rate"};
  request.rain_rate = std::nan("");
  expect_refused<SetWeather>("set_weather", request, "rain_rate: nan", "finite");
  request.rain_rate = 5;
  expect_refused<SetWeather>("set_weather", request, "rain.rate: 5", "[0, 1] m/s");
  request.rain_rate = 0;
  request.ramp = -1;
  expect_refused<SetWeather>("set_weather", request, "ramp: -1", "[0, 1e+12] s");
  request.ramp = 0;
  request.change = {"sea"};
  request.sea = "everywhere else";
  expect_refused<SetWeather>("set_weather", request, "sea: 'everywhere else'", "border");
  request = SetWeather::Request();
  request.change = {"springs"};
  request.springs.resize(65);
  expect_refused<SetWeather>("set_weather", request, "water.springs", "64");
  request.springs.resize(1);
  request.springs[0].discharge = -1;
  expect_refused<SetWeather>("set_weather", request, "discharge: -1", "[0, 100000] m^3/s");
  request.change = {"rain_rate"};
  expect_refused<SetWeather>("set_weather", request, "springs: is set", "`change` does not name it");
}

}  // namespace

int main(int argc, char** argv) { return node_test::run_tests(argc, argv, "weather"); }
