#pragma once
/// The species of a scenario: the list `species`, whose entries may start from a preset, and the matrix
/// `competition`.

#include <array>
#include <string>
#include <vector>

#include "kernels/plants/species.hpp"
#include "src/core/parameters.hpp"

namespace YAML {
class Node;
class Emitter;
}  // namespace YAML

namespace desert_sim {

class Faults;
struct Scenario;

struct SpeciesName {
  std::string preset;
  std::string name;
};
constexpr auto parameter_table(const SpeciesName*) {
  using P = SpeciesName;
  return std::make_tuple(
      parameter("preset", &P::preset, "Of config/species; what else stands here overrides it."),
      parameter("name", &P::name, "Unlike the others'; the preset's if not given."));
}
static_assert(table_is_complete<SpeciesName>());

/// How it is drawn; nothing that lives depends on it.
struct SpeciesLook {
  float hue = 120;
};
constexpr auto parameter_table(const SpeciesLook*) {
  using P = SpeciesLook;
  return std::make_tuple(
      parameter("hue", &P::hue, 0, 360, "deg",
                "Colour in pictures and rviz: 0 red, 60 yellow, 120 green, 240 blue, 300 violet."));
}
static_assert(table_is_complete<SpeciesLook>());

struct Species {
  std::string name;
  SpeciesTraits traits;
  SpeciesLook look;
};

/// Of a species' crowns: red, green, blue, each 0 … 1.
std::array<float, 3> crown_colour(const SpeciesLook& look);

/// How much each species (column) hinders the growth of each (row), row by row: 1 where nothing is said.
using CompetitionMatrix = std::vector<float>;
constexpr float strongest_competition = 1000;

/// Names of the presets, in alphabetical order, and one of them. Throws ConfigError for an unknown name.
std::vector<std::string> species_presets();
Species species_preset(const std::string& name);

/// Reads both keys of a scenario.
void read_species(const YAML::Node& root, Faults& faults, Scenario& scenario);
/// Writes them as map entries, every parameter spelled out.
void emit_species(YAML::Emitter& out, const Scenario& scenario);
/// What no single key can say about plants.
void check_plants(const Scenario& scenario, Faults& faults);

}  // namespace desert_sim
