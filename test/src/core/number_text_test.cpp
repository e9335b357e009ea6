#include "src/core/number_text.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace desert_sim {
namespace {

TEST(NumberText, CoordinatesAreTextsToTheMillimetre) {
  EXPECT_EQ(point_text(346000.25, 4400000.1), "(346000.25, 4400000.1)");
  EXPECT_EQ(coordinate_text(1000), "1000");
  EXPECT_EQ(coordinate_text(-12.5), "-12.5");
  EXPECT_EQ(coordinate_text(0.0014), "0.001");
  EXPECT_EQ(coordinate_text(-1e-9), "0");
  EXPECT_EQ(coordinate_text(std::nan("")), "nan");
  EXPECT_EQ(coordinate_text(1e300).size(), 301u);
}

TEST(NumberText, NumbersHaveTheDigitsThatCount) {
  EXPECT_EQ(number_text(0.123456), "0.123");
  EXPECT_EQ(number_text(1000), "1e+03");
  EXPECT_EQ(number_text(1000, 9), "1000");
}

}  // namespace
}  // namespace desert_sim
