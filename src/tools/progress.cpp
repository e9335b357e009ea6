#include "src/tools/progress.hpp"

#include <unistd.h>

#include <cstdio>
#include <string>

namespace desert_sim {

namespace {

std::string duration(double seconds) {
  char text[40];
  const long s = static_cast<long>(seconds + 0.5);
  std::snprintf(text, sizeof text, s >= 3600 ? "%ld:%02ld:%02ld" : "%.0ld%02ld:%02ld", s / 3600, s / 60 % 60,
                s % 60);
  return text;
}

}  // namespace

Progress::Progress(std::uint64_t first, std::uint64_t last, bool quiet, const char* unit)
    : first_(first),
      last_(last),
      unit_(unit),
      quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) != 0),
      start_(Clock::now()),
      next_(start_ + std::chrono::milliseconds(terminal_ ? 100 : 5000)) {}

Progress::~Progress() {
  if (terminal_ && printed_) std::fputc('\n', stderr);
}

void Progress::at(std::uint64_t step) {
  if (quiet_) return;
  if (step != last_ && Clock::now() < next_) return;
  next_ = Clock::now() + std::chrono::milliseconds(terminal_ ? 100 : 5000);
  print(step);
}

void Progress::print(std::uint64_t step) {
  const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
  const double done = static_cast<double>(step - first_), rate = elapsed > 0 ? done / elapsed : 0;
  const double left = rate > 0 ? static_cast<double>(last_ - step) / rate : 0;
  const double share = last_ > first_ ? done / static_cast<double>(last_ - first_) : 1;
  if (terminal_) {
    constexpr int width = 32;
    const std::string bar(static_cast<std::size_t>(share * width), '#');
    std::fprintf(stderr, "\r[%-*s] %3.0f %%  %s %llu of %llu  %.1f %ss/s  %s left ", width, bar.c_str(),
                 100 * share, unit_, static_cast<unsigned long long>(step),
                 static_cast<unsigned long long>(last_), rate, unit_, duration(left).c_str());
    printed_ = true;
  } else {
    std::fprintf(stderr, "%s %llu of %llu (%.0f %%), %.1f %ss/s, %s left\n", unit_,
                 static_cast<unsigned long long>(step), static_cast<unsigned long long>(last_), 100 * share,
                 rate, unit_, duration(left).c_str());
  }
}

}  // namespace desert_sim
