#pragma once
/// Parameters of the slab models; see slab_model.hpp.

#include "src/core/parameters.hpp"

namespace desert_sim {

enum class SlabKind : int { none, werner, momiji, bishop };
constexpr const char* slab_kind_names[] = {"none", "werner", "momiji", "bishop"};

enum class SlabPolling : int { repeated, non_repeated };
constexpr const char* slab_polling_names[] = {"repeated", "non_repeated"};

struct SlabModelParameters {
  SlabKind kind = SlabKind::none;
  float slab_height = 1.0f / 3.0f;
  SlabPolling polling = SlabPolling::repeated;
  float poll_time = 1.0f;
  float hop_time = 1.0f;
  float deposit_on_sand = 0.6f;
  float deposit_on_rock = 0.4f;
  float repose_deg = 30.0f;
  float shadow_deg = 15.0f;
  float longest_shadow = 120.0f;
  float linear_speedup = 0.4f;
  float square_speedup = 0.002f;
};

constexpr auto parameter_table(const SlabModelParameters*) {
  using P = SlabModelParameters;
  return std::make_tuple(
      parameter("kind", &P::kind, slab_kind_names,
                "Slab model that moves sand in place of saltation, reptation and avalanching."),
      parameter("slab_height", &P::slab_height, 0.001, 10, "m", "Height of a slab; whole slabs move."),
      parameter("polling", &P::polling, slab_polling_names,
                "Whether cells are polled at random, some more than once, or each of them once in turn."),
      parameter("poll_time", &P::poll_time, 0.001, 1e9, "s", "Time in which each cell is polled once."),
      parameter("hop_time", &P::hop_time, 0.001, 1000, "s", "Length of a hop over the speed of the wind."),
      parameter("deposit_on_sand", &P::deposit_on_sand, 0.01, 1, "1",
                "Probability that a slab that lands on sand stays there."),
      parameter("deposit_on_rock", &P::deposit_on_rock, 0.01, 1, "1",
                "The same where there is less than a slab of sand."),
      parameter("repose_deg", &P::repose_deg, 1, 80, "deg", "Angle of repose, seen before a slab moves."),
      parameter("shadow_deg", &P::shadow_deg, 1, 80, "deg",
                "Angle of the wind's shadow, in which all slabs stay that land."),
      parameter("longest_shadow", &P::longest_shadow, 1, 10000, "m",
                "Longest shadow; longer ones may end there."),
      parameter("linear_speedup", &P::linear_speedup, 0, 100, "cells/slab",
                "C1: what a slab of height adds to a hop (momiji, bishop)."),
      parameter("square_speedup", &P::square_speedup, 0, 10, "cells/slab^2",
                "C2: the same of its square, above the reference height."));
}
static_assert(table_is_complete<SlabModelParameters>());

}  // namespace desert_sim
