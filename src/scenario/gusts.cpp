#include "src/scenario/gusts.hpp"

#include <algorithm>

#include "kernels/field/draws.hpp"
#include "kernels/field/random.hpp"
#include "src/core/elementary.hpp"
#include "src/scenario/wind_regime.hpp"

namespace desert_sim {

wind::Vector Gusts::around(wind::Vector regime, double time) const {
  constexpr double highest_speed = 100;  // of a segment's table [m/s]
  const auto gust =
      static_cast<std::uint64_t>(std::clamp((time - start_time) / gust_time, 0.0, 0x1p63));  // its number
  // Roses draw with the same purpose, and with 0 where a member has its number.
  const RandomWords draw = random_words(seed, Purpose::wind_rose, static_cast<std::uint32_t>(gust),
                                        static_cast<std::uint32_t>(gust >> 32), member);
  const double speed = elementary::hypot(regime.x, regime.y), most = std::max(1.0, highest_speed / speed),
               share = std::clamp(
                   1 + gust_speed * static_cast<double>(normal_draw(draw.word[0], draw.word[1])), 0.0, most);
  // A rotation, because directions as angles would round.
  const wind::Vector turn =
      unit_vector(gust_direction_deg * static_cast<double>(normal_draw(draw.word[2], draw.word[3])));
  return {static_cast<float>(share * (regime.x * turn.x - regime.y * turn.y)),
          static_cast<float>(share * (regime.x * turn.y + regime.y * turn.x))};
}

}  // namespace desert_sim
