#pragma once
/// What a brush paints, and the requests that paint one capsule of it.

#include <desert_sim/EditPlants.h>
#include <desert_sim/EditTerrain.h>

#include <optional>
#include <string>
#include <vector>

#include "src/render/stroke_path.hpp"

namespace desert_sim {

struct Brush {
  enum class Material {
    sand,
    bedrock,
    soil,
    water,
    moisture,
    plants,
    airborne_sand,
    vegetation,
    erosion_resistance,
    humus,
    grass,
    mesquite,
    shrub,
    snow_density,
    looseness,
    obstacle
  };
  enum class Operation { add, remove, flatten, smooth };

  Material material = Material::sand;
  Operation operation = Operation::add;
  double radius = 5;      ///< [m]
  double strength = 0.5;  ///< what a pass of the brush adds or removes on its axis [unit of the layer]
  double inner = 0.5;     ///< fraction of the radius with full weight, 0 … 1
  std::string species;    ///< plants: what is planted; what is removed, empty for all
  double density = 0.1;   ///< plants that a pass puts on each square metre [1/m²]
  std::string
      mask;  ///< a raster below ~data_dir, whose values weigh the brush in its square; empty: a round brush
  double size = 0.5;  ///< plants: their radius relative to the largest for which there is room, 0.001 … 1

  /// When it paints, if not at once: what a stroke paints becomes entries of run.timeline.
  struct Later {
    double time = 0;  ///< simulated [s]
    bool from_now = true;
    double every = 0, until = 0;  ///< as of an entry [s]; 0: not given
  };
  std::optional<Later> later = std::nullopt;
};

/// The materials in order, as the tool's property shows them.
std::vector<const char*> brush_materials();
/// The name of a material in ~edit_terrain; "plants" for plants.
const char* layer_of(Brush::Material material);
/// Whether it is a depth or elevation, and no number of another unit.
bool is_material(Brush::Material material);
/// Why there is no such brush, such as one that smooths plants; empty if there is.
std::string problem_of(const Brush& brush);

/// For all materials but plants. With a mask a capsule is to be a circle, whose square is stamped. `level` is
/// what `flatten` makes of the layer: the value where the stroke began [m].
EditTerrain::Request terrain_request(const Brush& brush, const render::Capsule& capsule,
                                     const std::string& stroke, double level, bool alone = false);
EditPlants::Request plants_request(const Brush& brush, const render::Capsule& capsule,
                                   const std::string& stroke, std::uint64_t seed, bool alone = false);

}  // namespace desert_sim
