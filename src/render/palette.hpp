#pragma once
/// The colours of what a terrain is made of, as a scenario (its section `appearance`) or a user chooses them.

#include "src/render/colour.hpp"

namespace desert_sim::render {

struct Palette {
  Colour sand{0.855f, 0.706f, 0.463f}, soil{0.424f, 0.322f, 0.227f};
  Colour weak_rock{0.565f, 0.510f, 0.447f};  ///< that resists erosion least
  Colour hard_rock{0.408f, 0.369f, 0.337f};  ///< that resists it most
  Colour obstacle{0.251f, 0.118f, 0.345f};
  Colour vegetation{0.27f, 0.48f, 0.20f};  ///< plants of no species
  Colour shallow_water{0.373f, 0.647f, 0.804f}, deep_water{0.078f, 0.216f, 0.471f};
};

constexpr bool operator==(const Colour& a, const Colour& b) { return a.r == b.r && a.g == b.g && a.b == b.b; }

/// The colours by the names that users know them by.
struct NamedColour {
  const char* name;
  Colour Palette::*colour;
};
constexpr NamedColour palette_colours[] = {{"sand", &Palette::sand},
                                           {"soil", &Palette::soil},
                                           {"weak_rock", &Palette::weak_rock},
                                           {"hard_rock", &Palette::hard_rock},
                                           {"obstacle", &Palette::obstacle},
                                           {"vegetation", &Palette::vegetation},
                                           {"shallow_water", &Palette::shallow_water},
                                           {"deep_water", &Palette::deep_water}};

}  // namespace desert_sim::render
