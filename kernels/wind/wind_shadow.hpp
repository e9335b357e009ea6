#pragma once
/// Wind shadow: how far a cell lies in the lee. Nilles 2024 eq. 4; physics.md A6.
///
///   t = max over steps of Δh / distance, marching upwind up to `distance`
///   r_s = clamp((t − tan start) / (tan full − tan start), 0, 1)
///
/// Cells of a block of 4 × 4 march in one direction, the wind's in its middle: the wind turns over many
/// blocks, and cells beside each other then share what they look at. A step goes to the next column of cells,
/// or the next row if the wind crosses rows faster, and looks between two cells there. `curved` goes one cell
/// width a step, between four cells, against each cell's own wind, which it re-reads at every step. Marches
/// go through periodic borders; beyond an open edge the edge goes on. Reads the heights, wind_x, wind_y;
/// writes wind_shadow. Laws: wind_shadow_march.hpp.

#include "kernels/backend/buffer.hpp"
#include "kernels/backend/for_each.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/surface.hpp"
#include "kernels/wind/wind_shadow_march.hpp"
#include "src/core/parameters.hpp"

namespace desert_sim {

struct WindShadowParameters {
  bool enabled = true;
  float distance = 10.0f;
  float start_deg = 10.0f;
  float full_deg = 15.0f;
  bool curved = false;
};

constexpr auto parameter_table(const WindShadowParameters*) {
  using P = WindShadowParameters;
  return std::make_tuple(
      parameter("enabled", &P::enabled, "Whether terrain shelters the ground behind it."),
      parameter("distance", &P::distance, 0, 1000, "m",
                "How far upwind shelter is looked for; at least one cell."),
      parameter("start_deg", &P::start_deg, 0, 89, "deg", "Angle to the shelter at which shadow begins."),
      parameter("full_deg", &P::full_deg, 0, 89, "deg", "Angle to the shelter from which shadow is full."),
      parameter("curved", &P::curved, "Whether the march follows the wind as it turns."));
}
static_assert(table_is_complete<WindShadowParameters>());

namespace wind_shadow {

/// `around` is empty where marches are too short for it to pay, or blocks do not fit a periodic axis; it and
/// `courses` where marches follow the wind.
struct Workspace {
  Buffer<float> reciprocals, around;
  Buffer<Course> courses;
};

inline int march_steps(const Grid& grid, const WindShadowParameters& p) {
  return static_cast<int>(maximum(1.0f, floorf(p.distance / grid.cell_size)));
}
Workspace make_workspace(Exec& exec, const Grid& grid, const WindShadowParameters& p);

/// The longest march for which a CPU has a law of its own [steps].
constexpr int short_march = 7;

/// Of marches of at most `longest` steps.
template <int longest, class E>
void short_shadow(E& exec, const Shadow& shadow) {
  if constexpr (longest > 1)
    if (shadow.steps < longest) return short_shadow<longest - 1>(exec, shadow);
  using Inside = ShortShadow<longest>;
  for_each_cell(exec, shadow.grid(),
                Bordered<Inside, Shadow>{shadow.grid(), Inside::margin, {shadow}, shadow});
}

/// The law of straight marches, ready for the terrain as it is. `courses`: those of the workspace, or
/// null, where that spares a pass.
template <class E>
Shadow straight_shadow(E& exec, const TerrainView& t, const WindShadowParameters& p,
                       const surface::Heights& heights, const Workspace& work, Course* courses) {
  const FindCourse find{t.grid, t.real(Layer::wind_x), t.real(Layer::wind_y)};
  if (courses || work.around)
    for_each_cell(exec, heights.blocks,
                  PrepareBlock{{find, heights.blocks, courses},
                               {heights.blocks, heights.highest.data(), work.around.data()}});
  return {find,
          p.distance / t.grid.cell_size,
          march_steps(t.grid, p),
          Shade(p.start_deg, p.full_deg, t.grid.cell_size * t.quanta_per_metre),
          heights.of_cells.data(),
          work.reciprocals.data(),
          t.real(Layer::wind_shadow),
          heights.blocks,
          courses,
          work.around.data()};
}

template <class E>
void step(E& exec, const TerrainView& t, const WindShadowParameters& p, const surface::Heights& heights,
          const Workspace& work) {
  // A pass over the blocks pays where it spares pieces of marches too, and where cells are worked on in rows.
  Course* courses = works_on_rows<E> || work.around ? work.courses.data() : nullptr;
  const Shadow shadow = straight_shadow(exec, t, p, heights, work, courses);
  if (p.curved) {
    for_each_cell(exec, t.grid,
                  CurvedShadow{t.grid, shadow.shade, shadow.heights, shadow.find.wind_x, shadow.find.wind_y,
                               shadow.reciprocals, shadow.steps, shadow.wind_shadow});
    return;
  }
  if constexpr (works_on_rows<E>)
    if (shadow.steps <= short_march) return short_shadow<short_march>(exec, shadow);
  const ShadowOfFour four{shadow};
  for_each_cell(exec, four.fours(), four);
}

}  // namespace wind_shadow
}  // namespace desert_sim
