/// The step of shear_stress.hpp; compiled once for each backend.
#include "kernels/wind/shear_stress.hpp"

#include <type_traits>

#include "kernels/backend/loops.hpp"
#include "kernels/wind/downwind.hpp"
#include "kernels/wind/surface_wind.hpp"
#include "src/core/elementary.hpp"

namespace desert_sim::shear_stress {

using wind::Downwind;

/// Where the air comes from to a place of a line: between two places of the line before.
struct Upwind {
  static constexpr int reach = 2;
  int near;  ///< the other one is a place before it
  float of_far;

  explicit Upwind(int shift) : near(-(shift >> 16)), of_far(fraction(shift)) {}
  template <class Words>
  DESERT_HD float interpolated(const Words& before, int word) const {
    return lerp(before(word, near), before(word, near - 1), of_far);
  }
};

/// The heights of the ground in the order of the sweeps.
struct TakeGround {
  Downwind order;
  const float* heights;
  float* ground;

  DESERT_HD void operator()(int x, int y) const {
    ground[order.slot(x, y)] = heights[order.grid.index(x, y)];
  }
};

/// A sweep with or against the wind over fields in the order of the former; where the terrain is periodic
/// along it, it may begin before its first line.
struct Sweep {
  static constexpr int reach = Upwind::reach;
  static_assert(reach == reach_of_words);
  using Word = float;
  // Numbers, not a Downwind and a flag, which compilers would choose by in each place of a line.
  int lines, length, first_slot, slots_to_next;
  bool periodic_across;
  Upwind upwind;

  Sweep(const Downwind& order, bool against, const Upwind& from)
      : lines(order.lines()),
        length(order.length()),
        first_slot(against ? (lines - 1) * length : 0),
        slots_to_next(against ? -length : length),
        periodic_across(order.periodic_across()),
        upwind(from) {}

  DESERT_HD int slot(int line, int place) const {
    return first_slot + (line < 0 ? line + lines : line) * slots_to_next + place;
  }
  DESERT_HD bool around() const { return periodic_across; }
  DESERT_HD float beyond(int, float nearest) const { return nearest; }
};

/// How low the ground lies in the lee of each cell, seen against the wind: the lowest of all heights downwind
/// to which it falls more steeply than `rise` a line.
struct FindLee : Sweep {
  static constexpr int words = 1;
  using Loaded = float;
  float rise;  ///< [quanta]
  const float* ground;
  float* lee;

  FindLee(const Sweep& windward, float per_line, const float* heights, float* to)
      : Sweep(windward), rise(per_line), ground(heights), lee(to) {}

  DESERT_HD float before_first(int, int) const { return 2.0f * static_cast<float>(wall_height); }
  DESERT_HD float load(int line, int place) const { return ground[slot(line, place)]; }
  template <class Before, class After>
  DESERT_HD float pass(float height, const Before& before, const After& after) const {
    const float low = minimum(height, upwind.interpolated(before, 0) + rise);
    after(0) = low;
    return low;
  }
  DESERT_HD void store(int line, int place, float low) const { lee[slot(line, place)] = low; }
};

/// The surface with separation bubbles, line after line downwind.
struct FillBubbles : Sweep {
  /// Of the flow along the ground or above it: its height [quanta], and of a line its rise and by how much
  /// that falls [quanta].
  enum Words { height, slope, bend, words };
  static_assert(words == words_handed_on);
  struct Loaded {
    float height, lee;
  };
  float steepest;         ///< fall of the separated flow from a line to the next [quanta]
  float lines_a_quantum;  ///< over which the flow bends, of the height above the lee
  const float *ground, *lee;
  float* filled;

  FillBubbles(const Sweep& leeward, float steepest_fall, float lines_per_quantum, const float* heights,
              const float* low, float* to)
      : Sweep(leeward),
        steepest(steepest_fall),
        lines_a_quantum(lines_per_quantum),
        ground(heights),
        lee(low),
        filled(to) {}

  DESERT_HD float before_first(int word, int) const {
    return word == height ? -2.0f * static_cast<float>(wall_height) : 0.0f;
  }
  DESERT_HD Loaded load(int line, int place) const {
    const int n = slot(line, place);
    return {ground[n], lee[n]};
  }
  template <class Before, class After>
  DESERT_HD float pass(const Loaded& here, const Before& before, const After& after) const {
    const float below = upwind.interpolated(before, height), bends = upwind.interpolated(before, bend);
    const float falls = maximum(upwind.interpolated(before, slope) - bends, -steepest), flow = below + falls;
    const bool attached = here.height >= flow;
    const float rises = attached ? here.height - below : falls, surface = maximum(here.height, flow);
    after(height) = surface;
    after(slope) = clamp(rises, -steepest, 0.0f);  // of the flow it is falls, which lies in between
    after(bend) = attached ? bend_from(here) : bends;
    return surface;
  }
  DESERT_HD float bend_from(const Loaded& brink) const {
    return steepest / maximum((brink.height - brink.lee) * lines_a_quantum, 1.0f);
  }
  DESERT_HD void store(int line, int place, float surface) const { filled[slot(line, place)] = surface; }
};

/// Means of the surface with its bubbles along the rows of the terrain.
struct CoarsenFilled {
  wind::CoarsenRows rows;  ///< of heights in the order of the sweep
  Downwind order;

  DESERT_HD void operator()(int column, int y) const {
    const float* const filled = rows.heights;
    const Downwind slots = order;
    rows.store_mean(column, y, [filled, slots, y](int x) { return filled[slots.slot(x, y)]; });
  }
};

/// The surface with its bubbles on a grid of the terrain's own cells.
struct TakeFilled {
  wind::CoarseGrid coarse;
  Downwind order;
  const float* filled;
  float reference, quantum;
  Complex* spectrum;

  DESERT_HD void operator()(int x, int y) const {
    const float height = filled[order.slot(coarse.mirrored_column(x), coarse.mirrored_row(y))];
    spectrum[y * coarse.width + x] = {quantum * (height - reference), 0.0f};
  }
};

/// Multiplies the spectrum of the surface by the response: real parts become τ_∥/τ_0, imaginary parts
/// τ_⊥/τ_0.
struct Respond {
  wind::CoarseGrid coarse;
  wind::Vector along;  ///< unit vector of the wind
  float a, b, cells_per_metre;
  const float *transfer_x, *transfer_y;
  Complex* spectrum;

  DESERT_HD void operator()(int i, int j) const {
    Complex& value = spectrum[j * coarse.width + i];
    const wind::Mode mode(coarse, i, j);
    const float size = hypotenuse(mode.kx, mode.ky);
    const float scale = transfer_x[i] * transfer_y[j] * cells_per_metre / maximum(size, 1e-20f);
    const float k_along = mode.kx * along.x + mode.ky * along.y,
                k_across = mode.ky * along.x - mode.kx * along.y;
    // The sign of a Nyquist wavenumber is undefined; the mean over both is the part that smooths the bed.
    // Without it nothing would damp waves of two cells.
    const float mean_square = mode.kx * along.x * mode.kx * along.x + mode.ky * along.y * mode.ky * along.y;
    const float even = scale * k_along * (a * k_along), smoothing = scale * a * mean_square;
    const float signed_part = mode.nyquist ? 0.0f : 1.0f;
    const float odd = b * fabsf(k_along) * signed_part, half = 0.5f * scale * k_across;
    const Complex parallel = response(value, mode.nyquist ? smoothing : even, scale * k_along * odd);
    const Complex across = response(value, half * (a * k_along) * signed_part, half * odd);
    value = {parallel.re - across.im, parallel.im + across.re};  // parallel + i across
  }
  DESERT_HD static Complex response(Complex h, float real, float imaginary) {
    return {h.re * real - h.im * imaginary, h.re * imaginary + h.im * real};
  }
};

/// The layers wind_x and wind_y from the response and the bubbles. `full`: the response has a value a cell.
template <bool full>
struct BlowOverGround {
  wind::CoarseGrid coarse;
  wind::Vector above, along;
  const Complex* response;  ///< null: none; interpolated along x, or `full`
  Downwind order;
  const float *heights, *filled;  ///< in the order of the terrain, and in that of the sweep
  float per_fall;                 ///< 1 over what the separated flow falls in a cell [1/quanta]
  const float *perturbation_x, *perturbation_y;
  float *wind_x, *wind_y;

  DESERT_HD void operator()(int x, int y) const {
    const int i = coarse.fine.index(x, y);
    const float u = above.x + value_or_zero(perturbation_x, i),
                v = above.y + value_or_zero(perturbation_y, i);
    const Complex stress = response_at(x, y);
    const float open = 1.0f - clamp((filled[order.slot(x, y)] - heights[i]) * per_fall, 0.0f, 1.0f);
    const float parallel = maximum(1.0f + stress.re, 0.0f) * open, across = stress.im * open;
    const float size = sqrtf(hypotenuse(parallel, across));
    const float scale = size > 0.0f ? 1.0f / size : 0.0f;
    wind_x[i] = (u * parallel - v * across) * scale;
    wind_y[i] = (v * parallel + u * across) * scale;
  }
  DESERT_HD Complex response_at(int x, int y) const {
    if (!response) return {0.0f, 0.0f};
    if constexpr (full) return response[y * coarse.width + x];
    wind::InterpolatedColumn<Complex> column(response, x, coarse.fine.width);
    const wind::AxisInterpolation along_y = coarse.interpolation_y(y);
    column.move_to(along_y);
    return column.at(along_y);
  }
};

/// Where the axis is periodic, the sweeps begin a longest_bubble before the first line.
template <class E>
void fill_bubbles(E& exec, const TerrainView& t, const ShearStressParameters& p, const Downwind& order,
                  wind::Vector along, float tangent, const surface::Heights& heights, Workspace& work) {
  const float shift = order.shift(along.x, along.y), l = t.grid.cell_size;
  const float line = l * std::sqrt(1.0f + shift * shift);  // from a line to the next [m]
  const int lines = order.lines(), before = static_cast<int>(std::ceil(p.longest_bubble / l));
  const int first = order.periodic_along() ? -std::min(lines, before) : 0;
  const float *ground = work.ground.data(), *lee = work.lee.data();
  for_each_cell(exec, t.grid, TakeGround{order, heights.cell_heights.data(), work.ground.data()});
  const auto sweep = [&](bool against) {
    return Sweep(order, against, Upwind(to_fixed_point(against ? -shift : shift)));
  };
  for_each_line_in_turn(
      exec, first, lines, order.length(), work.lines.data(),
      FindLee(sweep(true), p.lee_slope * line * t.quanta_per_metre, ground, work.lee.data()));
  for_each_line_in_turn(
      exec, first, lines, order.length(), work.lines.data(),
      FillBubbles(sweep(false), tangent * line * t.quanta_per_metre,
                  p.bend_length / (line * t.quanta_per_metre), ground, lee, work.filled.data()));
}

template <class E>
void respond(E& exec, const TerrainView& t, const ShearStressParameters& p, const Downwind& order,
             wind::Vector along, float reference, Workspace& work) {
  const wind::CoarseGrid& coarse = work.coarse;
  const Grid grid = coarse.transformed();
  Grid given = grid;
  given.height = work.fft->rows_given();
  if (coarse.is_full()) {
    for_each_cell(exec, given,
                  TakeFilled{coarse, order, work.filled.data(), reference, t.quantum, work.spectrum.data()});
  } else {
    const wind::CoarsenRows rows{coarse, work.filled.data(), reference, work.row_means.data()};
    for_each_cell(exec, rows.grid(), CoarsenFilled{rows, order});
    for_each_cell(exec, given,
                  wind::CoarsenColumns{coarse, work.row_means.data(), t.quantum, work.rise.data(),
                                       work.spectrum.data()});
  }
  work.fft->forward(work.spectrum.data());
  for_each_cell(exec, grid,
                Respond{coarse, along, p.in_phase, p.in_quadrature, 1.0f / t.grid.cell_size,
                        work.transfer_x.data(), work.transfer_y.data(), work.spectrum.data()});
  work.fft->inverse(work.spectrum.data());
  if (coarse.is_full()) return;
  const wind::InterpolateRows interpolate{coarse, work.spectrum.data(), nullptr, work.rows.data(), nullptr};
  for_each_cell(exec, interpolate.grid(), interpolate);
}

template <class E>
void step(E& exec, const TerrainView& t, const ShearStressParameters& p, const wind::FlowInputs& in,
          Workspace& work) {
  const wind::Vector above = in.above;
  const float speed = hypotenuse(above.x, above.y);
  // In still air, the wind of local features alone has no direction in which the ground could shelter it.
  const wind::Vector along =
      speed > 0.0f ? wind::Vector{above.x / speed, above.y / speed} : wind::Vector{1, 0};
  const auto tangent = static_cast<float>(elementary::tan_deg(p.separation_deg));
  const bool responds = speed > 0.0f && (p.in_phase > 0.0f || p.in_quadrature > 0.0f);
  const Downwind order(t.grid, along);
  fill_bubbles(exec, t, p, order, along, tangent, in.heights, work);
  if (responds) respond(exec, t, p, order, along, static_cast<float>(in.reference), work);
  const float per_fall = 1.0f / (tangent * t.grid.cell_size * t.quanta_per_metre);
  const auto blow = [&](auto full) {
    const Complex* const response = full ? work.spectrum.data() : work.rows.data();
    for_each_cell(
        exec, t.grid,
        BlowOverGround<full>{work.coarse, above, along, responds ? response : nullptr, order,
                             in.heights.cell_heights.data(), work.filled.data(), per_fall, in.perturbation_x,
                             in.perturbation_y, t.real(Layer::wind_x), t.real(Layer::wind_y)});
  };
  if (work.coarse.is_full())
    blow(std::true_type());
  else
    blow(std::false_type());
}

template void step(Backend&, const TerrainView&, const ShearStressParameters&, const wind::FlowInputs&,
                   Workspace&);

}  // namespace desert_sim::shear_stress
