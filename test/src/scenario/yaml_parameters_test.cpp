// Messages stay short, whatever the input holds.
#include "src/scenario/yaml_parameters.hpp"

#include <gtest/gtest.h>

#include "src/core/error.hpp"
#include "src/scenario/scenario.hpp"

namespace desert_sim {
namespace {

std::string yaml_refusal(const std::string& yaml) {
  try {
    parse_scenario_text(yaml, "long");
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

TEST(Messages, AnErrorHoldsAtMost2000Bytes) {
  EXPECT_EQ(std::string(ConfigError("short").what()), "short");
  EXPECT_EQ(std::string(ConfigError(std::string(2000, 'a')).what()), std::string(2000, 'a'));
  const std::string message = ConfigError(std::string(5000000, 'a')).what();
  EXPECT_LE(message.size(), max_message_size);
  EXPECT_NE(message.find("(4998060 more bytes are left out)"), std::string::npos) << message;
}

TEST(Messages, AHundredThousandUnknownKeysMakeOneShortMessage) {
  std::string yaml = "grid: {";
  for (int n = 0; n < 100000; ++n) yaml += "unknown_" + std::to_string(n) + ": 1, ";
  const std::string message = yaml_refusal(yaml + "width: 3}");
  EXPECT_LE(message.size(), max_message_size);
  EXPECT_NE(message.find("grid.unknown_0"), std::string::npos) << message;
  EXPECT_NE(message.find("more errors"), std::string::npos) << message;
}

TEST(Messages, TheErrorsThatAreLeftOutAreCounted) {
  ValidationErrors errors("input");
  for (int n = 0; n < 500; ++n) errors.add("key", std::string(95, 'x'));  // lines of 107 bytes
  try {
    errors.throw_if_any();
    FAIL() << "errors were added";
  } catch (const ConfigError& e) {
    const std::string message = e.what();
    const auto shown = std::count(message.begin(), message.end(), '\n');
    EXPECT_NE(message.find("and " + std::to_string(500 - shown) + " more errors"), std::string::npos)
        << message;
    EXPECT_GE(shown, 10);
  }
}

TEST(Messages, AKeyOfAMegabyteIsCut) {
  const std::string message = yaml_refusal("grid:\n  ? " + std::string(1000000, 'k') + "\n  : 1\n");
  EXPECT_LE(message.size(), max_message_size);
  EXPECT_NE(message.find("unknown key"), std::string::npos) << message;
}

}  // namespace
}  // namespace desert_sim
