#include "src/io/snapshots.hpp"

namespace desert_sim {

Raster to_raster(const Snapshot& s, const std::vector<float>& values, const std::string& projection) {
  Raster raster;
  raster.width = s.width;
  raster.height = s.height;
  raster.cell_size = s.cell_size;
  raster.origin_x = s.origin_x;
  raster.origin_y = s.origin_y;
  raster.projection = projection;
  raster.values = values;
  return raster;
}

PictureInput to_picture_input(const Snapshot& s) {
  const auto values = [&s](Layer layer) {
    const std::vector<float>* found = s.find(layer);
    return found ? found->data() : nullptr;
  };
  PictureInput picture;
  picture.width = s.width;
  picture.height = s.height;
  picture.cell_size = s.cell_size;
  picture.elevation = values(Layer::elevation);
  picture.sand = values(Layer::sand);
  picture.vegetation = values(Layer::vegetation);
  picture.plants = values(Layer::plants);
  picture.crown_colours = s.crown_colours;
  picture.palette = s.palette;
  picture.obstacle = values(Layer::obstacle);
  picture.water = values(Layer::water);
  picture.soil = values(Layer::soil);
  picture.wind_shadow = values(Layer::wind_shadow);
  return picture;
}

}  // namespace desert_sim
