#include "src/tools/outputs.hpp"

#include <sys/resource.h>

#include <cstdio>
#include <filesystem>
#include <iterator>
#include <sstream>

#include "kernels/field/statistics.hpp"
#include "kernels/slabs/slab_parameters.hpp"
#include "src/core/error.hpp"
#include "src/core/files.hpp"
#include "src/core/hash_text.hpp"
#include "src/simulation/processes/sand_slopes.hpp"
#include "src/simulation/session.hpp"
#include "src/tools/json_text.hpp"
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

/// Goes on after an open object, and leaves one open.
void write_cross_sections(std::ostream& out, const std::vector<CrossSection>& sections) {
  out << "},\n  \"cross_sections\": {";
  for (std::size_t n = 0; n < sections.size(); ++n) {
    const CrossSection& c = sections[n];
    out << (n ? ",\n    " : "\n    ") << json_string(c.name()) << ": {\"from\": [" << json_number(c.from().x)
        << ", " << json_number(c.from().y) << "], \"to\": [" << json_number(c.to().x) << ", "
        << json_number(c.to().y) << "], \"length_m\": " << json_number(c.length())
        << ", \"time_s\": " << json_number(c.duration())
        << ", \"volume_to_the_left_m3\": " << json_number(c.volume())
        << ", \"m2_per_year\": " << json_number(c.per_metre_and_year()) << "}";
  }
  out << "\n  ";
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
  std::ostringstream out;
  const GridParameters& g = s.scenario().grid;
  out << "{\n  \"scenario\": " << json_string(s.scenario().name) << ",\n  \"steps\": " << s.steps()
      << ",\n  \"sim_time_s\": " << json_number(s.time()) << ",\n  \"width\": " << g.width
      << ",\n  \"height\": " << g.height << ",\n  \"cell_size_m\": " << json_number(g.cell_size)
      << ",\n  \"boundary\": " << json_string(boundary_names[static_cast<int>(g.boundary)])
      << ",\n  \"backend\": " << json_string(report.backend)
      << ",\n  \"device\": " << json_string(report.device) << ",\n  \"threads\": " << report.threads
      << ",\n  \"seed\": " << s.scenario().seed;
  if (is_slab_model(s.scenario().get<SandParameters>().model))
    out << ",\n  \"slab_height_m\": "
        << json_number(static_cast<double>(s.scenario().get<SlabModelParameters>().slab_height));
  out << ",\n  \"ms_per_step\": {\"total\": "
      << json_number(report.steps_run ? report.milliseconds / static_cast<double>(report.steps_run) : 0.0);
  for (const ProcessTime& t : s.pipeline().times())
    out << ", " << json_string(t.process) << ": "
        << json_number(report.timed_steps ? t.milliseconds / static_cast<double>(report.timed_steps) : 0.0);
  out << "},\n  \"volume_m3\": {";
  const auto balance = s.state().balance();
  for (std::size_t m = 0; m < balance.size(); ++m) {
    const MaterialBalance& b = balance[m];
    out << (m ? ",\n    " : "\n    ") << json_string(material_names[m])
        << ": {\"initial\": " << json_number(b.initial_m3()) << ", \"final\": " << json_number(b.final_m3())
        << ", \"in\": " << json_number(b.cubic_metres(b.in))
        << ", \"out\": " << json_number(b.cubic_metres(b.out)) << "}";
  }
  out << "\n  },\n  \"mass_residual\": {";
  for (std::size_t m = 0; m < balance.size(); ++m)
    out << (m ? ", " : "") << json_string(material_names[m]) << ": "
        << json_number(balance[m].relative_residual());
  const Areas areas = ground_areas(s);
  out << "},\n  \"area_m2\": {";
  for (std::size_t n = 0; n < std::size(Areas::names); ++n)
    out << (n ? ", " : "") << json_string(Areas::names[n]) << ": " << json_number(areas.square_metres[n]);
  out << "},\n  \"plants\": {";
  const std::vector<PlantCount> plants = s.state().plant_counts();
  for (std::size_t n = 0; n < plants.size(); ++n)
    out << (n ? ", " : "") << json_string(plants[n].species) << ": {\"plants\": " << plants[n].plants
        << ", \"mature\": " << plants[n].mature << "}";
  if (report.measurements && !report.measurements->cross_sections().empty())
    write_cross_sections(out, report.measurements->cross_sections());
  const Residual r = sand_residual(s.state(), s.pipeline());
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  out << "},\n  \"max_sand_slope_deg\": " << json_number(max_sand_slope_deg(s.state()))
      << ",\n  \"avalanche_iterations_mean\": " << json_number(s.pipeline().mean_count(avalanche_iterations))
      << ",\n  \"avalanche_residual\": {\"share_over_1e-3\": " << json_number(r.share_over_1e3)
      << ", \"share_over_1e-2\": " << json_number(r.share_over_1e2)
      << ", \"mean_excess\": " << json_number(r.mean_excess)
      << ", \"largest_excess\": " << json_number(r.largest_excess) << "},\n  \"state_hash\": \""
      << hash_text(s.state().hash()) << "\",\n  \"scenario_hash\": \"" << scenario_hash(s.state().start)
      << "\",\n  \"peak_memory_bytes\": " << usage.ru_maxrss * 1024LL
      << ",\n  \"rasters\": " << (DESERT_WITH_IO ? "true" : "false") << "\n}\n";
  return out.str();
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
