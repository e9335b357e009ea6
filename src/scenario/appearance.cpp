#include "src/scenario/appearance.hpp"

#include <string>

#include "src/core/validation_errors.hpp"
#include "src/scenario/scenario.hpp"

namespace desert_sim {

namespace {

const std::string appearance_section = register_section<AppearanceParameters>("appearance", check_appearance);

}  // namespace

void check_appearance(const Scenario& scenario, ValidationErrors& errors) {
  for_each_parameter(scenario.get<AppearanceParameters>(), [&](const auto& row, const auto& value) {
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, ShortList>)
      if (value.count != 3)
        errors.add(appearance_section + "." + row.name,
                   "has " + std::to_string(value.count) + " numbers (allowed: three, red, green and blue)");
  });
}

render::Palette palette_of(const AppearanceParameters& a) {
  const auto colour = [](const ShortList& list) {
    return render::Colour{list.values[0], list.values[1], list.values[2]};
  };
  render::Palette p;
  p.sand = colour(a.sand);
  p.soil = colour(a.soil);
  p.weak_rock = colour(a.weak_rock);
  p.hard_rock = colour(a.hard_rock);
  p.obstacle = colour(a.obstacle);
  p.vegetation = colour(a.vegetation);
  p.shallow_water = colour(a.shallow_water);
  p.deep_water = colour(a.deep_water);
  return p;
}

}  // namespace desert_sim
