#include "src/scenario/gusts.hpp"

#include <algorithm>

#include "kernels/field/draws.hpp"
#include "kernels/field/random.hpp"
#include "src/scenario/wind_regime.hpp"

namespace desert_sim {

wind::Vector Gusts::around(wind::Vector regime, double time) const {
  constexpr double highest_speed = 100;  // of a segment's table [m/s]
  const auto gust =
      static_cast<std::uint64_t>(std::clamp((time - start_time) / gust_time, 0.0, 0x1p63));  // its number
  // Roses draw with the same purpose, and with 0 where a member has its number.
  const RandomWords draw = random_words(seed, Purpose::wind_rose, static_cast<std::uint32_t>(gust),
                                        static_cast<std::uint32_t>(gust >> 32), member);
  double speed = 0, direction_deg = 0;
  speed_and_direction(regime, speed, direction_deg);
  const double gusty =
                   speed * (1 + gust_speed * static_cast<double>(normal_draw(draw.word[0], draw.word[1]))),
               turned = gust_direction_deg * static_cast<double>(normal_draw(draw.word[2], draw.word[3]));
  return wind_vector(direction_deg + turned, std::clamp(gusty, 0.0, std::max(speed, highest_speed)));
}

}  // namespace desert_sim
