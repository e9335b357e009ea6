#pragma once
/// How fast simulated time passes, in words.

#include <string>

namespace desert_sim {

/// A time as one says it: "an hour", "40 min", "1.5 d", "33 s", "20 ms".
std::string spoken_time(double seconds);

/// What a second of ROS time stands for: "x 3600: an hour of wind in a second", "x 0.03: slower than real
/// time, a second of wind takes 33 s", "not tied to a clock: 10 steps of 6 min a second = x 3600" (with the
/// sign ×). `acceleration`: seconds of simulated time per second of ROS time, 0: not tied to it. `step_rate`:
/// wanted steps per second, 0: as fast as possible. `time_step`: simulated time of a step [s].
std::string pace_text(double acceleration, double step_rate, double time_step);

}  // namespace desert_sim
