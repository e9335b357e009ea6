/// The step of wind.hpp; compiled once for each backend.
#include "kernels/wind/wind.hpp"

#include "kernels/backend/loops.hpp"
#include "kernels/wind/tuned/coarse_wind.hpp"
#include "kernels/wind/wind_laws.hpp"

namespace desert_sim::wind {

/// Speed-up, warped wind and projected flux from the row means of the terrain, one pass after the other.
template <class E>
void transform_pass_by_pass(E& exec, const CoarseLaws& laws, Workspace& work) {
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
    if (work.in_one_kernel) transform_in_one_kernel(exec, laws, work);
    done = work.in_one_kernel;
  }
  if (!done) transform_pass_by_pass(exec, laws, work);
}

inline SurfaceWindInputs surface_wind_inputs(const TerrainView& t, const WindParameters& p, Vector above,
                                             const surface::Heights& heights, float reference,
                                             const Workspace& work) {
  const float speed_above = hypotenuse(above.x, above.y);
  SurfaceWindInputs in{};
  in.coarse = work.coarse;
  in.heights = heights.cell_heights.data();
  in.reference = reference;
  in.quantum = t.quantum;
  in.above = above;
  in.per_speed_squared = speed_above > 0.0f ? 1.0f / (speed_above * speed_above) : 0.0f;
  in.speed_up = speed_up(p);
  if (p.projection) in.speed_up.per_metre = 0;  // the projected wind includes the speed-up by height
  in.deviation = p.projection ? work.responses.data() : p.warping ? work.warped.data() : nullptr;
  in.mean = {p.projection && has_response(p) ? work.mean_sums.data() : nullptr, {}};
  in.keeps_speed = !p.projection;
  in.factors = has_response(p) ? work.rise.data() : nullptr;
  in.wind_x = t.real(Layer::wind_x);
  in.wind_y = t.real(Layer::wind_y);
  return in;
}

template <int strip, bool interpolated, class E>
void blow(E& exec, const SurfaceWindInputs& in) {
  const auto run = [&](const auto& law) { for_each_cell(exec, law.strips(), law); };
  if (in.perturbation_x)
    run(SurfaceWind<strip, true, interpolated>{in});
  else
    run(SurfaceWind<strip, false, interpolated>{in});
}

/// On a CPU: interpolates along x first, if the rows fit into `scratch`.
template <class E>
void blow_by_rows(E& exec, SurfaceWindInputs in, const RowScratch& scratch) {
  const bool fit = 2 * InterpolateRows::values(in.coarse) <= in.coarse.fine.cells();
  if ((!in.deviation && !in.factors) || !fit) return blow<1, false>(exec, in);
  const InterpolateRows rows{in.coarse, in.deviation, in.factors,
                             reinterpret_cast<Complex*>(scratch.deviation), scratch.factors};
  for_each_cell(exec, rows.grid(), rows);
  if (in.deviation) in.deviation = rows.deviation_rows;
  if (in.factors) in.factors = rows.factor_rows;
  blow<1, true>(exec, in);
}

template <class E>
void step(E& exec, const TerrainView& t, const WindParameters& p, const FlowInputs& flow,
          const RowScratch& scratch, Workspace& work) {
  const Vector above = flow.above;
  const float speed_above = hypotenuse(above.x, above.y), ground = static_cast<float>(flow.reference);
  if (has_coarse_fields(p))
    coarse_wind(exec, coarse_laws(t, p, above, speed_above, work), flow.heights, ground, work);
  SurfaceWindInputs in = surface_wind_inputs(t, p, above, flow.heights, ground, work);
  in.perturbation_x = flow.perturbation_x;
  in.perturbation_y = flow.perturbation_y;
  constexpr int many_cells = 1 << 22;  // these fill a GPU even in long strips
  if constexpr (vectorises_rows<E>) {
    in.mean = {nullptr, in.mean()};
    blow_by_rows(exec, in, scratch);
  } else if (t.grid.cells() >= many_cells) {
    blow<8, false>(exec, in);
  } else {
    blow<4, false>(exec, in);
  }
}

template void step(Backend&, const TerrainView&, const WindParameters&, const FlowInputs&, const RowScratch&,
                   Workspace&);

}  // namespace desert_sim::wind
