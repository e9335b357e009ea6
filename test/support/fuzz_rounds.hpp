#pragma once
/// How long tests with random input go on.

#include <cstdlib>
#include <string>

namespace desert_sim::test {

/// `usual`, or what the environment variable DESERT_FUZZ_ROUNDS says.
inline int fuzz_rounds(int usual) {
  const char* given = std::getenv("DESERT_FUZZ_ROUNDS");
  return given ? std::stoi(given) : usual;
}

}  // namespace desert_sim::test
