#include "src/tools/outputs.hpp"

#include <sys/resource.h>

#include <cstdio>
#include <filesystem>
#include <iterator>

#include "kernels/field/statistics.hpp"
#include "kernels/slabs/slab_parameters.hpp"
#include "src/core/error.hpp"
#include "src/core/files.hpp"
#include "src/core/hash_text.hpp"
#include "src/simulation/processes/sand_slopes.hpp"
#include "src/simulation/session.hpp"
#include "src/tools/json.hpp"
#if DESERT_WITH_IO
#include "src/io/snapshots.hpp"
#endif

namespace desert_sim {

namespace {

#if DESERT_WITH_IO
void write_rasters(const std::string& folder, const Snapshot& s, const std::string& projection) {
  for (const auto& [layer, values] : s.layers)
    write_geotiff(folder + "/" + info(layer).name + ".tif", to_raster(s, values, projection));
}

void write_pictures(const std::string& folder, const Snapshot& s) {
  PictureInput picture = to_picture_input(s);
  picture.wind_shadow = nullptr;
  const auto values = [&s](Layer layer) { return s.layers.at(layer).data(); };
  write_png(folder + "/elevation.png", hillshade_picture(picture));
  write_png(folder + "/wind.png", wind_picture(s.width, s.height, s.cell_size, values(Layer::wind_x),
                                               values(Layer::wind_y), picture.elevation));
  if (s.find(Layer::flux_x))
    write_png(folder + "/flux.png",
              wind_picture(s.width, s.height, s.cell_size, values(Layer::flux_x), values(Layer::flux_y),
                           picture.elevation, {"flux", "m^2/s"}));
}
#endif

/// Area of each kind of ground as seen from above [m²].
struct Areas {
  static constexpr const char* names[] = {"rock", "soil", "sand", "plants", "water"};
  double square_metres[5] = {};
};
Areas ground_areas(Simulation& simulation) {
  constexpr float min_water_depth = 0.02f, min_cover_depth = 0.02f,
                  min_plant_density = 0.3f;  // [m], [m], density
  const auto s = simulation.views().snapshot({Layer::soil, Layer::sand, Layer::vegetation, Layer::water});
  const auto values = [&](Layer layer) -> const std::vector<float>& { return s->layers.at(layer); };
  const auto ground_kind = [&](std::size_t i) {
    if (values(Layer::water)[i] > min_water_depth) return 4;
    if (values(Layer::vegetation)[i] > min_plant_density) return 3;
    if (values(Layer::sand)[i] > min_cover_depth) return 2;
    return values(Layer::soil)[i] > min_cover_depth ? 1 : 0;
  };
  Areas areas;
  for (std::size_t i = 0; i < values(Layer::sand).size(); ++i)
    areas.square_metres[ground_kind(i)] += s->cell_size * s->cell_size;
  return areas;
}

Json json_of(const std::vector<CrossSection>& sections) {
  Json all = Json::object();
  for (const CrossSection& c : sections)
    all[c.name()] = {{"from", {c.from().x, c.from().y}},
                     {"to", {c.to().x, c.to().y}},
                     {"length_m", c.length()},
                     {"time_s", c.duration()},
                     {"volume_to_the_left_m3", c.volume()},
                     {"m2_per_year", c.per_metre_and_year()}};
  return all;
}

/// Wall time of a step: in all, and of each process where some were timed [ms].
Json step_times(const Simulation& s, const RunReport& report) {
  const auto share = [](double sum, std::uint64_t steps) {
    return steps ? sum / static_cast<double>(steps) : 0.0;
  };
  Json times = {{"total", share(report.milliseconds, report.steps_run)}};
  for (const ProcessTime& t : s.pipeline().times())
    times[t.process] = share(t.milliseconds, report.timed_steps);
  return times;
}

}  // namespace

std::string create_output_folder(const std::string& folder, const std::string& option,
                                 const std::string& file) {
  namespace fs = std::filesystem;
  std::error_code error;
  std::string created;
  for (fs::path p = fs::path(folder).lexically_normal(); !p.empty() && !fs::exists(p, error);
       p = p.parent_path())
    created = p.string();
  fs::create_directories(folder, error);
  if (error) {
    const std::string reason = error.message();
    if (!created.empty()) remove_empty_folders(created, folder);
    throw ConfigError(option + " " + folder + ": cannot be created: " + reason);
  }
  if (!fs::is_directory(folder, error)) throw ConfigError(option + " " + folder + ": is not a folder");
  try {
    require_writable_file(folder + "/" + file);
  } catch (const Error& e) {
    if (!created.empty()) remove_empty_folders(created, folder);
    throw ConfigError(option + " " + e.what());
  }
  return created;
}

void remove_empty_folders(const std::string& topmost, const std::string& folder) {
  namespace fs = std::filesystem;
  const fs::path last(topmost);
  std::error_code not_empty;
  for (fs::path p = fs::path(folder).lexically_normal(); !p.empty(); p = p.parent_path()) {
    if (p.filename().empty()) continue;  // "a/b/"
    fs::remove(p, not_empty);
    if (p == last) return;
  }
}

std::string conservation_error(const std::array<MaterialBalance, material_count>& balance) {
  std::string missing;
  for (std::size_t m = 0; m < balance.size(); ++m)
    if (const long long quanta = balance[m].residual(); quanta != 0)
      missing += (missing.empty() ? "" : ", ") + std::to_string(quanta) + " quanta of " + material_names[m];
  return missing;
}

std::string summary(Simulation& s, const RunReport& report) {
  const Scenario& scenario = s.scenario();
  const GridParameters& g = scenario.grid;
  Json all = {{"scenario", scenario.name},
              {"steps", s.steps()},
              {"sim_time_s", s.time()},
              {"width", g.width},
              {"height", g.height},
              {"cell_size_m", g.cell_size},
              {"boundary", boundary_names[static_cast<int>(g.boundary)]},
              {"backend", report.backend},
              {"device", report.device},
              {"threads", report.threads},
              {"seed", scenario.seed}};
  if (is_slab_model(scenario.get<SandParameters>().model))
    all["slab_height_m"] = scenario.get<SlabModelParameters>().slab_height;
  all["ms_per_step"] = step_times(s, report);
  const auto balance = s.state().balance();
  for (std::size_t m = 0; m < balance.size(); ++m) {
    const MaterialBalance& b = balance[m];
    all["volume_m3"][material_names[m]] = {{"initial", b.initial_m3()},
                                           {"final", b.final_m3()},
                                           {"in", b.cubic_metres(b.in)},
                                           {"out", b.cubic_metres(b.out)}};
  }
  for (std::size_t m = 0; m < balance.size(); ++m)
    all["mass_residual"][material_names[m]] = balance[m].relative_residual();
  const Areas areas = ground_areas(s);
  for (std::size_t n = 0; n < std::size(Areas::names); ++n)
    all["area_m2"][Areas::names[n]] = areas.square_metres[n];
  all["plants"] = Json::object();
  for (const PlantCount& count : s.state().plant_counts())
    all["plants"][count.species] = {{"plants", count.plants}, {"mature", count.mature}};
  if (report.measurements && !report.measurements->cross_sections().empty())
    all["cross_sections"] = json_of(report.measurements->cross_sections());
  all["max_sand_slope_deg"] = max_sand_slope_deg(s.state());
  all["avalanche_iterations_mean"] = s.pipeline().mean_count(avalanche_iterations);
  all["avalanche_residual"] = json_of(sand_residual(s.state(), s.pipeline()));
  all["state_hash"] = hash_text(s.state().hash());
  all["scenario_hash"] = scenario_hash(s.state().start);
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  all["peak_memory_bytes"] = usage.ru_maxrss * 1024LL;
  all["rasters"] = DESERT_WITH_IO != 0;
  return json_text(all);
}

void write_outputs(const std::string& folder, Simulation& simulation, const RunReport& report,
                   [[maybe_unused]] bool rasters) {
#if DESERT_WITH_IO
  std::vector<Layer> layers = simulation.state().layers_in_use();
  if (simulation.views().shows(Layer::plants)) layers.push_back(Layer::plants);
  const auto snapshot = simulation.views().snapshot(layers);
  if (rasters) write_rasters(folder, *snapshot, simulation.scenario().projection);
  write_pictures(folder, *snapshot);
#endif
  write_file(folder + "/summary.json", summary(simulation, report));
}

}  // namespace desert_sim
