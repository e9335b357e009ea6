#include "src/core/pace_text.hpp"

#include <cmath>

#include "src/core/number_text.hpp"
#include "src/core/time_units.hpp"

namespace desert_sim {

namespace {

struct SpokenUnit {
  double seconds;
  const char *one, *symbol;
};
constexpr SpokenUnit spoken_units[] = {{seconds_per_year, "a year", "a"},
                                       {86400, "a day", "d"},
                                       {3600, "an hour", "h"},
                                       {60, "a minute", "min"},
                                       {1, "a second", "s"}};

/// "× 3600": with as many digits as the number has before its point, and three at least.
std::string times(double factor) {
  const bool large = std::isfinite(factor) && std::abs(factor) >= 1000 && std::abs(factor) < 1e7;
  return "× " + number_text(large ? std::round(factor) : factor, large ? 7 : 3);
}

}  // namespace

std::string spoken_time(double seconds) {
  for (const SpokenUnit& unit : spoken_units) {
    // What rounds to 1 is one.
    const double amount = seconds / unit.seconds;
    if (!(amount >= 0.9995)) continue;
    const std::string number = number_text(amount >= 10 ? std::round(amount) : amount);
    return number == "1" ? unit.one : number + " " + unit.symbol;
  }
  return seconds >= 0.001 ? number_text(1000 * seconds) + " ms" : number_text(seconds) + " s";
}

std::string pace_text(double acceleration, double step_rate, double time_step) {
  if (acceleration > 0) {
    const std::string factor = times(acceleration);
    if (factor == "× 1") return factor + ": real time";
    return acceleration > 1
               ? factor + ": " + spoken_time(acceleration) + " of wind in a second"
               : factor + ": slower than real time, a second of wind takes " + spoken_time(1 / acceleration);
  }
  const std::string free = "not tied to a clock: ", steps = " of " + spoken_time(time_step);
  if (!(step_rate > 0)) return free + "steps" + steps + ", as fast as it can";
  return free + number_text(step_rate) + (step_rate == 1 ? " step" : " steps") + steps +
         " a second = " + times(step_rate * time_step);
}

}  // namespace desert_sim
