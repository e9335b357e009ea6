#include "src/tools/points.hpp"

#include <locale>
#include <sstream>

#include "src/core/error.hpp"
#include "src/core/number_text.hpp"

namespace desert_sim {

std::vector<double> numbers_of(const std::string& text, std::size_t count) {
  std::istringstream in(text);
  in.imbue(std::locale::classic());
  std::vector<double> numbers(count);
  for (std::size_t n = 0; n < count; ++n) {
    char comma = ',';
    if ((n > 0 && !(in >> comma)) || comma != ',' || !(in >> numbers[n])) return {};
  }
  char more = 0;
  return in >> more ? std::vector<double>() : numbers;
}

void require_on_grid(double x, double y, const GridParameters& g, const std::string& what) {
  const double east = g.origin_x + g.width * g.cell_size, north = g.origin_y + g.height * g.cell_size;
  if (x >= g.origin_x && x <= east && y >= g.origin_y && y <= north) return;
  throw ConfigError(what + ": (" + number_text(x, 10) + ", " + number_text(y, 10) +
                    ") does not lie on the terrain (allowed: x in [" + number_text(g.origin_x, 10) + ", " +
                    number_text(east, 10) + "] m, y in [" + number_text(g.origin_y, 10) + ", " +
                    number_text(north, 10) + "] m)");
}

}  // namespace desert_sim
