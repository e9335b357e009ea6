// The section `appearance`: colours of materials, live, and no part of the physics.

#include "src/scenario/appearance.hpp"

#include <gtest/gtest.h>

#include "src/core/error.hpp"
#include "src/scenario/scenario.hpp"

namespace desert_sim {
namespace {

TEST(Appearance, DefaultsAreThePalette) {
  const render::Palette palette = palette_of(AppearanceParameters()), usual;
  for (const render::NamedColour& one : render::palette_colours)
    EXPECT_TRUE(palette.*one.colour == usual.*one.colour) << one.name;
}

TEST(Appearance, EachColourIsItsOwn) {
  AppearanceParameters appearance;
  for_each_parameter(appearance, [n = 0](const auto& row, auto& value) mutable {
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, ShortList>) {
      value.values[0] = 0.1f * static_cast<float>(++n);
      EXPECT_STREQ(row.name, render::palette_colours[n - 1].name) << "named alike, in the same order";
    }
  });
  const render::Palette palette = palette_of(appearance);
  float n = 0;
  for (const render::NamedColour& one : render::palette_colours)
    EXPECT_EQ((palette.*one.colour).r, 0.1f * ++n) << one.name;
}

TEST(Appearance, AColourHasThreeNumbersWithinTheirRange) {
  const auto refusal = [](const char* colour) {
    try {
      parse_scenario_text(std::string("appearance: {sand: ") + colour + "}", "test");
    } catch (const ConfigError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refusal("[0.5, 0.4, 0.3]"), "");
  EXPECT_NE(refusal("[0.5, 0.4]").find("appearance.sand: has 2 numbers (allowed: three"), std::string::npos)
      << refusal("[0.5, 0.4]");
  EXPECT_NE(refusal("[0.5, 0.4, 0.3, 1]").find("has 4 numbers"), std::string::npos);
  EXPECT_NE(refusal("[0.5, 0.4, 1.3]").find("appearance.sand[2]"), std::string::npos)
      << refusal("[0.5, 0.4, 1.3]");
}

}  // namespace
}  // namespace desert_sim
