// Command lines: what is read, what is refused.

#include "src/tools/options.hpp"

#include <gtest/gtest.h>

#include "src/core/error.hpp"

namespace desert_sim {
namespace {

Options parse(std::vector<std::string> arguments) {
  std::vector<char*> argv{const_cast<char*>("program")};
  for (std::string& argument : arguments) argv.push_back(argument.data());
  return Options(static_cast<int>(argv.size()), argv.data(), {"steps", "set"}, {"quiet"});
}

TEST(Options, AreReadInAnyOrderWithSpaceOrEquals) {
  const Options o = parse({"--quiet", "a.yaml", "--set", "x=1", "--steps=12", "--set=y=2", "b.yaml"});
  EXPECT_EQ(o.positional(), (std::vector<std::string>{"a.yaml", "b.yaml"}));
  EXPECT_TRUE(o.has("quiet"));
  EXPECT_EQ(o.number("steps", 0, 0, 100), 12);
  EXPECT_EQ(o.values("set"), (std::vector<std::string>{"x=1", "y=2"}));
  EXPECT_FALSE(parse({}).has("steps"));
  EXPECT_EQ(parse({}).number("steps", 7, 0, 100), 7);
  EXPECT_EQ(parse({}).text("set", "none"), "none");
  EXPECT_EQ(parse({"--steps", "1", "--steps", "2"}).number("steps", 0, 0, 100), 2);
}

TEST(Options, AreRefusedByName) {
  for (const auto& arguments : std::vector<std::vector<std::string>>{
           {"--stpes", "3"}, {"--steps"}, {"--quiet=yes"}, {"--"}, {"--=3"}})
    EXPECT_THROW(parse(arguments), ConfigError) << arguments[0];
}

TEST(Options, NumbersAreWholeAndInTheirRange) {
  for (const char* value : {"", "x", "1x", "1.5", "-1", "101", "99999999999999999999999", " "})
    EXPECT_THROW(parse({"--steps", value}).number("steps", 0, 0, 100), ConfigError) << "'" << value << "'";
  EXPECT_THROW(parse({"--steps="}).number("steps", 0, 0, 100), ConfigError);
  EXPECT_EQ(parse({"--steps", "100"}).number("steps", 0, 0, 100), 100);
}

}  // namespace
}  // namespace desert_sim
