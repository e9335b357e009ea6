/// The laws and the step of wind_shadow.hpp; compiled once for each backend.
#include "kernels/wind/wind_shadow.hpp"

#include "kernels/backend/buffer.hpp"
#include "kernels/backend/for_each.hpp"
#include "kernels/backend/loops.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/surface.hpp"
#include "kernels/wind/wind_shadow_march.hpp"
#include "src/core/parameters.hpp"

namespace desert_sim::wind_shadow {

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

template Shadow straight_shadow(Backend&, const TerrainView&, const WindShadowParameters&,
                                const surface::Heights&, const Workspace&, Course*);
template void step(Backend&, const TerrainView&, const WindShadowParameters&, const surface::Heights&,
                   const Workspace&);

}  // namespace desert_sim::wind_shadow
