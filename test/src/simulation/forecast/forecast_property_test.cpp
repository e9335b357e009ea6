// Forecasts: the run ahead comes to the states of the live run, whatever is switched on; members of an
// ensemble depend on their seed alone; what cannot be forecast is refused; and what is ended leaves nothing.

#include <cmath>

#include "src/simulation/checkpoint.hpp"
#include "src/simulation/forecast/forecast.hpp"
#include "src/simulation/forecast/passability.hpp"
#include "test/support/cases.hpp"
#include "test/support/refusal.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

const std::string forecast_dunes =
    "grid: {width: 40, height: 30, boundary: open}\n"
    "terrain: [noise: {layer: bedrock, low: 0, high: 5, scale: 15}, noise: {layer: sand, low: 0, high: 3}]\n"
    "wind: {speed: 6, direction_deg: 20}\nsaltation: {influx: 0.2}\n";
/// Slopes of which steps of some seconds open and close some for the rover.
const std::string moving =
    "grid: {width: 32, height: 32}\nterrain: [noise: {layer: sand, low: 0, high: 6, scale: 9}]\n"
    "wind: {speed: 8}\nrun: {time_step: 0.5}\n";

ForecastOptions options(double horizon, int moments, double step_rate) {
  ForecastOptions o;
  o.horizon = horizon;
  o.moments = moments;
  o.step_rate = step_rate;
  return o;
}

bool go_on(int, double) { return true; }

class Forecasts : public test::OnBackend {
 protected:
  ForecastMaps forecast(const Simulation& from, const ForecastOptions& o, int threads = 1) {
    return *ForecastRun(checkpoint_bytes(from), o, exec().backend(), threads).run(go_on);
  }
  /// Steps the live run to each moment, and compares.
  void expect_of_live_run(const ForecastMaps& f, Simulation& live, const std::string& what) {
    for (const ForecastMoment& moment : f.moments) {
      while (live.steps() < moment.step) live.step();
      EXPECT_EQ(moment.step, live.steps()) << what;
      EXPECT_EQ(moment.hash, live.state().hash()) << what << ", " << moment.time << " s ahead";
      EXPECT_EQ(moment.sim_time, live.time()) << what;
      EXPECT_EQ(moment.elevation, live.views().snapshot({Layer::elevation})->layers.at(Layer::elevation))
          << what;
      EXPECT_EQ(moment.costs, costs(live)) << what;
    }
  }
  static std::vector<std::int8_t> costs(Simulation& s) {
    CostQuery query;
    query.whole = true;
    s.views().forget_costs();  // as a new subscriber
    std::vector<std::int8_t> all(static_cast<std::size_t>(s.terrain().grid().cells()));
    s.views().begin_costs(query).whole.get()->write_to(all, s.terrain().grid().width);
    return all;
  }
};

TEST_P(Forecasts, AreWhatTheLiveRunComesTo) {
  for (const test::Case& c : test::process_cases(true)) {
    const auto live = simulation(test::grid_yaml(33, 26, "open") + c.yaml);
    test::run(*live, 3);
    const std::uint64_t before = live->state().hash();
    const ForecastMaps f = forecast(*live, options(0.6, 3, 10));
    EXPECT_EQ(live->state().hash(), before) << "the live run is not touched";
    EXPECT_EQ(f.moments.back().step, live->steps() + 6);
    expect_of_live_run(f, *live, c.name);
  }
}

TEST_P(Forecasts, GoOnInTheMiddleOfASecondOfARampAndOfATimeline) {
  const auto live = simulation(
      forecast_dunes +
      "run: {time_step: 0.3, acceleration: 0.6, timeline: [{time: 3, set: {run.time_step: 0.07}}, {time: 4, "
      "set: {wind.speed: 9, run.acceleration: 1.4}, ramp: 2}]}\n");
  live->apply(command::SetWind{70, 8, 5});
  test::run(*live, 7);
  const ForecastMaps f = forecast(*live, options(6, 4, 0));
  EXPECT_DOUBLE_EQ(f.seconds_per_sim_second, 1 / static_cast<double>(0.6F));
  EXPECT_GT(f.moments.back().step, live->steps() + 30) << "steps become shorter";
  expect_of_live_run(f, *live, "timeline");
}

TEST_P(Forecasts, TellTheStatesThatTheLiveRunShowsThen) {
  const auto live = simulation(forecast_dunes + "run: {time_step: 0.25}\n");
  std::vector<std::uint64_t> steps;
  for (const ForecastMoment& moment : forecast(*live, options(1, 4, 10)).moments)
    steps.push_back(moment.step);
  EXPECT_EQ(steps, (std::vector<std::uint64_t>{2, 5, 7, 10})) << "ten steps a second";
  steps.clear();
  for (const ForecastMoment& moment : forecast(*live, options(1, 4, 0)).moments) steps.push_back(moment.step);
  EXPECT_EQ(steps, (std::vector<std::uint64_t>{1, 2, 3, 4})) << "the desert's own time";
  live->apply(command::SetParameters{{"run.acceleration=0.5"}});
  steps.clear();
  for (const ForecastMoment& moment : forecast(*live, options(1, 4, 10)).moments)
    steps.push_back(moment.step);
  EXPECT_EQ(steps, (std::vector<std::uint64_t>{0, 1, 1, 2})) << "an acceleration rules";
}

TEST_P(Forecasts, OfLongerStepsAreRunsWithThatTimeStep) {
  const auto live = simulation(
      forecast_dunes +
      "run: {time_step: 0.02, acceleration: 0.2, timeline: [{time: 0.6, set: {run.time_step: 0.01}}]}\n");
  ForecastOptions o = options(6, 3, 0);
  o.stride = 5;
  const ForecastMaps f = forecast(*live, o);
  std::vector<std::uint64_t> steps;
  for (const ForecastMoment& moment : f.moments) steps.push_back(moment.step);
  EXPECT_EQ(steps, (std::vector<std::uint64_t>{4, 9, 17})) << "of 0.1 s of the desert, then of 0.05 s";
  EXPECT_NEAR(f.moments.back().sim_time, 1.2, 0.1) << "the step that meets the timeline is not lengthened";
  EXPECT_DOUBLE_EQ(f.seconds_per_sim_second, 1 / static_cast<double>(0.2F));
  live->apply(command::SetParameters{{"run.time_step=0.1"}});
  while (live->steps() < 4) live->step();
  EXPECT_EQ(f.moments[0].hash, live->state().hash());

  const auto paced = simulation(forecast_dunes + "run: {time_step: 0.02}\n");
  o.stride = 4;
  o.step_rate = 10;
  EXPECT_EQ(forecast(*paced, o).moments.back().step, 15) << "instead of 60 steps at ten a second";
  o.stride = 0;
  EXPECT_NE(test::refusal([&] { forecast(*paced, o); }).find("stride"), std::string::npos);
}

TEST_P(Forecasts, ApplyTheirCommandsToTheCopyAlone) {
  const auto live = simulation(forecast_dunes);
  test::run(*live, 2);
  const std::uint64_t before = live->state().hash();
  command::SetWindSchedule rose;
  rose.regime.regime = WindRegimeKind::rose;
  rose.regime.hold_time = 0.5F;
  rose.regime.segments = {WindSegment{0, 9}, WindSegment{90, 7}};
  ForecastOptions o = options(5, 2, 1);
  o.commands = {command::SetParameters{{"saltation.influx=0", "run.time_step=0.5"}}, rose};
  const ForecastMaps f = forecast(*live, o);
  EXPECT_EQ(live->state().hash(), before);
  live->apply(std::get<command::SetParameters>(o.commands[0]));
  live->apply(rose);
  expect_of_live_run(f, *live, "commands");
}

TEST_P(Forecasts, CompareTheCostsAtTheirMoments) {
  const auto live = simulation(moving);
  test::run(*live, 4);
  Passability expected(costs(*live));
  const ForecastMaps f = forecast(*live, options(12, 6, 2));
  for (const ForecastMoment& moment : f.moments) expected.add(moment.time, moment.costs);
  EXPECT_EQ(f.passable_until, expected.until());
  EXPECT_EQ(f.passable_from, expected.from());
  int closes = 0, opens = 0;
  for (std::size_t i = 0; i < f.passable_until.size(); ++i) {
    closes += f.passable_until[i] > 0 && f.passable_until[i] < 12;
    opens += f.passable_from[i] > 0 && f.passable_from[i] <= 12;
  }
  EXPECT_GT(closes, 0);
  EXPECT_GT(opens, 0);
}

TEST_P(Forecasts, OfAnEnsembleHaveTheLiveRunAsTheirFirstMember) {
  const auto live = simulation(moving);
  ForecastOptions o = options(6, 2, 2);
  const ForecastMaps alone = forecast(*live, o);
  EXPECT_TRUE(alone.moments.back().probability.empty());
  o.members = 4;
  o.gusts = {0.5, 40, 2, 3};
  const ForecastMaps f = forecast(*live, o);
  EXPECT_EQ(f.passable_until, alone.passable_until);
  int between = 0;
  for (std::size_t n = 0; n < f.moments.size(); ++n) {
    EXPECT_EQ(f.moments[n].hash, alone.moments[n].hash);
    for (std::size_t i = 0; i < f.moments[n].probability.size(); ++i) {
      const float members = 4 * f.moments[n].probability[i];
      EXPECT_EQ(members, std::round(members));
      EXPECT_GE(members, is_passable(alone.moments[n].costs[i]) ? 1 : 0);
      EXPECT_LE(members, is_passable(alone.moments[n].costs[i]) ? 4 : 3);
      between += members > 0 && members < 4;
    }
  }
  EXPECT_GT(between, 0) << "members differ";
  EXPECT_EQ(forecast(*live, o).moments.back().probability, f.moments.back().probability) << "each time";
  EXPECT_EQ(forecast(*live, o, 3).moments.back().probability, f.moments.back().probability)
      << "three threads";
  o.gusts.seed = 4;
  EXPECT_NE(forecast(*live, o).moments.back().probability, f.moments.back().probability);
  o.gusts = {0, 0, 2, 3};
  const ForecastMaps without_gusts = forecast(*live, o);
  for (float share : without_gusts.moments.back().probability) EXPECT_TRUE(share == 0 || share == 1);
}

TEST_P(Forecasts, EndBetweenTwoSteps) {
  const auto live = simulation(forecast_dunes);
  const std::size_t held = exec().bytes_held();
  ForecastOptions o = options(100, 5, 1);
  o.members = 2;
  for (const int steps : {0, 3, 99, 100, 150}) {
    int made = 0;
    ForecastRun run(checkpoint_bytes(*live), o, exec().backend(), 1);
    EXPECT_FALSE(run.run([&](int, double) { return made++ < steps; })) << steps;
    EXPECT_EQ(made, steps + 1);
  }
  EXPECT_EQ(exec().bytes_held(), held);
  int told = 0;
  double latest = 0;
  ForecastRun(checkpoint_bytes(*live), o, exec().backend(), 1).run([&](int member, double time) {
    EXPECT_EQ(member, told / 100);
    EXPECT_EQ(time, told % 100);
    ++told;
    latest = time;
    return true;
  });
  EXPECT_EQ(told, 200);
  EXPECT_EQ(latest, 99);
}

TEST_P(Forecasts, RefuseWhatCannotBeForecast) {
  const auto live = simulation(forecast_dunes);
  const std::string bytes = checkpoint_bytes(*live);
  const auto reason = [&](const ForecastOptions& o) {
    return test::refusal([&] { ForecastRun(bytes, o, exec().backend(), 1); });
  };
  const auto expect = [](const std::string& told, std::initializer_list<const char*> parts) {
    for (const char* part : parts) EXPECT_NE(told.find(part), std::string::npos) << told;
  };
  expect(reason(options(-1, 1, 10)), {"horizon", "-1", "1e-06"});
  expect(reason(options(NAN, 1, 10)), {"horizon", "nan"});
  expect(reason(options(1, 0, 10)), {"moments", ": 0", "100"});
  expect(reason(options(0.05, 1, 10)), {"horizon", "0.05", "0.1 s", "1 to 1000000"});
  expect(reason(options(2e5, 1, 10)), {"horizon", "200000", "2000000 steps", "100000 s"});
  ForecastOptions o = options(1, 1, 10);
  o.members = 65;
  expect(reason(o), {"members", "65", "64"});
  o.members = 2;
  o.gusts.gust_time = 0;
  expect(reason(o), {"gust_time", ": 0"});
  o = options(1, 1, 10);
  o.commands = {command::SetParameters{{"wind.speed=700"}}};
  expect(reason(o), {"wind.speed", "700"});
  EXPECT_NE(test::refusal([&] {
              ForecastRun(bytes.substr(0, bytes.size() / 2), options(1, 1, 10), exec().backend(), 1);
            }).find("truncated"),
            std::string::npos);
}

DESERT_ON_EACH_BACKEND(Forecasts);

}  // namespace
}  // namespace desert_sim
