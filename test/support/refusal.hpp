#pragma once
/// What is refused, and why.

#include <gtest/gtest.h>

#include <string>

#include "src/core/error.hpp"

namespace desert_sim::test {

/// The message of the ConfigError that the action throws; a failure if it throws none.
template <class Action>
std::string refusal(const Action& action) {
  try {
    action();
  } catch (const ConfigError& e) {
    return e.what();
  }
  ADD_FAILURE() << "was not refused";
  return "";
}

}  // namespace desert_sim::test
