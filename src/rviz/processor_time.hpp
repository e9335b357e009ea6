#pragma once
/// What a frame costs, also where others keep the machine busy.

#include <ctime>

namespace desert_sim {

/// The processor time of this thread [s].
inline double processor_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace desert_sim
