#pragma once
/// What a test finds out about a desert.

#include <string>
#include <type_traits>

namespace desert_sim::test {

/// Whether something has come true, and what was found otherwise. EXPECT_TRUE(expectation) of GoogleTest
/// shows the message, because it becomes a testing::AssertionResult; this header itself needs no GoogleTest.
struct Expectation {
  bool met = false;
  std::string message;  ///< empty if it was met
  int steps = 0;        ///< steps that it took

  explicit operator bool() const { return met; }
  template <class Result,
            class = std::enable_if_t<std::is_class_v<Result> && std::is_constructible_v<Result, bool> &&
                                     !std::is_same_v<Result, Expectation>>>
  operator Result() const {
    return Result(met) << message;
  }
};

}  // namespace desert_sim::test
