/// Times of a lidar's scans by the number of its beams and the size of the terrain's grid:
/// doc/contributing/performance.md has results.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <sstream>
#include <string>
#include <vector>

#include "src/command_line/program.hpp"
#include "src/core/error.hpp"
#include "src/core/files.hpp"
#include "src/rover/sensors/lidar.hpp"
#include "src/simulation/views/snapshot_source.hpp"
#include "src/tools/json.hpp"

using namespace desert_sim;

namespace {

Options options() {
  Options o("range_sensor_bench",
            "Times a lidar's scans by the number of its beams and the size of the grid.");
  o.option("beams", "RxC", "rings and columns; may be repeated (default 16x512, 32x1024, 64x1024, 128x2048)")
      .option("size", "N",
              "cells along each side of the grid; may be repeated (default 256, 512, 1024, 2048)")
      .option("cell-size", "MM", "size of a cell [mm] (default 500)")
      .option("backend", "B", "cpu (default) or cuda")
      .option("threads", "N", "threads of the CPU backend (default 1)")
      .option("scans", "N", "scans of which the median counts (default 15)")
      .flag("media", "with plants on a quarter of the ground and sand in the air")
      .flag("micro-relief", "with ripples and heaps on the ground, and a new state of it before each scan")
      .option("json", "FILE", "write the results to FILE (-: print them instead of the table)")
      .footer(
          "A lidar stands 1.5 m above dunes up to 12 m high, looks 100 m far, 22.5 deg\n"
          "down to 22.5 deg up, each time from another place. A row has the median time of\n"
          "a scan with its copy to the host, on the wall and of all threads on processors,\n"
          "that of an update of 64 x 64 cells, and the share of the beams that return.\n"
          "With --micro-relief that of a scan includes what follows from the new state.\n"
          "Exit status: 0; 2 for invalid input; 3 for a failure at run time.");
  return o;
}

using Clock = std::chrono::steady_clock;

/// Time that all threads of this process have had a processor [ms]: unlike that on the wall, it does not
/// count what other programs take.
double processor_time() { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct Row {
  int rings, columns, size;
  double scan_ms, cpu_ms, update_ms, share;
};

float dune_height(double x, double y) {
  const double crest = x + 12 * std::sin(y / 31), phase = crest / 45 - std::floor(crest / 45);
  const double shape = phase < 0.75 ? phase / 0.75 : (1 - phase) / 0.25;
  return static_cast<float>((9 + 3 * std::sin(y / 53 + x / 71)) * shape * shape * (3 - 2 * shape));
}

class Bench {
 public:
  explicit Bench(const Options& o)
      : exec_(make_exec(o.text("backend", "cpu"), static_cast<int>(o.number("threads", 1, 1, 4096)))),
        cell_size_(1e-3 * static_cast<double>(o.number("cell-size", 500, 1, 100000))),
        scans_(static_cast<int>(o.number("scans", 15, 1, 100000))),
        media_(o.has("media")),
        micro_relief_(o.has("micro-relief")) {}

  Exec& exec() { return *exec_; }

  Row row(int rings, int columns, int size) {
    HeightFieldScene scene(*exec_, {size, size, cell_size_, 0, 0});
    fill(scene, size);
    LidarParameters p;
    p.rings = rings;
    p.columns = columns;
    Lidar lidar(*exec_, p);
    const std::shared_ptr<const MicroReliefSource> source = micro_relief_ ? source_of(state(size)) : nullptr;
    std::vector<double> times, cpu_times;
    long long returns = 0;
    const double side = size * cell_size_;
    for (int n = -1; n < scans_; ++n) {  // the first scan is not timed
      const double x = side * (0.5 + 0.3 * std::sin(n * 2.4)), y = side * (0.5 + 0.3 * std::cos(n * 2.4));
      const SensorPose pose{{x, y, static_cast<double>(dune_height(x, y)) + 1.5}};
      const double cpu_begin = processor_time();
      const auto begin = Clock::now();
      if (source) scene.set_micro_relief(source);
      const RangeImage& image = lidar.scan(scene, pose, static_cast<std::uint64_t>(n + 1));
      if (n < 0) continue;
      times.push_back(std::chrono::duration<double, std::milli>(Clock::now() - begin).count());
      cpu_times.push_back(processor_time() - cpu_begin);
      returns += std::count_if(image.distances.begin(), image.distances.end(),
                               [](float d) { return !std::isnan(d); });
    }
    return {rings,
            columns,
            size,
            median(times),
            median(cpu_times),
            update_time(scene),
            static_cast<double>(returns) / scans_ / rings / columns};
  }

 private:
  /// Sand under a wind that varies, with stones here and there.
  Snapshot state(int size) const {
    Snapshot s;
    s.width = s.height = s.micro_relief.grid_height = size;
    s.cell_size = cell_size_;
    s.periodic_x = s.periodic_y = s.micro_relief.periodic_y = false;
    s.wind_above = {8, 3};
    s.micro_relief.wind = RippleWind::settled(s.wind_above);
    const auto fill = [&](Layer layer, const auto& value) {
      for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
          s.layers[layer].push_back(
              static_cast<float>(value((x + 0.5) * cell_size_, (y + 0.5) * cell_size_)));
    };
    fill(Layer::elevation, dune_height);
    fill(Layer::sand, [](double x, double y) { return 0.5 + 0.5 * std::sin(x / 9 + y / 7); });
    fill(Layer::wind_x, [](double x, double y) { return 7 + 2 * std::sin(x / 20 - y / 30); });
    fill(Layer::wind_y, [](double x, double y) { return 2 + std::cos(x / 30 + y / 25); });
    fill(Layer::wind_shadow, [](double x, double y) { return std::sin(x / 15 + y / 40) > 0.7 ? 1 : 0; });
    fill(Layer::obstacle,
         [](double x, double y) { return std::sin(x / 3) * std::sin(y / 3) > 0.98 ? 1 : 0; });
    for (Layer layer : {Layer::soil, Layer::water, Layer::moisture, Layer::vegetation})
      fill(layer, [](double, double) { return 0; });
    return s;
  }
  void fill(HeightFieldScene& scene, int size) const {
    std::vector<float> heights, canopy, density, air;
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        heights.push_back(dune_height((x + 0.5) * cell_size_, (y + 0.5) * cell_size_));
        const bool plants = (x / 8 + y / 8) % 4 == 0;
        canopy.push_back(plants ? 0.6f : 0.0f);
        density.push_back(plants ? 0.5f : 0.0f);
        air.push_back(0.1f);
      }
    scene.update(SceneLayer::elevation, heights);
    if (!media_) return;
    scene.update(SceneLayer::canopy_height, canopy);
    scene.update(SceneLayer::vegetation, density);
    scene.update(SceneLayer::airborne_sand, air);
  }
  double update_time(HeightFieldScene& scene) const {
    std::vector<double> times;
    const std::vector<float> values(64 * 64, 1.0f);
    for (int n = 0; n < 5; ++n) {
      exec_->synchronise();
      const auto begin = Clock::now();
      scene.update(SceneLayer::elevation, {17, 33, 64, 64}, values);
      exec_->synchronise();
      times.push_back(std::chrono::duration<double, std::milli>(Clock::now() - begin).count());
    }
    return median(times);
  }
  static double median(std::vector<double> times) {
    std::nth_element(times.begin(), times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2),
                     times.end());
    return times[times.size() / 2];
  }

  std::unique_ptr<Exec> exec_;
  double cell_size_;
  int scans_;
  bool media_, micro_relief_;
};

std::string json_of(const std::vector<Row>& rows, const Exec& exec) {
  Json all = {{"format", "range_sensor_bench 1"},
              {"backend", exec.backend()},
              {"device", exec.device_name()},
              {"rows", Json::array()}};
  for (const Row& r : rows)
    all["rows"].push_back({{"rings", r.rings},
                           {"columns", r.columns},
                           {"size", r.size},
                           {"scan_ms", r.scan_ms},
                           {"cpu_ms", r.cpu_ms},
                           {"update_ms", r.update_ms},
                           {"returns", r.share}});
  return json_text(all);
}

std::string table_of(const std::vector<Row>& rows, const Exec& exec) {
  std::ostringstream out;
  out << exec.backend() << ", " << exec.device_name()
      << "\nbeams       grid    scan ms     cpu ms  update ms  returns\n";
  char line[100];
  for (const Row& r : rows) {
    std::snprintf(line, sizeof line, "%3d x %-5d %5d %10.2f %10.2f %10.3f %7.1f %%\n", r.rings, r.columns,
                  r.size, r.scan_ms, r.cpu_ms, r.update_ms, 100 * r.share);
    out << line;
  }
  return out.str();
}

int run(const Options& o) {
  std::vector<std::string> beams = o.values("beams");
  if (beams.empty()) beams = {"16x512", "32x1024", "64x1024", "128x2048"};
  Bench bench(o);
  std::vector<Row> rows;
  for (const std::string& shape : beams)
    for (int side : o.numbers("size", {256, 512, 1024, 2048}, 128, 16384)) {
      int rings = 0, columns = 0, read = 0;
      if (std::sscanf(shape.c_str(), "%dx%d%n", &rings, &columns, &read) != 2 ||
          read != static_cast<int>(shape.size()))
        throw ConfigError("--beams " + shape + ": is not of the form 64x1024");
      rows.push_back(bench.row(rings, columns, side));
    }
  const std::string json = o.text("json", "");
  std::fputs((json == "-" ? json_of(rows, bench.exec()) : table_of(rows, bench.exec())).c_str(), stdout);
  if (!json.empty() && json != "-") write_file(json, json_of(rows, bench.exec()));
  return 0;
}

}  // namespace

int main(int argc, char** argv) { return run_main(options(), argc, argv, run); }
