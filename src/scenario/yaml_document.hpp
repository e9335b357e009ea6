#pragma once
/// The one YAML document of a text that a user wrote.

#include <yaml-cpp/yaml.h>

#include <string>

namespace desert_sim::yaml {

/// As YAML::Load(), which reads what stands before anything that belongs to no document, `,` say, and is
/// silent about the rest; YAML::LoadAll() then never ends. Null for an empty text. Throws
/// YAML::ParserException, with the place, for what is no YAML and where a second document begins.
YAML::Node load_document(const std::string& text);

}  // namespace desert_sim::yaml
