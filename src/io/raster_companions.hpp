#pragma once
/// The files beside a raster, as far as GDAL leaves out in silence what it cannot use of them.

#include <cstdint>
#include <string>
#include <vector>

class GDALDataset;
class GDALRasterBand;

namespace desert_sim {

/// Throws ConfigError for a raw file (ENVI, EHdr) that is shorter than its header says, whose missing part
/// GDAL would read as zeros; adds a warning for one that is longer.
void check_raw_file(const std::string& path, GDALDataset& dataset, std::uint64_t file_bytes,
                    std::vector<std::string>& warnings);

/// Throws ConfigError if a mask lies beside the raster (.msk) that is not what masks the band.
void require_external_mask(const std::string& path, GDALDataset& dataset, GDALRasterBand& band);

/// Adds a warning if a projection lies beside the raster (.prj), and `projection` (WKT) is empty all the
/// same.
void warn_of_unused_projection(const std::string& path, GDALDataset& dataset, const std::string& projection,
                               std::vector<std::string>& warnings);

/// The unit of heights by the line "Zunits" of a projection beside the raster (.prj) that is written as
/// Arc/Info did; empty if it says none.
std::string unit_of_arc_info(GDALDataset& dataset);

}  // namespace desert_sim
