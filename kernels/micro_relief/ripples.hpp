#pragma once
/// Wind ripples at a place and a moment. Paris et al. 2019, section 6: presence and shape by the wind's
/// direction, size linear in its speed, asymmetric in a wind of one direction, faded in its shadow.
///
/// A wave whose direction and length differ from place to place cannot have one phase k · x: where k changes
/// with the wind, the phase far from the origin would race. Each square of a lattice therefore has one patch
/// of plane waves around a random centre p, with a random phase there, as in the phasor noise of Tricard et
/// al. 2019 (ACM Trans. Graph. 38, 57), and waves are the weighted mean of the patches that reach a place:
///
///   G = Σ w_i e^(2πi (k_i · (x − p_i) − N + a_i)) / Σ w_i,   w = (1 − r²)³,  r ≤ 1 over 1¼ squares
///   k_i: along the local wind, of length 1/λ of its speed (ripple_size.hpp)
///   h   = −½ H s (1 + a c)/max(s (1 + a c)),   c + i s = G/√(|G|² + g²),  g = 0.15
///
/// Phases are those at the centres, so that all of it is continuous where winds change, and the patterns move
/// downwind by one wavelength as N grows by 1. Where patches are out of step, crests fork and end, as those
/// of ripples do. The asymmetry a makes the lee side steeper; it is that of the parameters times |w̄|/ū.
/// Where that is small, no direction prevails, and ripples fade: from |w̄|/ū = 0.3 down to 0, where their
/// direction may jump.
///
/// The wind at a place is w̄ turned and stretched as the terrain now turns and stretches the wind high above.

#include "kernels/field/random.hpp"
#include "kernels/micro_relief/places.hpp"
#include "kernels/micro_relief/ripple_size.hpp"

namespace desert_sim::micro_relief {

/// sin 2πt and cos 2πt for any number of turns.
struct SineCosine {
  float sine, cosine;
};
DESERT_HD SineCosine of_turns(float turns) {
  const float half_turns = 2.0f * (turns - rintf(turns)), steep = fabsf(half_turns);
  const float folded = steep > 0.5f ? 1.0f - steep : steep;
  const float sine = sine_of_half_turns(folded);
  return {half_turns < 0.0f ? -sine : sine, sine_of_half_turns(0.5f - steep)};
}

/// A patch of plane waves.
struct RipplePatch {
  float east, north;     ///< its centre in its square, 0 … 1
  float wave_x, wave_y;  ///< k [1/m]
  float turns;           ///< phase at the centre
  float height;          ///< H [m]
};

/// The ripples of a moment over cells.
struct Ripples {
  Lattice lattice;
  RippleSize size;
  std::uint64_t seed;
  float wind_x, wind_y, speed;  ///< w̄, ū [m/s]
  float passed;                 ///< N
  float prevalence;             ///< 0 where no direction prevails … 1
  float asymmetry;              ///< a
  float half_height;            ///< ½/max(s (1 + a c))

  Ripples(const MicroReliefParameters& p, const RippleWind& w, std::uint64_t random_seed,
          const Lattice& squares)
      : lattice(squares),
        size(p),
        seed(random_seed),
        wind_x(static_cast<float>(w.x)),
        wind_y(static_cast<float>(w.y)),
        speed(static_cast<float>(w.speed)),
        passed(static_cast<float>(w.passed)) {
    const float share = speed > 0 ? minimum(hypotenuse(wind_x, wind_y) / speed, 1.0f) : 0.0f;
    prevalence = smooth_step(share / 0.3f);
    asymmetry = p.asymmetry * share;
    const float a = asymmetry, c = a > 1e-3f ? (std::sqrt(1 + 8 * a * a) - 1) / (4 * a) : a;
    half_height = 0.5f / (std::sqrt(1 - c * c) * (1 + a * c));
  }

  /// The local w̄ and ū at a place.
  struct LocalWind {
    float x, y, speed;
  };
  DESERT_HD LocalWind wind_at(const Cells& cells, const Cells::Corners& at) const {
    const float zx = cells.value(cells.turn_x, at), zy = cells.value(cells.turn_y, at);
    return {wind_x * zx - wind_y * zy, wind_x * zy + wind_y * zx, speed * hypotenuse(zx, zy)};
  }

  /// The patch of a square, which Lattice::column() and row() number.
  DESERT_HD RipplePatch patch(const Cells& cells, int i, int j) const {
    const RandomWords words =
        random_words(seed, Purpose::ripples, static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j), 0);
    constexpr float unit = 1.0f / 16777216.0f;
    const auto share = [&](int n) { return static_cast<float>(words.word[n] >> 8) * unit; };
    RipplePatch p;
    p.east = 0.25f + 0.5f * share(0);
    p.north = 0.25f + 0.5f * share(1);
    const Cells::Corners at =
        cells.corners((i + double{p.east}) * lattice.pitch_x, (j + double{p.north}) * lattice.pitch_y);
    const LocalWind wind = wind_at(cells, at);
    const float length = hypotenuse(wind.x, wind.y);
    const float per = length > 1e-6f ? 1.0f / (length * size.wavelength(wind.speed)) : 0.0f;
    p.wave_x = wind.x * per;
    p.wave_y = wind.y * per;
    p.turns = share(2) - passed;
    p.height = size.height(wind.speed) * (1.0f - clamp(cells.value(cells.growth, at), 0.0f, 1.0f));
    return p;
  }

  /// What the patches around a place come to.
  struct Wave {
    float shape;   ///< h/H, −½ … ½
    float height;  ///< H [m]
  };
  /// `patch_of(i, j)` gives the patch of a square next to the place's.
  template <class Patches>
  DESERT_HD Wave wave(const Lattice::Square& at, const Patches& patch_of) const {
    constexpr float reach = 1.25f, noise = 0.15f;
    float real = 0, imaginary = 0, height = 0, weight = 0;
    for (int dj = -1; dj <= 1; ++dj)
      for (int di = -1; di <= 1; ++di) {
        const RipplePatch p = patch_of(at.i + di, at.j + dj);
        const float a = at.east - static_cast<float>(di) - p.east,
                    b = at.north - static_cast<float>(dj) - p.north;
        const float rest = 1.0f - (a * a + b * b) * (1.0f / (reach * reach));
        if (!(rest > 0.0f)) continue;
        const float w = rest * rest * rest;
        const SineCosine phase =
            of_turns(p.wave_x * (a * lattice.pitch_x) + p.wave_y * (b * lattice.pitch_y) + p.turns);
        real += w * phase.cosine;
        imaginary += w * phase.sine;
        height += w * p.height;
        weight += w;
      }
    if (!(weight > 0.0f)) return {0.0f, 0.0f};
    const float per = 1.0f / weight, c = real * per, s = imaginary * per;
    const float scale = 1.0f / sqrtf(c * c + s * s + noise * noise);
    return {-half_height * prevalence * (s * scale) * (1.0f + asymmetry * (c * scale)), height * per};
  }
};

}  // namespace desert_sim::micro_relief
