// One model moves the sand: two that would, or one that another makes ineffective, are refused.
#include <gtest/gtest.h>

#include "kernels/backend/exec.hpp"
#include "src/core/error.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

class SandModels : public testing::Test {
 protected:
  std::string refusal(const std::string& yaml) {
    try {
      simulation(yaml);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  }
  std::unique_ptr<Simulation> simulation(const std::string& yaml) {
    return test::simulate(*exec_,
                          "grid: {width: 32, height: 24, cell_size: 0.5}\n"
                          "terrain: [{uniform: {layer: sand, value: 1}}]\n" +
                              yaml);
  }
  std::unique_ptr<Exec> exec_ = make_exec("cpu", 1);
};

TEST_F(SandModels, SlabsAndParticlesTogetherAreRefused) {
  const std::string message = refusal("slab_model: {kind: werner}\nparticle: {kind: wang}\n");
  EXPECT_NE(message.find("particle.kind: = wang beside slab_model.kind = werner"), std::string::npos)
      << message;
  EXPECT_NE(message.find("allowed"), std::string::npos) << message;
}

TEST_F(SandModels, AModelOfSaltationThatAnotherReplacesIsRefused) {
  for (const std::string model : {"continuum", "desertscape_2019"})
    for (const std::string other : {"slab_model: {kind: momiji}\n", "particle: {kind: wang}\n"}) {
      const std::string saltation = "saltation: {model: " + model;
      const std::string message = refusal(saltation + "}\n" + other);
      EXPECT_NE(message.find("saltation.model: = " + model + " beside"), std::string::npos) << message;
      EXPECT_EQ(refusal(saltation + ", enabled: false}\n" + other), "") << "it is off";
    }
}

TEST_F(SandModels, EachAloneIsTaken) {
  for (const std::string model :
       {"saltation: {model: continuum}\n", "saltation: {model: desertscape_2019}\n",
        "saltation: {influx: 0.1}\n", "slab_model: {kind: bishop}\n", "particle: {kind: wang}\n"})
    EXPECT_EQ(refusal(model), "") << model;
}

TEST_F(SandModels, AChangeOfARunningOneIsRefusedToo) {
  const auto slabs = simulation("slab_model: {kind: werner}\n");
  EXPECT_THROW(slabs->apply(command::SetParameters{{"saltation.model=continuum"}, 0}), ConfigError);
  EXPECT_NO_THROW(test::run(*slabs, 2));
}

}  // namespace
}  // namespace desert_sim
