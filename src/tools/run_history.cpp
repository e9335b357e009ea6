#include "src/tools/run_history.hpp"

#include <algorithm>
#include <filesystem>

#include "src/core/error.hpp"
#if DESERT_WITH_IO
#include "src/io/netcdf_file.hpp"
#include "src/io/raster.hpp"
#include "src/tools/json.hpp"
#endif

namespace desert_sim {

#if DESERT_WITH_IO

namespace {

namespace fs = std::filesystem;

class NetcdfHistory final : public RunHistory {
 public:
  explicit NetcdfHistory(const std::string& path) : file_(path) {}
  const std::vector<double>& times() const override { return file_.times(); }
  bool has(const std::string& layer, std::size_t) const override { return file_.has(layer); }
  LayerField read(const std::string& layer, std::size_t time) const override {
    return {file_.width(),    file_.height(),   file_.cell_size(),      file_.origin_x(),
            file_.origin_y(), file_.periodic(), file_.read(layer, time)};
  }

 private:
  NetcdfReader file_;
};

/// Folders with summary.json and rasters.
class RasterHistory final : public RunHistory {
 public:
  explicit RasterHistory(const std::string& path) {
    std::vector<std::pair<double, std::string>> found;
    add(path, found);
    std::error_code none;
    for (fs::directory_iterator entry(path, none), end; !none && entry != end; entry.increment(none))
      if (entry->path().filename().string().compare(0, 5, "step_") == 0) add(entry->path().string(), found);
    std::sort(found.begin(), found.end());
    for (const auto& [time, folder] : found)
      if (times_.empty() || time > times_.back()) {
        times_.push_back(time);
        folders_.push_back(folder);
      }
    if (times_.empty())
      throw ConfigError(path + ": is no --out folder of desert_run: it has no summary.json, nor a step_*");
  }
  const std::vector<double>& times() const override { return times_; }
  bool has(const std::string& layer, std::size_t time) const override {
    std::error_code none;
    return fs::is_regular_file(folders_[time] + "/" + layer + ".tif", none);
  }
  LayerField read(const std::string& layer, std::size_t time) const override {
    const Raster r = read_raster(folders_[time] + "/" + layer + ".tif");
    return {r.width, r.height, r.cell_size, r.origin_x, r.origin_y, periodic_, r.values};
  }

 private:
  void add(const std::string& folder, std::vector<std::pair<double, std::string>>& found) {
    const std::string path = folder + "/summary.json";
    std::error_code none;
    if (!fs::is_regular_file(path, none)) return;
    try {
      const Json summary = read_json(path);
      found.emplace_back(summary.at("sim_time_s").get<double>(), folder);
      periodic_ = summary.value("boundary", "open") == "periodic";
    } catch (const Json::exception& e) {
      throw ConfigError(path + ": is not the summary of a run: " + e.what());
    }
  }

  std::vector<double> times_;
  std::vector<std::string> folders_;
  bool periodic_ = false;
};

}  // namespace

std::unique_ptr<RunHistory> open_history(const std::string& path) {
  std::error_code none;
  if (!fs::is_directory(path, none)) return std::make_unique<NetcdfHistory>(path);
  if (fs::is_regular_file(path + "/terrain.nc", none))
    return std::make_unique<NetcdfHistory>(path + "/terrain.nc");
  return std::make_unique<RasterHistory>(path);
}

#else

std::unique_ptr<RunHistory> open_history(const std::string& path) {
  throw ConfigError(path + ": this build reads no rasters (it was built without GDAL and OpenCV)");
}

#endif

}  // namespace desert_sim
