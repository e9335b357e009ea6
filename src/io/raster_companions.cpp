#include "src/io/raster_companions.hpp"

#include <cpl_conv.h>
#include <cpl_vsi.h>
#include <gdal_priv.h>

#include <cstdlib>
#include <memory>
#include <sstream>

#include "src/core/lower_case.hpp"
#include "src/io/raster_geometry.hpp"

namespace desert_sim {

namespace {

bool exists(const std::string& name) {
  VSIStatBufL status;
  return VSIStatExL(name.c_str(), &status, VSI_STAT_EXISTS_FLAG) == 0;
}

/// The name of the raster's .prj in GDAL's file system; empty if there is none.
std::string projection_file(GDALDataset& dataset) {
  for (const char* extension : {"prj", "PRJ"}) {
    const std::string name = CPLResetExtension(dataset.GetDescription(), extension);
    if (name != dataset.GetDescription() && exists(name)) return name;
  }
  return "";
}

}  // namespace

void check_raw_file(const std::string& path, GDALDataset& dataset, std::uint64_t file_bytes,
                    std::vector<std::string>& warnings) {
  const std::string driver = dataset.GetDriver() ? dataset.GetDriver()->GetDescription() : "";
  const char* compressed = dataset.GetMetadataItem("file_compression", "ENVI");
  GDALRasterBand& band = *dataset.GetRasterBand(1);
  if ((driver != "ENVI" && driver != "EHdr") || (compressed && std::string(compressed) != "0") ||
      band.GetMetadataItem("NBITS", "IMAGE_STRUCTURE"))
    return;
  const char* header = dataset.GetMetadataItem("header_offset", "ENVI");
  const std::uint64_t cells = static_cast<std::uint64_t>(dataset.GetRasterXSize()) * dataset.GetRasterYSize();
  const std::uint64_t needed =
      cells * dataset.GetRasterCount() * GDALGetDataTypeSizeBytes(band.GetRasterDataType()) +
      (header ? std::strtoull(header, nullptr, 10) : 0);
  if (file_bytes < needed)
    throw_raster_error(path, concatenate("is truncated: it has ", file_bytes, " bytes of ", needed));
  if (file_bytes > needed && driver == "ENVI")
    warnings.push_back(concatenate(
        "raster '", path, "': has ", file_bytes, " bytes, its header speaks of ", needed, " (",
        dataset.GetRasterXSize(), " samples, ", dataset.GetRasterYSize(), " lines, ",
        dataset.GetRasterCount(), dataset.GetRasterCount() == 1 ? " band of " : " bands of ",
        GDALGetDataTypeName(band.GetRasterDataType()), "): if one of these is wrong, so are the values"));
}

void require_external_mask(const std::string& path, GDALDataset& dataset, GDALRasterBand& band) {
  constexpr int of_the_file = GMF_PER_DATASET, of_a_band = GMF_ALPHA;
  if (!exists(std::string(dataset.GetDescription()) + ".msk") ||
      (band.GetMaskFlags() & (of_the_file | of_a_band)) == of_the_file)
    return;
  throw_raster_error(
      path, "its mask '" + path + ".msk' cannot be read, so that nobody knows which cells have data");
}

void warn_of_unused_projection(const std::string& path, GDALDataset& dataset, const std::string& projection,
                               std::vector<std::string>& warnings) {
  if (!projection.empty() || projection_file(dataset).empty()) return;
  warnings.push_back(
      "raster '" + path +
      "': the projection beside it (.prj) is not understood, so that its coordinates are taken for "
      "metres; declare it in the raster itself, with gdal_translate -a_srs");
}

std::string unit_of_arc_info(GDALDataset& dataset) {
  const std::string name = projection_file(dataset);
  if (name.empty()) return "";
  const std::unique_ptr<VSILFILE, int (*)(VSILFILE*)> file(VSIFOpenL(name.c_str(), "rb"), VSIFCloseL);
  if (!file) return "";
  std::string text(10000, '\0');
  text.resize(VSIFReadL(text.data(), 1, text.size(), file.get()));
  std::istringstream words(lower_case(text));
  for (std::string word; words >> word;)
    if (word == "zunits" && words >> word) return word == "no" ? "" : word;
  return "";
}

}  // namespace desert_sim
