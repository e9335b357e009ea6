/// Law and step of layer_values.hpp; compiled once for each backend.
#include "kernels/view/layer_values.hpp"

#include <type_traits>

#include "kernels/backend/loops.hpp"
#include "kernels/view/layer_values_laws.hpp"

namespace desert_sim::layer_values {

template <class Values>
struct Convert {
  Grid grid;
  Values values;
  int first;
  float* to;

  DESERT_HD void operator()(int x, int y) const {
    to[grid.index(x, y)] = values(grid.index(x, wrap(first + y, grid.height)));
  }
};

template <class E>
void step(E& exec, const TerrainView& t, Layer layer, const QuantaToMetres& metres, int first, int rows,
          float* to) {
  Grid band = t.grid;
  band.height = rows;
  with_values(t, layer, metres, [&](const auto& values) {
    using Values = std::decay_t<decltype(values)>;
    for_each_cell(exec, band, Convert<Values>{t.grid, values, first, to});
  });
}

template void step(Backend&, const TerrainView&, Layer, const QuantaToMetres&, int, int, float*);

}  // namespace desert_sim::layer_values
