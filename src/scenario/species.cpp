#include "src/scenario/species.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "src/core/did_you_mean.hpp"
#include "src/core/joined.hpp"
#include "src/scenario/presets.hpp"
#include "src/scenario/scenario.hpp"
#include "src/scenario/yaml_lists.hpp"

namespace desert_sim {

namespace {

constexpr Presets::Row species_preset_rows[] = {
#include "desert_sim/species_presets.inc"
};
constexpr Presets species_preset_table(species_preset_rows);

void read_species_entry(const YAML::Node& node, const std::string& key, ValidationErrors& errors,
                        Species& species) {
  std::set<std::string> known;
  SpeciesName name;
  yaml::read_parameters(node, key + ".", errors, name, known);
  if (!name.preset.empty()) {
    if (species_preset_table.text(name.preset))
      species = species_preset(name.preset);
    else
      errors.add(key + ".preset", not_one_of(name.preset, joined(species_preset_table.names())));
  }
  if (!name.name.empty()) species.name = name.name;
  yaml::read_parameters(node, key + ".", errors, species.traits, known);
  yaml::read_parameters(node, key + ".", errors, species.appearance, known);
  yaml::reject_unknown_keys(node, key + ".", known, errors);
  if (!node.IsMap())
    errors.add(key, yaml::node_text(node) + " is given where a species is expected, such as {preset: tree}");
  if (node.IsMap() && species.name.empty() && name.preset.empty())
    errors.add(key, "needs a name, or a preset that gives it one");
}

/// Whether a row or the whole matrix is a list with one entry per species; adds an error if not.
bool check_entry_count(const YAML::Node& list, const std::string& key, std::size_t count,
                       ValidationErrors& errors) {
  if (list.IsSequence() && list.size() == count) return true;
  errors.add(key,
             (list.IsSequence() ? "has " + std::to_string(list.size()) + " entries" : yaml::node_text(list)) +
                 " where a list of one entry per species (" + std::to_string(count) + ") is expected");
  return false;
}

void read_competition(const YAML::Node& rows, std::size_t count, ValidationErrors& errors,
                      CompetitionMatrix& matrix) {
  if (!rows.IsDefined() || rows.IsNull() || !check_entry_count(rows, "competition", count, errors)) return;
  constexpr ParameterRow range{"competition", 0, max_competition, "1", "", nullptr, 0};
  for (std::size_t k = 0; k < count; ++k) {
    const std::string key = "competition." + std::to_string(k);
    if (!check_entry_count(rows[k], key, count, errors)) continue;
    for (std::size_t j = 0; j < count; ++j) {
      yaml::read_float(rows[k][j], range, key + "." + std::to_string(j), errors, matrix[k * count + j]);
    }
  }
}

}  // namespace

std::vector<std::string> species_presets() { return species_preset_table.names(); }

Species species_preset(const std::string& name) {
  const char* text = species_preset_table.text(name);
  if (!text) throw ConfigError("species preset " + not_one_of(name, joined(species_preset_table.names())));
  ValidationErrors errors("species preset " + name);
  Species species{name, {}, {}};
  const YAML::Node node = YAML::Load(text);
  std::set<std::string> known;
  yaml::read_parameters(node, "", errors, species.traits, known);
  yaml::read_parameters(node, "", errors, species.appearance, known);
  yaml::reject_unknown_keys(node, "", known, errors);
  errors.throw_if_any();
  return species;
}

void read_species(const YAML::Node& root, ValidationErrors& errors, Scenario& s) {
  const YAML::Node list = root["species"];
  const bool given = list.IsDefined() && !list.IsNull();
  if (given && !yaml::is_list(list, "species", max_species, errors)) return;
  for (std::size_t n = 0; given && n < list.size(); ++n) {
    s.species.emplace_back();
    read_species_entry(list[n], "species." + std::to_string(n), errors, s.species.back());
  }
  s.competition.assign(s.species.size() * s.species.size(), 1.0f);
  read_competition(root["competition"], s.species.size(), errors, s.competition);
}

void emit_species(YAML::Emitter& out, const Scenario& s) {
  out << YAML::Key << "species" << YAML::Value << YAML::BeginSeq;
  for (const Species& species : s.species) {
    out << YAML::Flow << YAML::BeginMap << YAML::Key << "name" << YAML::Value << YAML::DoubleQuoted
        << species.name;
    yaml::emit_parameters(out, species.traits);
    yaml::emit_parameters(out, species.appearance);
    out << YAML::EndMap;
  }
  out << YAML::EndSeq << YAML::Key << "competition" << YAML::Value << YAML::BeginSeq;
  for (std::size_t k = 0; k < s.species.size(); ++k) {
    out << YAML::Flow << YAML::BeginSeq;
    for (std::size_t j = 0; j < s.species.size(); ++j) out << s.competition[k * s.species.size() + j];
    out << YAML::EndSeq;
  }
  out << YAML::EndSeq;
}

bool same_species(const Scenario& a, const Scenario& b) {
  YAML::Emitter texts[2];
  for (int n = 0; n < 2; ++n) {
    yaml::set_full_precision(texts[n]);
    texts[n] << YAML::BeginMap;
    emit_species(texts[n], n == 0 ? a : b);
    texts[n] << YAML::EndMap;
  }
  return texts[0].size() == texts[1].size() && std::string(texts[0].c_str()) == texts[1].c_str();
}

void check_species(const Scenario& s, ValidationErrors& errors) {
  std::set<std::string> names;
  for (std::size_t n = 0; n < s.species.size(); ++n) {
    const Species& species = s.species[n];
    const std::string key = "species." + std::to_string(n);
    if (!species.name.empty() && !names.insert(species.name).second)
      errors.add(key + ".name", "'" + species.name + "' is already the name of another species");
    if (species.traits.moisture_highest < species.traits.moisture_lowest)
      errors.add(key + ".moisture_highest", "must not be below moisture_lowest");
    if (species.traits.light_highest <= species.traits.light_lowest)
      errors.add(key + ".light_highest", "must be above light_lowest");
  }
}

}  // namespace desert_sim
