#pragma once
/// Writers of meshes. Each writes through a TemporaryFile, so that a file is whole or as it was before, and
/// throws what that throws.

#include <string>

#include "src/export/exported_terrain.hpp"

namespace desert_sim {

/// Binary PLY, lowest byte first: the ground, with colours as seen from above and normals.
void write_ply(const std::string& path, const ExportedTerrain& terrain);

/// Binary STL: the ground.
void write_stl(const std::string& path, const ExportedTerrain& terrain);

/// Wavefront OBJ: ground, water and plants, with colours of vertices, and materials in <name>.mtl. That of
/// the ground has the picture <name>_ground.png, a pixel a cell.
void write_obj(const std::string& path, const ExportedTerrain& terrain);

/// Binary glTF 2.0: ground, water and plants, with colours of vertices. y is up there, and -z is north.
/// Throws ConfigError for a terrain that does not fit into the 4 GiB of such a file.
void write_glb(const std::string& path, const ExportedTerrain& terrain);

}  // namespace desert_sim
