// Sub-steps that follow from other parameters are bounded: a step cannot take for ever.
#include <gtest/gtest.h>

#include <functional>

#include "kernels/backend/exec.hpp"
#include "src/core/error.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

const std::string ground =
    "grid: {width: 48, height: 32, cell_size: 1}\nterrain: [{uniform: {layer: sand, value: 1}}]\n";

std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

class BoundedCost : public testing::Test {
 protected:
  std::unique_ptr<Simulation> simulation(const std::string& yaml) {
    return test::simulate(*exec_, ground + yaml);
  }
  std::unique_ptr<Exec> exec_ = make_exec("cpu", 1);
};

TEST_F(BoundedCost, DiffusionOfTooManySubstepsIsRefusedWithWhatIsAllowed) {
  const std::string message = refusal([&] { simulation("moisture: {enabled: true, diffusion: 10000}\n"); });
  EXPECT_NE(message.find("moisture.diffusion: 10000 m^2/s needs 40000 sub-steps"), std::string::npos)
      << message;
  EXPECT_NE(message.find("at most 64, which 16 m^2/s needs"), std::string::npos) << message;
  EXPECT_NO_THROW(simulation("moisture: {enabled: true, diffusion: 16}\n"));
  EXPECT_NO_THROW(simulation("moisture: {enabled: false, diffusion: 10000}\n"));
}

TEST_F(BoundedCost, AlsoALiveChangeAndTheEndOfARamp) {
  const auto s = simulation("moisture: {enabled: true}\n");
  const auto set = [&](const std::string& setting, double ramp) {
    return refusal([&] { s->apply(command::SetParameters{{setting}, ramp}); });
  };
  EXPECT_NE(set("moisture.diffusion=10000", 0).find("sub-steps"), std::string::npos);
  EXPECT_NE(set("moisture.diffusion=10000", 100).find("sub-steps"), std::string::npos);
  EXPECT_EQ(set("moisture.diffusion=15", 2), "");
  EXPECT_NO_THROW(test::run(*s, 4));
}

TEST_F(BoundedCost, SmoothingOfTooManySubstepsIsRefused) {
  const std::string yaml = "wind: {speed: 10}\nreptation: {method: smoothing, strength: ";
  EXPECT_NE(refusal([&] { simulation(yaml + "10}\n"); }).find("reptation.strength"), std::string::npos);
  EXPECT_NO_THROW(simulation(yaml + "0.1}\n"));
}

TEST_F(BoundedCost, TooManyHopsAStepAreRefused) {
  const std::string yaml = "run: {time_step: 2}\nsaltation: {hop_time: ";
  const std::string message = refusal([&] { simulation(yaml + "0.005}\n"); });
  EXPECT_NE(message.find("run.time_step: 2 s is 400 times saltation.hop_time = 0.005 s (allowed: at most 256 "
                         "times, 1.28 s)"),
            std::string::npos)
      << message;
  EXPECT_EQ(message.find("cells"), std::string::npos) << message;
  EXPECT_NO_THROW(simulation(yaml + "0.0078125}\n"));
  EXPECT_NO_THROW(simulation(yaml + "0.005, enabled: false}\n"));
}

}  // namespace
}  // namespace desert_sim
