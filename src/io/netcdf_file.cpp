#include "src/io/netcdf_file.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>

#include "src/core/descriptor.hpp"
#include "src/core/error.hpp"
#include "src/core/files.hpp"
#include "src/core/input_file.hpp"
#include "src/scenario/wind_series.hpp"

#if DESERT_WITH_NETCDF
#include <fcntl.h>
#include <netcdf.h>

#include <cstdio>
#include <cstdlib>
#endif

namespace desert_sim {

#if DESERT_WITH_NETCDF

namespace {

constexpr int compression_level = 4;
constexpr std::size_t longest_chunk = 512;  // [cells]

/// Names of the CF table, for the layers that it has.
const char* standard_name(Layer layer) {
  switch (layer) {
    case Layer::elevation:
      return "surface_altitude";
    case Layer::bedrock:
      return "bedrock_altitude";
    case Layer::wind_x:
      return "eastward_wind";
    case Layer::wind_y:
      return "northward_wind";
    default:
      return nullptr;
  }
}

/// An open file, which is closed in any case.
struct Handle {
  std::string path;
  int id = -1;

  explicit Handle(std::string where) : path(std::move(where)) {}
  ~Handle() {
    if (id >= 0) nc_close(id);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;

  void check(int status, const std::string& what) const {
    if (status != NC_NOERR) throw WriteError(path + ": " + what + ": " + nc_strerror(status));
  }
  void text(int variable, const char* name, const std::string& value) const {
    check(nc_put_att_text(id, variable, name, value.size(), value.c_str()), name);
  }
};

}  // namespace

namespace {

/// The path of an open folder without characters that the library takes for something else, such as
/// backslashes.
std::string plain_path(const Descriptor& folder) {
  return "/proc/self/fd/" + std::to_string(folder.number());
}

}  // namespace

struct NetcdfWriter::File : Handle {
  using Handle::Handle;
  int width = 0, height = 0;
  int time_dimension = -1, y_dimension = -1, x_dimension = -1, time = -1, step = -1, crs = -1;
  std::size_t count = 0;  ///< of times
  std::map<Layer, int> layers;

  int coordinate(const char* name, int dimension, nc_type type, const char* axis, const char* long_name) {
    int variable = -1;
    check(nc_def_var(id, name, type, 1, &dimension, &variable), name);
    if (axis) text(variable, "axis", axis);
    text(variable, "long_name", long_name);
    return variable;
  }

  /// Cell centres along an axis.
  void define_axis(const char* name, const char* axis, int cells, double origin, double cell,
                   int& dimension) {
    check(nc_def_dim(id, name, static_cast<std::size_t>(cells), &dimension), name);
    const bool east = axis[0] == 'X';
    const int variable =
        coordinate(name, dimension, NC_DOUBLE, axis, east ? "eastward coordinate" : "northward coordinate");
    text(variable, "standard_name", east ? "projection_x_coordinate" : "projection_y_coordinate");
    text(variable, "units", "m");
    std::vector<double> centres(static_cast<std::size_t>(cells));
    for (std::size_t n = 0; n < centres.size(); ++n)
      centres[n] = origin + (static_cast<double>(n) + 0.5) * cell;
    check(nc_put_var_double(id, variable, centres.data()), name);
  }

  void define_time(const std::optional<double>& date) {
    check(nc_def_dim(id, "time", NC_UNLIMITED, &time_dimension), "time");
    time = coordinate("time", time_dimension, NC_DOUBLE, "T", "simulated time");
    if (date) {
      text(time, "standard_name", "time");
      text(time, "units", "seconds since " + date_text(*date));
      text(time, "calendar", "standard");
    } else {
      text(time, "units", "s");
    }
    step = coordinate("step", time_dimension, NC_INT64, nullptr, "number of steps");
  }

  void define_projection(const std::string& projection, const Snapshot& s) {
    if (projection.empty()) return;
    check(nc_def_var(id, "crs", NC_INT, 0, nullptr, &crs), "crs");
    text(crs, "crs_wkt", projection);
    text(crs, "spatial_ref", projection);  // GDAL's name for it
    char transform[200];
    std::snprintf(transform, sizeof transform, "%.17g %.17g 0 %.17g 0 %.17g", s.origin_x, s.cell_size,
                  s.origin_y + s.height * s.cell_size, -s.cell_size);
    text(crs, "GeoTransform", transform);
  }

  int layer_variable(Layer layer) {
    const auto found = layers.find(layer);
    if (found != layers.end()) return found->second;
    const LayerInfo& about = info(layer);
    const int dimensions[] = {time_dimension, y_dimension, x_dimension};
    int variable = -1;
    check(nc_def_var(id, about.name, NC_FLOAT, 3, dimensions, &variable), about.name);
    const std::size_t chunk[] = {1, std::min(static_cast<std::size_t>(height), longest_chunk),
                                 std::min(static_cast<std::size_t>(width), longest_chunk)};
    check(nc_def_var_chunking(id, variable, NC_CHUNKED, chunk), about.name);
    check(nc_def_var_deflate(id, variable, 1, 1, compression_level), about.name);
    const float none = std::numeric_limits<float>::quiet_NaN();
    check(nc_def_var_fill(id, variable, NC_FILL, &none), about.name);
    text(variable, "units", about.unit);
    text(variable, "long_name", about.doc);
    if (const char* name = standard_name(layer)) text(variable, "standard_name", name);
    if (crs >= 0) text(variable, "grid_mapping", "crs");
    layers[layer] = variable;
    return variable;
  }
};

NetcdfWriter::NetcdfWriter(const std::string& path, const NetcdfHead& head, const Snapshot& first)
    : file_(std::make_unique<File>(path)) {
  require_writable_file(path);
  std::remove(path.c_str());  // what would be a link by now is not followed
  // HDF5 would lock out who looks at the snapshots that are there already.
  setenv("HDF5_USE_FILE_LOCKING", "FALSE", 0);
  const std::filesystem::path where(path);
  const std::string folder = where.has_parent_path() ? where.parent_path().string() : ".";
  const Descriptor opened(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  File& f = *file_;
  const int status = nc_create((plain_path(opened) + "/" + where.filename().string()).c_str(),
                               NC_NETCDF4 | NC_NOCLOBBER, &f.id);
  if (status != NC_NOERR) throw ConfigError(path + ": cannot be created: " + nc_strerror(status));
  f.width = first.width;
  f.height = first.height;
  f.text(NC_GLOBAL, "Conventions", "CF-1.8");
  f.text(NC_GLOBAL, "title", head.title);
  f.text(NC_GLOBAL, "source", "desert_sim");
  f.text(NC_GLOBAL, "boundary", first.periodic_x ? "periodic" : "open");
  f.define_time(head.date);
  f.define_axis("y", "Y", first.height, first.origin_y, first.cell_size, f.y_dimension);
  f.define_axis("x", "X", first.width, first.origin_x, first.cell_size, f.x_dimension);
  f.define_projection(head.projection, first);
}

NetcdfWriter::~NetcdfWriter() = default;

void NetcdfWriter::add(const Snapshot& s) {
  File& f = *file_;
  if (s.width != f.width || s.height != f.height)
    throw ConfigError(f.path + ": a terrain of " + std::to_string(s.width) + " x " +
                      std::to_string(s.height) + " cells does not belong to one of " +
                      std::to_string(f.width) + " x " + std::to_string(f.height));
  const std::size_t start[] = {f.count, 0, 0},
                    count[] = {1, static_cast<std::size_t>(s.height), static_cast<std::size_t>(s.width)};
  const auto step = static_cast<long long>(s.step);
  f.check(nc_put_vara_double(f.id, f.time, start, count, &s.time), "time");
  f.check(nc_put_vara_longlong(f.id, f.step, start, count, &step), "step");
  for (const auto& [layer, values] : s.layers)
    f.check(nc_put_vara_float(f.id, f.layer_variable(layer), start, count, values.data()), info(layer).name);
  f.check(nc_sync(f.id), "the disk");
  ++f.count;
}

struct NetcdfReader::File : Handle {
  using Handle::Handle;
  std::vector<double> x, y, times;
  bool periodic = false;

  [[noreturn]] void refuse(const std::string& what) const { throw ConfigError(path + ": " + what); }

  std::vector<double> coordinate(const char* name) const {
    int dimension = -1, variable = -1;
    std::size_t length = 0;
    if (nc_inq_dimid(id, name, &dimension) != NC_NOERR || nc_inq_varid(id, name, &variable) != NC_NOERR ||
        nc_inq_dimlen(id, dimension, &length) != NC_NOERR)
      refuse(std::string("has no dimension and variable '") + name + "'");
    if (length > (std::size_t{1} << 24))
      refuse(std::string("'") + name + "' has " + std::to_string(length) + " values");
    std::vector<double> values(length);
    if (nc_get_var_double(id, variable, values.data()) != NC_NOERR)
      refuse(std::string("the variable '") + name + "' cannot be read");
    return values;
  }

  void require_even(const std::vector<double>& values, const char* name) const {
    if (values.size() < 2) refuse(std::string("'") + name + "' has fewer than two values");
    const double cell = x[1] - x[0];
    for (std::size_t n = 1; n < values.size(); ++n)
      if (!(cell > 0) || std::abs(values[n] - values[n - 1] - cell) > 1e-6 * cell)
        refuse(std::string("'") + name + "' does not rise evenly by the width of a cell, " +
               std::to_string(cell) + " m");
  }

  void require_finite_times() const {
    for (std::size_t n = 0; n < times.size(); ++n)
      if (!std::isfinite(times[n]))
        refuse("the time " + std::to_string(times[n]) + ", number " + std::to_string(n + 1) + " of " +
               std::to_string(times.size()) + ", is not finite");
  }

  /// A few changed bytes can declare billions of cells. Deflate packs at most some 1000 bytes into one.
  void require_cells_that_fit() const {
    constexpr double packed = 1032, bytes_of_a_time = 8;
    std::error_code error;
    const auto bytes = static_cast<double>(std::filesystem::file_size(path, error));
    const double cells = static_cast<double>(x.size()) * static_cast<double>(y.size());
    if (error || cells > packed * bytes || cells > 2147483648.0)
      refuse(std::to_string(x.size()) + " x " + std::to_string(y.size()) +
             " cells are more than the file can have, or than 2^31");
    if (static_cast<double>(times.size()) * bytes_of_a_time > bytes)
      refuse(std::to_string(times.size()) + " times are more than the file can have");
  }
};

NetcdfReader::NetcdfReader(const std::string& path) : file_(std::make_unique<File>(path)) {
  File& f = *file_;
  const InputFile opened(path);
  const int status = nc_open(opened.descriptor_path().c_str(), NC_NOWRITE, &f.id);
  if (status != NC_NOERR) f.refuse(std::string("cannot be opened: ") + nc_strerror(status));
  f.x = f.coordinate("x");
  f.y = f.coordinate("y");
  f.times = f.coordinate("time");
  f.require_even(f.x, "x");
  f.require_even(f.y, "y");
  f.require_finite_times();
  f.require_cells_that_fit();
  char boundary[16] = "";
  std::size_t length = 0;
  if (nc_inq_attlen(f.id, NC_GLOBAL, "boundary", &length) == NC_NOERR && length < sizeof boundary &&
      nc_get_att_text(f.id, NC_GLOBAL, "boundary", boundary) == NC_NOERR)
    f.periodic = std::string(boundary) == "periodic";
}

NetcdfReader::~NetcdfReader() = default;

int NetcdfReader::width() const { return static_cast<int>(file_->x.size()); }
int NetcdfReader::height() const { return static_cast<int>(file_->y.size()); }
double NetcdfReader::cell_size() const { return file_->x[1] - file_->x[0]; }
double NetcdfReader::origin_x() const { return file_->x[0] - 0.5 * cell_size(); }
double NetcdfReader::origin_y() const { return file_->y[0] - 0.5 * cell_size(); }
const std::vector<double>& NetcdfReader::times() const { return file_->times; }
bool NetcdfReader::periodic() const { return file_->periodic; }

bool NetcdfReader::has(const std::string& variable) const {
  int id = -1;
  return nc_inq_varid(file_->id, variable.c_str(), &id) == NC_NOERR;
}

std::vector<float> NetcdfReader::read(const std::string& variable, std::size_t time) const {
  int id = -1, dimensions = 0;
  if (nc_inq_varid(file_->id, variable.c_str(), &id) != NC_NOERR ||
      nc_inq_varndims(file_->id, id, &dimensions) != NC_NOERR || dimensions != 3)
    file_->refuse("has no variable '" + variable + "' over time, y and x");
  std::vector<float> values(file_->x.size() * file_->y.size());
  const std::size_t start[] = {time, 0, 0}, count[] = {1, file_->y.size(), file_->x.size()};
  if (const int status = nc_get_vara_float(file_->id, id, start, count, values.data()); status != NC_NOERR)
    file_->refuse(variable + ": cannot be read: " + nc_strerror(status));
  return values;
}

#else

namespace {
[[noreturn]] void refuse(const std::string& path) {
  throw ConfigError(path + ": this build knows no NetCDF (it was built without libnetcdf-dev)");
}
}  // namespace

struct NetcdfWriter::File {};
NetcdfWriter::NetcdfWriter(const std::string& path, const NetcdfHead&, const Snapshot&) { refuse(path); }
NetcdfWriter::~NetcdfWriter() = default;
void NetcdfWriter::add(const Snapshot&) {}

struct NetcdfReader::File {
  std::vector<double> times;
};
NetcdfReader::NetcdfReader(const std::string& path) { refuse(path); }
NetcdfReader::~NetcdfReader() = default;
int NetcdfReader::width() const { return 0; }
int NetcdfReader::height() const { return 0; }
double NetcdfReader::cell_size() const { return 0; }
double NetcdfReader::origin_x() const { return 0; }
double NetcdfReader::origin_y() const { return 0; }
const std::vector<double>& NetcdfReader::times() const { return file_->times; }
bool NetcdfReader::periodic() const { return false; }
bool NetcdfReader::has(const std::string&) const { return false; }
std::vector<float> NetcdfReader::read(const std::string&, std::size_t) const { return {}; }

#endif

}  // namespace desert_sim
