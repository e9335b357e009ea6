#pragma once
/// The formats in which a terrain is written for other programs: one table, by the ending of the file.

#include <string>
#include <vector>

#include "src/export/exported_terrain.hpp"

namespace desert_sim {

struct ExportFormat {
  const char *ending, *what;
  std::vector<std::string> beside;  ///< ends of the names of what is written beside it (name_beside())
  bool has_surface;                 ///< needs 2 x 2 cells (require_surface())
  void (*write)(const std::string& path, const ExportedTerrain& terrain);
};

/// Those of this build: some need GDAL and OpenCV, .glb tinygltf.
const std::vector<ExportFormat>& export_formats();

/// ".ply (binary, the ground with colours), .stl (…" of all formats.
std::string describe_export_formats();

/// The format of a file by its ending. Throws ConfigError that names the file and the endings.
const ExportFormat& export_format(const std::string& path);

/// All files that export_terrain() writes for this one.
std::vector<std::string> exported_files(const std::string& path);

/// Throws ConfigError unless export_terrain() could write all files now, for a terrain of that many cells.
/// None of them may be one of `inputs`.
void require_exportable(const std::string& path, int width, int height,
                        const std::vector<std::string>& inputs);

/// Writes a terrain in the format of the ending. Each file is whole or as it was before; the one that is
/// named comes last. Throws what its writer does.
void export_terrain(const std::string& path, const ExportedTerrain& terrain);

}  // namespace desert_sim
