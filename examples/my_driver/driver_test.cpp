#include <gtest/gtest.h>

#include <desert_sim/testing.hpp>

TEST(Driver, Arrives) {
  desert_sim::test::Options options;
  options.scenario = "rover_barchans";
  options.seed = 3;
  options.rover = {12, 64};
  desert_sim::test::Desert desert(options);
  EXPECT_TRUE(desert.expect_cost({12, 64}, 0, 30));
  EXPECT_TRUE(desert.expect_rover_arrives({14, 64}, 200));
}

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  desert_sim::test::init(argc, argv, "driver_test");
  return RUN_ALL_TESTS();
}
