/// The step of wind.hpp; compiled once for each backend.
#include "kernels/wind/wind.hpp"

#include "kernels/backend/loops.hpp"
#include "kernels/wind/tuned/coarse_wind.hpp"
#include "kernels/wind/wind_laws.hpp"

namespace desert_sim::wind {

/// Speed-up, warped wind and projected flux from the row means of the terrain, with the FFT library.
template <class E>
void transform_by_library(E& exec, const CoarseLaws& laws, Workspace& work) {
  const Grid grid = work.coarse.transformed();
  for_each_cell(exec, grid, laws.columns);
  if (laws.response.fields() > 0) {
    work.fft_one_field->forward(work.spectrum.data());
    for_each_cell(exec, laws.response.grid(), laws.response);
    work.fft_all_responses->inverse(work.responses.data());
  }
  for_each_cell(exec, grid, laws.warp);
  if (!laws.projected) return;
  work.fft_one_field->forward(work.spectrum.data());
  for_each_cell(exec, grid, laws.project);
  work.fft_one_field->inverse(work.responses.data());
  if (!laws.mean.sums) return;
  work.mean_sums.set_zero();
  for_each_cell(exec, laws.mean.grid(), laws.mean);
}

template <class E>
void coarsen_rows(E& exec, const CoarsenRows& law) {
  for_each_cell(exec, law.grid(), law);
}

template <class E>
void coarse_wind(E& exec, const CoarseLaws& laws, const surface::Heights& heights, float reference,
                 Workspace& work) {
  const CoarsenRows rows{work.coarse, heights.cell_heights.data(), reference, work.row_means.data()};
  coarsen_rows(exec, rows);
  bool done = false;
  if constexpr (!vectorises_rows<E>) {
    if (work.by_lines) transform_by_lines(exec, laws, work);
    done = work.by_lines;
  }
  if (!done) transform_by_library(exec, laws, work);
  if (laws.mean.sums)
    for_each_cell(exec, work.coarse.transformed(),
                  RestoreMean{work.coarse, laws.mean.sums, work.responses.data()});
}

template <class E>
void step(E& exec, const TerrainView& t, const WindParameters& p, Vector above,
          const surface::Heights& heights, Quanta reference, const float* perturbation_x,
          const float* perturbation_y, Workspace& work) {
  const float speed_above = hypotenuse(above.x, above.y), ground = static_cast<float>(reference);
  if (has_coarse_fields(p))
    coarse_wind(exec, coarse_laws(t, p, above, speed_above, work), heights, ground, work);
  const auto run = [&](auto strip, auto is_perturbed) {
    SurfaceWind<strip, is_perturbed> law{};
    law.coarse = work.coarse;
    law.heights = heights.cell_heights.data();
    law.reference = ground;
    law.quantum = t.quantum;
    law.above = above;
    law.per_speed_squared = speed_above > 0.0f ? 1.0f / (speed_above * speed_above) : 0.0f;
    law.speed_up = speed_up(p);
    if (p.projection) law.speed_up.per_metre = 0;  // the projected wind includes the speed-up by height
    law.deviation = p.projection ? work.responses.data() : p.warping ? work.warped.data() : nullptr;
    law.keeps_speed = !p.projection;
    law.factors = has_response(p) ? work.rise.data() : nullptr;
    law.perturbation_x = perturbation_x;
    law.perturbation_y = perturbation_y;
    law.wind_x = t.real(Layer::wind_x);
    law.wind_y = t.real(Layer::wind_y);
    for_each_cell(exec, law.strips(), law);
  };
  const auto run_strips = [&](auto strip) {
    perturbation_x ? run(strip, std::true_type()) : run(strip, std::false_type());
  };
  constexpr int many_cells = 1 << 22;  // these fill a GPU even in long strips
  if constexpr (vectorises_rows<E>)
    run_strips(std::integral_constant<int, 1>());
  else if (t.grid.cells() >= many_cells)
    run_strips(std::integral_constant<int, 8>());
  else
    run_strips(std::integral_constant<int, 4>());
}

template void step(Backend&, const TerrainView&, const WindParameters&, Vector, const surface::Heights&,
                   Quanta, const float*, const float*, Workspace&);

}  // namespace desert_sim::wind
