/// desert_metrics: measures the dunes of a run at each of its snapshots, and prints JSON.
#include <cmath>
#include <filesystem>
#include <iostream>
#include <limits>

#include "src/command_line/program.hpp"
#include "src/core/did_you_mean.hpp"
#include "src/core/error.hpp"
#include "src/core/files.hpp"
#include "src/metrics/dune_metrics.hpp"
#include "src/tools/json.hpp"
#include "src/tools/run_history.hpp"

using namespace desert_sim;

namespace {

Options options() {
  Options o("desert_metrics", "Measures the dunes of a run at each of its snapshots, and prints JSON.");
  o.positional("RUN", "the --out folder of desert_run --every N, or its terrain.nc")
      .option("out", "FILE", "the metrics (JSON; default: the standard output)")
      .option("layer", "NAME", "dunes are measured on the depth of sand (default), or on elevation")
      .option("sigma", "M", "smoothing before crests are looked for [m] (default: two cells)")
      .option("slip-face", "DEG", "slip faces are steeper than this [deg] (default 30)")
      .option("bare-depth", "M", "ground with less sand is bare [m] (default 0.02)")
      .option("slab-height", "M",
              "also give the highest stack in slabs of this height [m] (default: that of RUN's summary.json, "
              "if a "
              "slab model made it)")
      .footer(
          "doc/science/comparing.md defines each metric; null says that there is none.\n"
          "Exit status: 0; 2 for invalid input; 3 for a failure at run time.");
  return o;
}

/// Of the slab model of the run [m]; 0: none, or the run has no summary.
double slab_height_of(const std::string& run) {
  const std::string path = run + "/summary.json";
  std::error_code none;
  if (!std::filesystem::is_regular_file(path, none)) return 0;
  try {
    return read_json(path).value("slab_height_m", 0.0);
  } catch (const Json::exception& e) {
    throw ConfigError(path + ": is not the summary of a run: " + e.what());
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

template <class Number>
Json or_null(const std::optional<Number>& value) {
  return value ? Json(*value) : Json();
}

/// Crests that are less parallel than this have no direction worth telling.
constexpr double least_coherence = 0.1;

Json json_of(const DuneMetrics& m, const std::optional<Migration>& moved) {
  const SlipFaces& slip = m.slip_faces;
  const auto of = [](bool known, double value) { return known ? Json(value) : Json(); };
  const bool dunes = m.lines.dunes > 0, slipping = slip.share > 0;
  const bool parallel = m.crests && m.crests->coherence >= least_coherence;
  return {{"time_s", m.time},
          {"crest_orientation_deg", parallel ? Json(m.crests->crest_deg) : Json()},
          {"crest_coherence", m.crests ? Json(m.crests->coherence) : Json()},
          {"wavelength_m", or_null(m.wavelength)},
          {"dunes_on_profiles", m.lines.dunes},
          {"mean_height_m", of(dunes, m.lines.mean_height)},
          {"highest_m", of(dunes, m.lines.highest)},
          {"rms_relief_m", m.rms_relief},
          {"deepest_sand_m", m.deepest_sand},
          {"highest_stack_slabs", or_null(m.highest_stack)},
          {"slip_face_share", slip.share},
          {"slip_face_lee_share", or_null(slip.lee_share)},
          {"slip_face_direction_deg", of(slipping, slip.direction_deg)},
          {"slip_face_coherence", of(slipping, slip.direction_coherence)},
          {"slip_face_directions", slip.directions_deg.size()},
          {"crest_length_m", m.lines.length},
          {"crest_terminations", m.lines.terminations},
          {"terminations_per_m", or_null(m.terminations_per_metre)},
          {"migration_speed_m_s", moved ? Json(moved->velocity.amount) : Json()},
          {"migration_direction_deg", moved ? Json(moved->velocity.direction_deg) : Json()},
          {"migration_correlation", moved ? Json(moved->correlation) : Json()},
          {"flux_m2_s", m.flux ? Json(m.flux->amount) : Json()},
          {"flux_direction_deg", m.flux ? Json(m.flux->direction_deg) : Json()},
          {"bare_share", m.bare_share}};
}

int run_program(const Options& o) {
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
  Json all = {{"layer", layer}, {"snapshots", Json::array()}};
  std::optional<DuneSurface> before;
  for (std::size_t n = 0; n < history->times().size(); ++n) {
    DuneSurface now = surface_at(*history, n, layer);
    const DuneMetrics metrics = measure_dunes(now, settings);
    all["snapshots"].push_back(json_of(metrics, before ? migration(*before, now) : std::nullopt));
    before = std::move(now);
  }
  if (out.empty())
    std::cout << json_text(all);
  else
    write_file(out, json_text(all));
  return 0;
}

}  // namespace

int main(int argc, char** argv) { return run_main(options(), argc, argv, run_program); }
