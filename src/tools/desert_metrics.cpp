/// desert_metrics: measures the dunes of a run at each of its snapshots, and prints JSON.
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <filesystem>
#include <iostream>
#include <limits>
#include <sstream>

#include "src/core/did_you_mean.hpp"
#include "src/core/error.hpp"
#include "src/core/files.hpp"
#include "src/metrics/dune_metrics.hpp"
#include "src/tools/json_text.hpp"
#include "src/tools/options.hpp"
#include "src/tools/program.hpp"
#include "src/tools/run_history.hpp"

using namespace desert_sim;

namespace {

const char usage[] =
    "usage: desert_metrics RUN [options]\n"
    "  RUN                   the --out folder of desert_run --every N, or its terrain.nc\n"
    "  --out FILE            the metrics (JSON; default: the standard output)\n"
    "  --layer NAME          dunes are measured on the depth of sand (default), or on elevation\n"
    "  --sigma M             smoothing before crests are looked for [m] (default: two cells)\n"
    "  --slip-face DEG       slip faces are steeper than this [deg] (default 30)\n"
    "  --bare-depth M        ground with less sand is bare [m] (default 0.02)\n"
    "  --slab-height M       also give the highest stack in slabs of this height [m] (default: that of "
    "RUN's\n"
    "                        summary.json, if a slab model made it)\n"
    "doc/comparing.md defines each metric; null says that there is none.\n"
    "Exit status: 0; 2 for invalid input; 3 for a failure at run time.\n";

/// Of the slab model of the run [m]; 0: none, or the run has no summary.
double slab_height_of(const std::string& run) {
  const std::string path = run + "/summary.json";
  std::error_code none;
  if (!std::filesystem::is_regular_file(path, none)) return 0;
  try {
    return YAML::Load(read_file(path))["slab_height_m"].as<double>(0);  // JSON is YAML
  } catch (const YAML::Exception& e) {
    throw ConfigError(path + ": is not the summary of a run: " + e.msg);
  }
}

Field field_of(LayerField layer) {
  return {layer.width, layer.height, layer.cell_size, layer.periodic, std::move(layer.values)};
}

DuneSurface surface_at(const RunHistory& history, std::size_t n, const std::string& layer) {
  const auto read = [&](const char* name) { return field_of(history.read(name, n)); };
  DuneSurface s;
  s.time = history.times()[n];
  s.elevation = read("elevation");
  if (history.has("sand", n)) {
    s.sand = read("sand");
  } else {  // a layer that is not in use counts as 0 everywhere
    s.sand = s.elevation;
    s.sand.values.assign(s.elevation.values.size(), 0.0f);
  }
  s.relief = layer == "sand" ? s.sand : s.elevation;
  s.wind_x = read("wind_x");
  s.wind_y = read("wind_y");
  // Before the first step nothing has been counted.
  if (history.has("flux_x", n) && history.has("flux_y", n)) {
    const Field x = read("flux_x"), y = read("flux_y");
    if (std::isfinite(x.values.at(0)) && n > 0) s.flux_x = x, s.flux_y = y;
  }
  return s;
}

std::string number_or_null(const std::optional<double>& value) {
  return value ? json_number(*value) : "null";
}

/// Crests that are less parallel than this have no direction worth telling.
constexpr double least_coherence = 0.1;

std::string json_of(const DuneMetrics& m, const std::optional<Migration>& moved) {
  std::optional<double> none;
  const SlipFaces& slip = m.slip_faces;
  const auto of = [&none](bool known, double value) { return number_or_null(known ? value : none); };
  const std::vector<std::pair<const char*, std::string>> members{
      {"time_s", json_number(m.time)},
      {"crest_orientation_deg",
       m.crests && m.crests->coherence >= least_coherence ? json_number(m.crests->crest_deg) : "null"},
      {"crest_coherence", m.crests ? json_number(m.crests->coherence) : "null"},
      {"wavelength_m", number_or_null(m.wavelength)},
      {"dunes_on_profiles", std::to_string(m.lines.dunes)},
      {"mean_height_m", of(m.lines.dunes > 0, m.lines.mean_height)},
      {"highest_m", of(m.lines.dunes > 0, m.lines.highest)},
      {"rms_relief_m", json_number(m.rms_relief)},
      {"deepest_sand_m", json_number(m.deepest_sand)},
      {"highest_stack_slabs", number_or_null(m.highest_stack)},
      {"slip_face_share", json_number(slip.share)},
      {"slip_face_lee_share", number_or_null(slip.lee_share)},
      {"slip_face_direction_deg", of(slip.share > 0, slip.direction_deg)},
      {"slip_face_coherence", of(slip.share > 0, slip.direction_coherence)},
      {"slip_face_directions", std::to_string(slip.directions_deg.size())},
      {"crest_length_m", json_number(m.lines.length)},
      {"crest_terminations", std::to_string(m.lines.terminations)},
      {"terminations_per_m", number_or_null(m.terminations_per_metre)},
      {"migration_speed_m_s", moved ? json_number(moved->velocity.amount) : "null"},
      {"migration_direction_deg", moved ? json_number(moved->velocity.direction_deg) : "null"},
      {"migration_correlation", moved ? json_number(moved->correlation) : "null"},
      {"flux_m2_s", m.flux ? json_number(m.flux->amount) : "null"},
      {"flux_direction_deg", m.flux ? json_number(m.flux->direction_deg) : "null"},
      {"bare_share", json_number(m.bare_share)},
  };
  std::string text;
  for (const auto& [name, value] : members)
    text += (text.empty() ? "" : ", ") + json_string(name) + ": " + value;
  return "{" + text + "}";
}

int run_program(int argc, char** argv) {
  const Options o(argc, argv, {"out", "layer", "sigma", "slip-face", "bare-depth", "slab-height"}, {"help"});
  if (o.has("help")) return std::fputs(usage, stdout), 0;
  if (o.positional().size() != 1) throw ConfigError("one run must be given (--help shows the usage)");
  const std::string run = o.positional()[0], out = o.text("out", ""), layer = o.text("layer", "sand");
  if (layer != "sand" && layer != "elevation")
    throw ConfigError("--layer: " + not_one_of(layer, "sand, elevation"));
  MetricSettings settings;
  settings.sigma = o.real("sigma", 0, 1e-3, 1e6);
  settings.steeper_than_deg = o.real("slip-face", 30, 1, 89);
  settings.bare_depth = o.real("bare-depth", 0.02, 1e-6, 1e6);
  settings.slab_height = o.real("slab-height", slab_height_of(run), 1e-6, 1e6);
  const auto history = open_history(run);
  if (!out.empty()) require_writable_file(out);
  std::string text = "{\"layer\": " + json_string(layer) + ", \"snapshots\": [";
  std::optional<DuneSurface> before;
  for (std::size_t n = 0; n < history->times().size(); ++n) {
    DuneSurface now = surface_at(*history, n, layer);
    const DuneMetrics metrics = measure_dunes(now, settings);
    text += (n ? ",\n  " : "\n  ") + json_of(metrics, before ? migration(*before, now) : std::nullopt);
    before = std::move(now);
  }
  text += "\n]}\n";
  if (out.empty()) return std::cout << text, 0;
  write_file(out, text);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return run_main("desert_metrics", argv, [&] { return run_program(argc, argv); });
}
