#pragma once
/// The species of a scenario: the list `species`, whose entries may start from a preset, and the matrix
/// `competition`.

#include <string>
#include <vector>

#include "kernels/plants/species.hpp"
#include "src/core/parameter_table.hpp"

namespace YAML {
class Node;
class Emitter;
}  // namespace YAML

namespace desert_sim {

class ValidationErrors;
struct Scenario;

struct SpeciesName {
  std::string preset;
  std::string name;
};
constexpr auto parameter_table(const SpeciesName*) {
  using P = SpeciesName;
  return std::make_tuple(
      parameter("preset", &P::preset,
                "Name of a preset in config/species; other keys of the entry override its values."),
      parameter("name", &P::name, "Unique name; if not given, the preset's."));
}
static_assert(table_is_complete<SpeciesName>());

/// How a species is drawn. The simulation does not depend on it.
struct SpeciesAppearance {
  float hue = 120;
};
constexpr auto parameter_table(const SpeciesAppearance*) {
  using P = SpeciesAppearance;
  return std::make_tuple(
      parameter("hue", &P::hue, 0, 360, "deg",
                "Colour in pictures and rviz: 0 red, 60 yellow, 120 green, 240 blue, 300 violet."));
}
static_assert(table_is_complete<SpeciesAppearance>());

struct Species {
  std::string name;
  SpeciesTraits traits;
  SpeciesAppearance appearance;
};

/// How much each species (column) hinders the growth of each species (row), row-major; 1 where the scenario
/// gives no value.
using CompetitionMatrix = std::vector<float>;
constexpr float max_competition = 1000;

/// Names of the presets, in alphabetical order.
std::vector<std::string> species_presets();
/// The preset with this name. Throws ConfigError for an unknown name.
Species species_preset(const std::string& name);

/// Reads the keys `species` and `competition` of a scenario.
void read_species(const YAML::Node& root, ValidationErrors& errors, Scenario& scenario);
/// Writes both keys as entries of an open map, with all parameters.
void emit_species(YAML::Emitter& out, const Scenario& scenario);
/// Whether both keys say the same in both.
bool same_species(const Scenario& a, const Scenario& b);
/// Checks conditions on species that involve more than one key.
void check_species(const Scenario& scenario, ValidationErrors& errors);

}  // namespace desert_sim
