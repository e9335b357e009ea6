// JSON of the programs: text and numbers that JSON has no form for, and files that are none.

#include "src/tools/json.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>

#include "src/core/error.hpp"
#include "test/support/temporary_folder.hpp"

namespace {

using namespace desert_sim;

TEST(Json, BytesThatAreNoUtf8AreReplaced) {
  EXPECT_EQ(json_text("a \"b\" D\xc3\xbcne \xf0\x9f\x8f\x9c"),
            "\"a \\\"b\\\" D\xc3\xbcne \xf0\x9f\x8f\x9c\"\n");
  EXPECT_EQ(json_text("\xff"), "\"\xef\xbf\xbd\"\n");
  EXPECT_EQ(json_text("a\xc3"), "\"a\xef\xbf\xbd\"\n") << "an end that is missing";
}

TEST(Json, NumbersAreReadBackExactlyAndOthersAreNull) {
  EXPECT_EQ(std::stod(json_text(0.1)), 0.1);
  EXPECT_EQ(json_text(std::numeric_limits<double>::infinity()), "null\n");
  EXPECT_EQ(json_text(std::numeric_limits<double>::quiet_NaN()), "null\n");
}

TEST(Json, WhatIsNoneIsRefusedWithItsPath) {
  const test::TemporaryFolder folder;
  std::ofstream(folder.path("cut.json")) << "{\"steps\": 3,";
  try {
    read_json(folder.path("cut.json"));
    FAIL() << "it was read";
  } catch (const ConfigError& e) {
    EXPECT_NE(std::string(e.what()).find("cut.json: is not JSON: "), std::string::npos) << e.what();
  }
}

}  // namespace
