/// The laws and the step of marking.hpp; compiled once for each backend.
#include "kernels/plants/marking.hpp"

#include "kernels/backend/for_each.hpp"
#include "kernels/backend/loops.hpp"
#include "kernels/field/surface_laws.hpp"
#include "kernels/plants/density.hpp"
#include "kernels/plants/lookup.hpp"
#include "kernels/view/layer_values.hpp"

namespace desert_sim::plants {

struct DominantSpecies {
  Grid grid;
  Neighbourhood near;
  View plants;
  const SpeciesTraits* species;
  surface::SolidHeight height;
  float quantum;
  float* mark;

  DESERT_HD void operator()(int column, int row) const {
    const int i = grid.index(column, row);
    const float x = (static_cast<float>(column) + 0.5f) * grid.cell_size,
                y = (static_cast<float>(row) + 0.5f) * grid.cell_size;
    const Quanta z = height(i);
    float densest = bare_density;
    int found = 0;
    near.visit_near(x, y, 0.0f, [&](int n, const Neighbour& plant) {
      const float dx = near.lookup.difference_x(x, plant.x), dy = near.lookup.difference_y(y, plant.y);
      const SpeciesTraits& s = species[plants.species[n]];
      const float above = static_cast<float>(z - plant.z) * quantum;
      const float d = density_at(dx * dx + dy * dy, above, plant.radius, s.stem, s.root);
      if (!(d > densest)) return;
      densest = d;
      found = 1 + plants.species[n];
    });
    mark[i] = static_cast<float>(found);
  }
};

template <class E>
void find_dominant_species(E& exec, const TerrainView& t, int first, int rows, const Neighbourhood& near,
                           const View& plants, const SpeciesTraits* species) {
  for_each_cell_of_rows(exec, t.grid, first, rows,
                        DominantSpecies{t.grid, near, plants, species, surface::SolidHeight(t), t.quantum,
                                        t.real(Layer::plants)});
}

struct ExportPlants {
  View plants;
  QuantaToMetres metres;
  PlantRecord* to;
  int first;
  DESERT_HD void operator()(int k) const {
    const int n = first + k;
    to[k] = {plants.x[n],
             plants.y[n],
             metres(plants.z[n]),
             plants.radius[n],
             static_cast<std::uint16_t>(plants.species[n]),
             static_cast<std::uint16_t>(255.0f * clamp(plants.health[n], 0.0f, 1.0f) + 0.5f)};
  }
};

template <class E>
void export_plants(E& exec, const View& plants, const QuantaToMetres& metres, int first, int count,
                   PlantRecord* to) {
  for_each_item(exec, count, ExportPlants{plants, metres, to, first});
}

template void find_dominant_species(Backend&, const TerrainView&, int, int, const Neighbourhood&, const View&,
                                    const SpeciesTraits*);
template void export_plants(Backend&, const View&, const QuantaToMetres&, int, int, PlantRecord*);

}  // namespace desert_sim::plants
