#pragma once
/// A terrain at one moment, as other programs get it.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "src/render/mesh.hpp"
#include "src/simulation/simulation.hpp"

namespace desert_sim {

struct ExportedTerrain {
  std::shared_ptr<const Snapshot> snapshot;  ///< has the elevation, and what gives the ground its colours
  std::shared_ptr<const PlantList> plants;   ///< null: none
  /// Called after each piece of a mesh that is written; what it throws ends the export, and the file is as it
  /// was before.
  std::function<void()> after_piece = {};
};

/// What its snapshot has, as far as the terrain does.
std::vector<Layer> layers_to_export();

/// The present state of a simulation.
ExportedTerrain terrain_to_export(Simulation& simulation);

/// Vertices of ground and water are the centres of cells, in metres from the south-west corner of the
/// terrain, z upwards. Colours are those of the materials, without light.
struct TerrainMeshes {
  render::Mesh ground;
  render::Mesh water;  ///< its surface where it is deeper than render::least_water_depth; alpha: its opacity
  render::Mesh plants;
};

/// Throws ConfigError that names `file` unless a terrain has 2 x 2 cells, the least that a mesh can show.
void require_surface(const std::string& file, int width, int height);

/// Throws as require_surface() does. `file`: for which they are.
TerrainMeshes meshes_of(const std::string& file, const ExportedTerrain& terrain);

/// The colours of the ground, row 0 = south, from the mesh of all cells.
std::vector<render::PackedColour> ground_colours(const Snapshot& snapshot, const render::Mesh& ground);
/// The same as seen from above, through the water.
std::vector<render::PackedColour> surface_colours(const Snapshot& snapshot, const render::Mesh& ground);

/// The index of the cell in which a vertex of a mesh lies.
std::size_t cell_of(const Snapshot& snapshot, const render::Vertex& vertex);

/// Units, axes and place of what is exported, for comments in files: one line.
std::string frame_note(const Snapshot& snapshot);

}  // namespace desert_sim
