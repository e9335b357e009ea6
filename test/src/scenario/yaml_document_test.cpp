// A text is one YAML document, or it is refused.

#include "src/scenario/yaml_document.hpp"

#include <gtest/gtest.h>

namespace desert_sim {
namespace {

/// The line of which a text is refused, counted from 1; 0: it is not.
int refused_at(const std::string& text) {
  try {
    yaml::load_document(text);
  } catch (const YAML::Exception& e) {
    return e.mark.line + 1;
  }
  return 0;
}

TEST(YamlDocument, HasAllOfTheText) {
  EXPECT_EQ(yaml::load_document("a: {b: 1}\n# the end\n")["a"]["b"].as<int>(), 1);
  EXPECT_EQ(yaml::load_document("---\na: 1\n...\n")["a"].as<int>(), 1);
  for (const char* text : {"", "\n", "# a comment\n", "---\n"})
    EXPECT_TRUE(yaml::load_document(text).IsNull()) << text;
}

/// YAML::Load() takes these for nothing at all, or for their first part, and YAML::LoadAll() takes all the
/// memory there is.
TEST(YamlDocument, WhatBelongsToNoneIsRefused) {
  for (const char* text : {",", ",a: 1", "]", "}\na: 1"}) EXPECT_EQ(refused_at(text), 1) << text;
  for (const char* text : {"a: 1\n---\nb: 2\n", "[1]\n]", "{a: 1}\n, b"})
    EXPECT_EQ(refused_at(text), 2) << text;
}

}  // namespace
}  // namespace desert_sim
