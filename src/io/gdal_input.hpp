#pragma once
/// Files that GDAL reads through descriptors which this process has opened.

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "src/core/input_file.hpp"

namespace desert_sim {

/// A raster file with its companions beside it (the header of an ENVI file, a mask, a projection, a
/// world file), in a
/// file system of GDAL's that holds nothing else and cannot be written: whatever the file says, a driver that
/// is given name() finds nothing on the disk or the network by it.
class GdalInput {
 public:
  /// Opens the file and its companions; `folder` as in InputFile. Throws ConfigError.
  GdalInput(const std::string& path, const std::string& folder);
  /// No dataset may have it open any more.
  ~GdalInput();
  GdalInput(const GdalInput&) = delete;
  GdalInput& operator=(const GdalInput&) = delete;

  const InputFile& file() const { return *files_.at(base_name_); }
  std::string name() const;                   ///< for GDALOpenEx()
  std::vector<std::string> siblings() const;  ///< for GDALOpenEx(): the names of all files
  /// A file of GDAL's metadata (.aux.xml) that lies beside it and is not read; empty if there is none.
  const std::string& unread_metadata() const { return unread_metadata_; }

 private:
  std::string base_name_, prefix_, unread_metadata_;
  std::map<std::string, std::shared_ptr<const InputFile>> files_;  ///< by name without folder
};

}  // namespace desert_sim
