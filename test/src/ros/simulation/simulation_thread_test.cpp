/// When the simulation thread steps, by a clock that the test moves.
#include "src/ros/simulation/simulation_thread.hpp"

#include <gtest/gtest.h>
#include <ros/time.h>

#include <mutex>

#include "include/desert_sim/testing/node_process.hpp"
#include "test/support/manual_clock.hpp"

namespace {

using namespace desert_sim;

/// It counts how often somebody has waited for it.
class CountingClock : public desert_sim::test::ManualClock {
 public:
  void wait_until(std::condition_variable& condition, std::unique_lock<std::mutex>& lock,
                  TimePoint time) const override {
    ++waits_;
    ManualClock::wait_until(condition, lock, time);
  }
  int waits() const { return waits_; }

 private:
  mutable std::atomic<int> waits_{0};
};

class StepSchedule : public testing::Test {
 protected:
  // A binary fraction, of which sums are exact.
  static constexpr double rate = 16, period = 1 / rate;

  void SetUp() override { ros::Time::init(); }
  void TearDown() override {
    simulation_.reset();
    ros::Time::init();  // the computer's time again
  }
  void start(bool paused, const std::function<void(double)>& publish_clock = {}) {
    SimulationThread::Options options;
    options.backend = "cpu";
    options.threads = 1;
    options.step_rate = rate;
    options.paused = paused;
    options.publish_clock = publish_clock;
    options.clock = &clock_;
    simulation_ = std::make_unique<SimulationThread>(
        load_scenario(DESERT_SOURCE_DIR "/test/support/ros/scenarios/corner.yaml"), no_raster_loader, options,
        [] {});
    do_what_is_due();
  }
  /// Who waits for the second time from now on has found nothing to do at the present time.
  void do_what_is_due() {
    const int before = clock_.waits();
    ASSERT_TRUE(desert_sim::test::wait_until([&] { return clock_.waits() >= before + 2; }, 60));
  }
  void advance(double seconds) {
    clock_.advance(seconds);
    do_what_is_due();
  }
  StatusReport report(bool measure = false) { return simulation_->report(measure).get(); }
  std::uint64_t step() { return report().moment.step; }

  CountingClock clock_;
  std::unique_ptr<SimulationThread> simulation_;
};

TEST_F(StepSchedule, StepsComeAtTheirRate) {
  start(false);
  EXPECT_EQ(step(), 1u) << "the first at once";
  report(true);  // from now on some steps are timed
  for (std::uint64_t n = 1; n <= 40; ++n) {
    advance(period / 2);
    ASSERT_EQ(step(), n);
    advance(period / 2);
    ASSERT_EQ(step(), n + 1);
  }
  const StatusReport status = report();
  EXPECT_EQ(status.state, RunState::running);
  EXPECT_NEAR(status.steps_per_second, rate, 1e-6);
  EXPECT_EQ(status.lag, 0);
  EXPECT_FALSE(status.process_times.empty());
  for (const auto& time : status.process_times) EXPECT_GT(time.milliseconds, 0) << time.process;
}

TEST_F(StepSchedule, APauseMakesNoStepAndLeavesNoneToCatchUp) {
  start(false);
  advance(period);
  simulation_->pause().get();
  ASSERT_EQ(step(), 2u);
  advance(10);
  EXPECT_EQ(step(), 2u);
  EXPECT_EQ(report().state, RunState::paused);
  simulation_->resume().get();
  do_what_is_due();
  EXPECT_EQ(step(), 3u) << "the first at once";
  advance(period);
  EXPECT_EQ(step(), 4u);
}

TEST_F(StepSchedule, StepsOnRequestAreAddedToTheSchedule) {
  start(false);
  EXPECT_EQ(simulation_->step(40).get().moment.step, 41u);
  for (std::uint64_t n = 1; n <= 5; ++n) {
    advance(period);
    EXPECT_EQ(step(), 41 + n);
  }
  EXPECT_EQ(report().lag, 0);
}

TEST_F(StepSchedule, TheClockOfAllDoesNotWaitForItself) {
  ros::Time::setNow(ros::Time(0, 1));  // simulated, and nobody moves it
  std::mutex mutex;
  std::vector<double> told;
  start(false, [&](double seconds) {
    const std::lock_guard<std::mutex> lock(mutex);
    told.push_back(seconds);
  });
  ASSERT_TRUE(ros::Time::isSimTime());
  EXPECT_EQ(step(), 1u);
  for (std::uint64_t n = 1; n <= 5; ++n) {
    advance(period);
    EXPECT_EQ(step(), n + 1);
  }
  const std::lock_guard<std::mutex> lock(mutex);
  EXPECT_EQ(told, (std::vector<double>{0, 1, 2, 3, 4, 5, 6})) << "at the start, and after each step";
}

}  // namespace
