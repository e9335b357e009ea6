// Rasters of the formats that services read, with the options of a raster step, resampled to a small
// grid: raw bytes, or an ESRI ASCII grid, an ENVI file or a TIFF whose header is filled from the input.
#include <fuzzer/FuzzedDataProvider.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "src/core/log.hpp"
#include "src/io/raster_loader.hpp"
#include "src/scenario/raster_grid.hpp"
#include "test/fuzz/fuzz.hpp"

namespace desert_sim {
namespace {

std::string number(FuzzedDataProvider& data) {
  const char* const extremes[] = {"0",          "-1",         "nan",   "inf", "1e300", "1e-300",
                                  "2147483647", "4294967296", "-9999", "0.5", "",      "x"};
  switch (data.ConsumeIntegralInRange(0, 5)) {
    case 0:
      return data.PickValueInArray(extremes);
    case 1:
      return std::to_string(data.ConsumeIntegral<std::int32_t>());
    case 2:
      return std::to_string(data.ConsumeIntegralInRange(-20000, 20000) / 7.0);
    default:
      return std::to_string(data.ConsumeIntegralInRange(1, 12));
  }
}

std::string ascii_grid(FuzzedDataProvider& data) {
  std::string text;
  for (const char* key : {"ncols", "nrows", "xllcorner", "yllcorner", "cellsize"})
    if (data.ConsumeIntegralInRange(0, 30) != 30) text += std::string(key) + " " + number(data) + "\n";
  if (data.ConsumeBool()) text += "dx " + number(data) + "\ndy " + number(data) + "\n";
  if (data.ConsumeBool()) text += "NODATA_value " + number(data) + "\n";
  while (data.remaining_bytes() > 40) text += number(data) + (data.ConsumeBool() ? " " : "\n");
  return text;
}

std::string envi_header(FuzzedDataProvider& data) {
  std::string text = "ENVI\n";
  for (const char* key : {"samples", "lines", "bands", "header offset", "data type", "byte order"})
    if (data.ConsumeIntegralInRange(0, 30) != 30) text += std::string(key) + " = " + number(data) + "\n";
  text += std::string("interleave = ") + data.PickValueInArray({"bsq", "bil", "bip", "?"}) + "\n";
  if (data.ConsumeBool()) text += "data ignore value = " + number(data) + "\n";
  if (data.ConsumeBool()) {
    text += "map info = {UTM";
    for (int n = 0; n < 7; ++n) text += ", " + number(data);
    text += ", North, WGS-84, units=Meters}\n";
  }
  return text;
}

/// Little-endian, with one directory whose entries are filled from the input.
std::string tiff(FuzzedDataProvider& data) {
  std::string file("II*\0\x08\0\0\0", 8);
  const auto add = [&file](auto value) { file.append(reinterpret_cast<const char*>(&value), sizeof value); };
  // Size, bits, compression, photometric interpretation, strips, samples, planes, predictor, tiles,
  // sample format, pixel scale, tie points, transformation, keys, nodata.
  const std::uint16_t tags[] = {256, 257, 258, 259, 262, 273,   277,   278,   279,   284,  317,
                                322, 323, 324, 325, 339, 33550, 33922, 34264, 34735, 42113};
  const std::uint32_t usual[] = {4,  3,  32,  1,    1, 300, 1,   3,   48,  1,  1,
                                 16, 16, 300, 1024, 3, 300, 300, 300, 300, 300};
  add(static_cast<std::uint16_t>(std::size(tags)));
  for (std::size_t n = 0; n < std::size(tags); ++n) {
    const bool placed = n > 15;  // a list, which lies elsewhere
    const bool odd = data.ConsumeIntegralInRange(0, 7) == 7;
    const bool absent = (n >= 10 && n <= 14) || n == 18 || n == 19;
    add(static_cast<std::uint16_t>(absent && !odd ? tags[n] + 20000 : tags[n]));
    add(static_cast<std::uint16_t>(odd ? data.ConsumeIntegralInRange(0, 14)
                                       : (n == 20 ? 2 : (placed ? 12 : 4))));
    add(odd ? data.ConsumeIntegral<std::uint32_t>() : (n == 17 ? 6u : (placed ? 3u : 1u)));
    add(data.ConsumeIntegralInRange(0, 7) == 7 ? data.ConsumeIntegral<std::uint32_t>() : usual[n]);
  }
  add(std::uint32_t{0});  // no other directory
  file.resize(300);
  while (data.remaining_bytes() > 60) add(data.ConsumeBool() ? data.ConsumeFloatingPoint<double>() : 2.0);
  return file;
}

RasterRequest request_of(FuzzedDataProvider& data) {
  const double extremes[] = {1, 0, -1, 1e-3, 1e6, 1e300, -1e-300, -9999};
  const auto value = [&] {
    return data.ConsumeBool() ? data.PickValueInArray(extremes)
                              : data.ConsumeIntegralInRange(-500, 500) / 8.0;
  };
  RasterRequest request;
  request.band = data.ConsumeIntegralInRange(0, 7) == 7 ? data.ConsumeIntegral<std::int32_t>() : 1;
  if (data.ConsumeBool()) request.scale = value();
  if (data.ConsumeBool()) request.offset = value();
  if (data.ConsumeBool()) request.nodata = value();
  request.fill_nodata = data.ConsumeBool();
  request.stretch = data.ConsumeBool();
  request.width = data.ConsumeIntegralInRange(0, 12);  // 0: only the raster's own grid is asked for
  request.height = request.width > 0 ? data.ConsumeIntegralInRange(1, 12) : 0;
  request.cell_size = data.ConsumeIntegralInRange(1, 50) / 8.0;
  request.origin_x = value();
  request.origin_y = value();
  return request;
}

/// A folder in memory, for rasters that have companions.
const std::filesystem::path& folder() {
  static const std::filesystem::path path = "/dev/shm/desert_sim_fuzz_" + std::to_string(getpid());
  static const bool made = std::filesystem::create_directory(path) &&
                           std::atexit([] { std::filesystem::remove_all(folder()); }) == 0;
  if (!made) std::abort();
  return path;
}

}  // namespace
}  // namespace desert_sim

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace desert_sim;
  static const RasterLoader load = gdal_raster_loader();
  set_log_sink([](Severity, const std::string&) {});
  FuzzedDataProvider data(bytes, size);
  RasterRequest request = request_of(data);
  const int format = data.ConsumeIntegralInRange(0, 3);
  std::string header, content;
  if (format == 0) header = envi_header(data);
  if (format == 1) content = ascii_grid(data);
  if (format == 2) content = tiff(data);
  content += data.ConsumeRemainingBytesAsString();
  request.path = (folder() / "raster").string();
  std::ofstream(request.path) << content;
  if (format == 0) std::ofstream(request.path + ".hdr") << header;
  fuzz::accept_or_refuse([&] { load(request); });
  std::filesystem::remove(request.path + ".hdr");
  return 0;
}
