#include "src/tools/json.hpp"

#include "kernels/avalanching/residual.hpp"
#include "src/core/error.hpp"
#include "src/core/files.hpp"

namespace desert_sim {

std::string json_text(const Json& value) {
  return value.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json read_json(const std::string& path) {
  try {
    return Json::parse(read_file(path));
  } catch (const Json::parse_error& e) {
    throw ConfigError(path + ": is not JSON: " + e.what());
  }
}

Json json_of(const Residual& r) {
  return {{"share_over_1e-3", r.share_over_1e3},
          {"share_over_1e-2", r.share_over_1e2},
          {"mean_excess", r.mean_excess},
          {"largest_excess", r.largest_excess}};
}

}  // namespace desert_sim
