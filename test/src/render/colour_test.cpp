// A hue is a colour: red, yellow, green, blue on its circle.

#include "src/render/colour.hpp"

#include <gtest/gtest.h>

namespace desert_sim::render {
namespace {

TEST(CrownColour, GoesRoundTheCircleOfHues) {
  const Colour green = crown_colour(120), red = crown_colour(0), round = crown_colour(360),
               blue = crown_colour(240), yellow = crown_colour(60);
  EXPECT_GT(green.g, 2 * green.r);
  EXPECT_EQ(green.r, green.b);
  EXPECT_TRUE(red.r == round.r && red.g == round.g && red.b == round.b);
  EXPECT_GT(red.r, 2 * red.g);
  EXPECT_GT(blue.b, 2 * blue.g);
  EXPECT_EQ(yellow.r, yellow.g);
}

}  // namespace
}  // namespace desert_sim::render
