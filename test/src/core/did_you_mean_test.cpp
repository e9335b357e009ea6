#include "src/core/did_you_mean.hpp"

#include <gtest/gtest.h>

namespace desert_sim {
namespace {

TEST(DidYouMean, ATypingErrorAway) {
  const std::string known = "width, height, cell_size, boundary, origin_x";
  for (const char* typed : {"widht", "wdth", "wwidth", "Width", "width ", "withd"})
    EXPECT_EQ(did_you_mean(typed, known), "; did you mean 'width'?") << typed;
  EXPECT_EQ(did_you_mean("cel_size", known), "; did you mean 'cell_size'?");
  EXPECT_EQ(did_you_mean("origin", known), "; did you mean 'origin_x'?");
}

TEST(DidYouMean, NothingThatIsFartherAway) {
  const std::string known = "width, sand, x, wadi";
  for (const char* typed : {"", "depth", "water", "y", "length", "sn", "width"})
    EXPECT_EQ(did_you_mean(typed, known), "") << typed;
  EXPECT_EQ(did_you_mean("sandd", known), "; did you mean 'sand'?");
  EXPECT_EQ(did_you_mean("wady", known), "; did you mean 'wadi'?");
  EXPECT_EQ(did_you_mean(std::string(1000, 'w'), known), "");
  EXPECT_EQ(did_you_mean("width", ""), "");
}

TEST(NotOneOf, QuotesShortensAndSaysWhatMayHaveBeenMeant) {
  EXPECT_EQ(not_one_of("widht", "width, height"),
            "'widht' is not one of: width, height; did you mean 'width'?");
  EXPECT_EQ(not_one_of("depth", "width, height"), "'depth' is not one of: width, height");
  EXPECT_LT(not_one_of(std::string(10'000, 'x'), "width").size(), 300u);
}

}  // namespace
}  // namespace desert_sim
