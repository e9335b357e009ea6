#pragma once
/// Grids in text (ESRI ASCII), of whose numbers GDAL takes as many as it needs, and 0 for what is none.

#include <string>

namespace desert_sim {

/// Throws ConfigError in the name of `path` unless the file of this name in GDAL's file system has exactly
/// `columns` × `rows` numbers after its header, and says where it has something else. `whole`: GDAL takes it
/// for a grid of whole numbers, by its beginning, and would cut off the others.
void check_text_grid(const std::string& path, const std::string& name, int columns, int rows, bool whole);

}  // namespace desert_sim
