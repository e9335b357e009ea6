#pragma once
/// JSON of the programs: what they measure, and what they read of earlier runs.

#include <nlohmann/json.hpp>
#include <string>

namespace desert_sim {

struct Residual;

/// Its members keep their order; those of nlohmann-json before 3.9 (Ubuntu 20.04) are sorted by name.
#if NLOHMANN_JSON_VERSION_MAJOR > 3 || NLOHMANN_JSON_VERSION_MINOR >= 9
using Json = nlohmann::ordered_json;
#else
using Json = nlohmann::json;
#endif

/// In lines, the last one ended. Numbers are read back exactly; those that JSON has none for are null. Bytes
/// that are no UTF-8, as names of files may have, become U+FFFD.
std::string json_text(const Json& value);

/// Throws ConfigError: `path` cannot be read, or is not JSON.
Json read_json(const std::string& path);

/// What avalanching has left too steep, as results of runs and of desert_bench have it.
Json json_of(const Residual& residual);

}  // namespace desert_sim
