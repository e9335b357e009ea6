#pragma once
/// The section `appearance`: how a scenario wants to be shown. The simulation does not depend on it.

#include "src/core/parameter_table.hpp"
#include "src/render/palette.hpp"

namespace desert_sim {

class ValidationErrors;
struct Scenario;

/// A colour as a parameter: red, green, blue.
constexpr ShortList colour_parameter(const render::Colour& c) { return {{c.r, c.g, c.b, 0}, 3}; }

struct AppearanceParameters {
  ShortList sand = colour_parameter(render::Palette().sand);
  ShortList soil = colour_parameter(render::Palette().soil);
  ShortList weak_rock = colour_parameter(render::Palette().weak_rock);
  ShortList hard_rock = colour_parameter(render::Palette().hard_rock);
  ShortList obstacle = colour_parameter(render::Palette().obstacle);
  ShortList vegetation = colour_parameter(render::Palette().vegetation);
  ShortList shallow_water = colour_parameter(render::Palette().shallow_water);
  ShortList deep_water = colour_parameter(render::Palette().deep_water);
  bool wind_arrows = false;
};

constexpr auto parameter_table(const AppearanceParameters*) {
  using P = AppearanceParameters;
  return std::make_tuple(
      parameter("sand", &P::sand, 0, 1, "1", "Colour: red, green, blue."),
      parameter("soil", &P::soil, 0, 1, "1", "Likewise."),
      parameter("weak_rock", &P::weak_rock, 0, 1, "1", "Likewise, of rock that resists erosion least."),
      parameter("hard_rock", &P::hard_rock, 0, 1, "1", "Likewise, of rock that resists it most."),
      parameter("obstacle", &P::obstacle, 0, 1, "1", "Likewise."),
      parameter("vegetation", &P::vegetation, 0, 1, "1", "Likewise, of plants that have no species."),
      parameter("shallow_water", &P::shallow_water, 0, 1, "1", "Likewise."),
      parameter("deep_water", &P::deep_water, 0, 1, "1", "Likewise, of water many metres deep."),
      parameter("wind_arrows", &P::wind_arrows,
                "Whether rviz shows the wind unless its user says otherwise."));
}
static_assert(table_is_complete<AppearanceParameters>());

/// Each colour has three numbers.
void check_appearance(const Scenario& scenario, ValidationErrors& errors);

render::Palette palette_of(const AppearanceParameters& appearance);

}  // namespace desert_sim
