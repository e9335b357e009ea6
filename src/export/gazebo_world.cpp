/// A world for Gazebo 11. What it makes of a heightmap, by trial of version 11.1:
/// - A 16-bit PNG is read byte by byte: its heights are noise. A GeoTIFF of floats keeps its heights as they
///   are where <size> has the difference between the highest and the lowest one. It needs a projection, no
///   value for missing data (of NaN, all heights are missing), and the square of 2^n + 1 points, whose
///   outermost ones lie on the edges of <size>.
/// - Its middle is the world's origin: contacts take no other place from <pose>, or from x and y in <pos>.
/// - With shadows, all of a heightmap lies in the shade.
#include <algorithm>
#include <filesystem>

#include "src/core/files.hpp"
#include "src/core/number_text.hpp"
#include "src/export/height_files.hpp"
#include "src/export/names_beside.hpp"
#include "src/export/square_heights.hpp"
#include "src/io/raster.hpp"

namespace desert_sim {

namespace {

/// A map around a point of the Earth, without meaning but for Gazebo, which wants to know how large a cell is
/// there.
constexpr const char* local_map =
    "PROJCS[\"middle of the terrain\",GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,"
    "298.257223563]],PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]],"
    "PROJECTION[\"Transverse_Mercator\"],PARAMETER[\"latitude_of_origin\",0],"
    "PARAMETER[\"central_meridian\",0],PARAMETER[\"scale_factor\",1],PARAMETER[\"false_easting\",0],"
    "PARAMETER[\"false_northing\",0],UNIT[\"metre\",1]]";

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '>')
      result += "&gt;";
    else
      result += c;
  }
  return result;
}

std::string uri(const std::string& path) {
  return "file://" + escaped(std::filesystem::path(path).filename().string());
}

Raster raster_of_heights(const Square& square, double cell_size, std::vector<float> heights) {
  Raster raster;
  raster.width = raster.height = square.side();
  raster.cell_size = cell_size;
  raster.origin_x = raster.origin_y = -0.5 * square.side() * cell_size;
  raster.projection = local_map;
  raster.values = std::move(heights);
  return raster;
}

struct World {
  std::string note, heights, picture;
  double length, relief;
};

std::string text_of(const World& w) {
  const std::string length = number_text(w.length, 17);
  const std::string map = "<uri>" + w.heights + "</uri><size>" + length + " " + length + " " +
                          number_text(w.relief, 17) + "</size><pos>0 0 0</pos>";
  return "<?xml version=\"1.0\"?>\n<!-- " + w.note +
         ".\n     Heights are the terrain's own. Start Gazebo in this folder, or with it in "
         "GAZEBO_RESOURCE_PATH. -->\n"
         "<sdf version=\"1.6\">\n  <world name=\"desert\">\n"
         "    <scene><ambient>0.5 0.5 0.55 1</ambient><background>0.7 0.8 0.9 1</background>"
         "<shadows>0</shadows></scene>\n"
         "    <light name=\"sun\" type=\"directional\">\n"
         "      <direction>0.5 -0.5 -0.7</direction><diffuse>0.8 0.8 0.75 1</diffuse>\n"
         "      <specular>0 0 0 1</specular>\n    </light>\n"
         "    <model name=\"terrain\">\n      <static>true</static>\n      <link name=\"ground\">\n"
         "        <collision name=\"contact\">\n          <geometry><heightmap>" +
         map +
         "</heightmap></geometry>\n        </collision>\n"
         "        <visual name=\"surface\">\n          <geometry><heightmap>" +
         map + "\n            <texture><diffuse>" + w.picture +
         "</diffuse><normal>file://media/materials/textures/flat_normal.png</normal><size>" + length +
         "</size></texture>\n          </heightmap></geometry>\n        </visual>\n"
         "      </link>\n    </model>\n  </world>\n</sdf>\n";
}

}  // namespace

void write_gazebo_world(const std::string& path, const ExportedTerrain& terrain) {
  const Snapshot& s = *terrain.snapshot;
  const Square square(s);
  const std::string heights = name_beside(path, world_heights), picture = name_beside(path, world_picture);
  std::vector<float> points = square.of(*s.find(Layer::elevation));
  const auto range = std::minmax_element(points.begin(), points.end());
  const double relief = static_cast<double>(*range.second) - static_cast<double>(*range.first);
  write_geotiff(heights, raster_of_heights(square, s.cell_size, std::move(points)), false);
  write_colours(picture, square.side(), square.side(),
                square.of(surface_colours(s, meshes_of(path, terrain).ground)));
  // Gazebo divides by the relief; of level ground any height of the map keeps the elevation.
  write_file(path, text_of({frame_note(s) + ", Gazebo's is " +
                                point_text(square.middle_x(), square.middle_y()) + " of it",
                            uri(heights), uri(picture), square.length(), relief > 0 ? relief : 1}));
}

}  // namespace desert_sim
