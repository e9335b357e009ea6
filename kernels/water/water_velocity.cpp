/// The law of water_velocity.hpp; compiled once for each backend.
#include "kernels/water/water_velocity.hpp"

#include "kernels/backend/loops.hpp"
#include "kernels/water/face_flow.hpp"

namespace desert_sim::water_velocity {

using face_flow::Flow;
using face_flow::FlowFields;

template <bool inside>
struct FindVelocity {
  Flow<inside> flow;
  float *velocity_x, *velocity_y;

  /// `flux`: through the east or north faces; `before`, `after`: neighbours on this axis, −1: an open edge.
  DESERT_HD static float mean_flux(const float* flux, int i, int before, int after) {
    const float in = flux[inside || before >= 0 ? before : i];
    const float out = inside || after >= 0 ? flux[i] : in;
    return 0.5f * (in + out);
  }
  DESERT_HD void operator()(int x, int y) const {
    const int i = flow.grid.index(x, y);
    const float depth = flow.water[i] * flow.quantum;
    const float per = depth > face_flow::film ? 1.0f / (flow.grid.cell_size * depth) : 0.0f;
    velocity_x[i] = mean_flux(flow.flux_x, i, flow.west(x, y), flow.east(x, y)) * per;
    velocity_y[i] = mean_flux(flow.flux_y, i, flow.south(x, y), flow.north(x, y)) * per;
  }
};

template <class E>
void step(E& exec, const TerrainView& t) {
  FlowFields flow{};
  flow.grid = t.grid;
  flow.quantum = t.quantum;
  flow.water = t.quanta(Layer::water);
  flow.flux_x = t.real(Layer::water_flux_x);
  flow.flux_y = t.real(Layer::water_flux_y);
  face_flow::for_each_flow<FindVelocity>(exec, flow, t.real(Layer::water_velocity_x),
                                         t.real(Layer::water_velocity_y));
}

template void step(Backend&, const TerrainView&);

}  // namespace desert_sim::water_velocity
