#pragma once
/// Prints the progress of a long run to stderr: on a terminal a bar with the rate and the remaining time,
/// otherwise a plain line every few seconds.

#include <chrono>
#include <cstdint>

namespace desert_sim {

class Progress {
 public:
  /// `unit`: what is counted.
  Progress(std::uint64_t first, std::uint64_t last, bool quiet, const char* unit = "step");
  ~Progress();
  /// Call after every one; prints at most ten times a second on a terminal, every five seconds otherwise.
  void at(std::uint64_t step);

 private:
  using Clock = std::chrono::steady_clock;
  void print(std::uint64_t step);
  std::uint64_t first_, last_;
  const char* unit_;
  bool quiet_, terminal_, printed_ = false;
  Clock::time_point start_, next_;
};

}  // namespace desert_sim
