#include "kernels/rover/height_field.hpp"

namespace desert_sim::height_field {

int plan_levels(View& view) {
  int offset = 0, columns = view.width + 1, rows = view.height + 1;
  view.level_count = 0;
  do {
    columns = blocks_along(columns, 4), rows = blocks_along(rows, 4);
    view.levels[view.level_count++] = {offset, columns, rows};
    offset += columns * rows;
  } while ((columns > 1 || rows > 1) && view.level_count < levels_at_most);
  return offset;
}

}  // namespace desert_sim::height_field
