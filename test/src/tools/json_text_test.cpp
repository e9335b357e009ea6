// Numbers and strings in JSON, also those that it has no form for.

#include "src/tools/json_text.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace {

using namespace desert_sim;

TEST(JsonText, EscapesWhatJsonEscapes) {
  EXPECT_EQ(json_string("a \"b\" \\ \n\x01"), "\"a \\\"b\\\" \\\\ \\u000a\\u0001\"");
  EXPECT_EQ(json_string("D\xc3\xbcne \xe2\x82\xac \xf0\x9f\x8f\x9c"),
            "\"D\xc3\xbcne \xe2\x82\xac \xf0\x9f\x8f\x9c\"");
}

TEST(JsonText, BytesThatAreNoUtf8AreReplaced) {
  EXPECT_EQ(json_string("\xff"), "\"\\ufffd\"");
  EXPECT_EQ(json_string("a\xc3"), "\"a\\ufffd\"") << "an end that is missing";
  EXPECT_EQ(json_string("\xc0\x80"), "\"\\ufffd\\ufffd\"") << "longer than needed";
  EXPECT_EQ(json_string("\xed\xa0\x80z"), "\"\\ufffd\\ufffd\\ufffdz\"") << "half of a pair of UTF-16";
  EXPECT_EQ(json_string("\xf4\x90\x80\x80"), "\"\\ufffd\\ufffd\\ufffd\\ufffd\"")
      << "beyond the last character";
}

TEST(JsonText, NumbersAreReadBackExactlyAndOthersAreNull) {
  EXPECT_EQ(std::stod(json_number(0.1)), 0.1);
  EXPECT_EQ(json_number(std::numeric_limits<double>::infinity()), "null");
  EXPECT_EQ(json_number(std::numeric_limits<double>::quiet_NaN()), "null");
}

}  // namespace
