#include "src/simulation/checkpoint_words.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <sstream>

#include "kernels/base/math.hpp"
#include "src/core/error.hpp"

namespace desert_sim {

CheckpointWords divide_words(const CheckpointHeader& header, const char* bytes, std::size_t length,
                             const std::string& path) {
  const GridParameters& grid = header.scenario.grid;
  const std::uint64_t cells =
                          static_cast<std::uint64_t>(grid.width) * static_cast<std::uint64_t>(grid.height),
                      of_plants = header.numbers.plants * plants::column_count,
                      expected = (cells * header.layers.size() + of_plants) * sizeof(std::uint32_t);
  if (length != expected)
    throw ConfigError(path + ": has " + std::to_string(length) + " bytes behind its header, which lists " +
                      std::to_string(expected) + " bytes of layers and plants");
  CheckpointWords words;
  for (std::size_t n = 0; n < header.layers.size(); ++n, bytes += cells * sizeof(std::uint32_t))
    words.layers.emplace_back(bytes, cells);
  words.plants = {bytes, of_plants};
  return words;
}

namespace {

struct Range {
  double lowest, highest;
  const char* unit;
  bool has(double value) const { return value >= lowest && value <= highest; }  // NaN is in no range
};

template <class Value>
[[noreturn]] void refuse(const std::string& where, Value value, const Range& range) {
  std::ostringstream text;
  text.precision(10);
  text << where << ": " << value << " is not in [" << range.lowest << ", " << range.highest << "] "
       << range.unit;
  throw ConfigError(text.str());
}

constexpr double highest_quanta = wall_height - 1;
/// What lies on the deepest rock may reach up to there.
constexpr double deepest_quanta = std::numeric_limits<Quanta>::max();

/// The greatest flux that a simulation keeps is one that empties the deepest cell in the shortest sub-step.
double highest_flux(const CheckpointHeader& header) {
  constexpr double most_substeps = 10000;  // allowed by water.most_substeps
  const double cell = header.scenario.grid.cell_size;
  return std::max(any_height, deepest_quanta * header.scale().quantum() * cell * cell * most_substeps /
                                  header.scenario.run.time_step);
}

/// What a simulation may have made of a layer is more than what scenarios and edits may set.
Range range_of(const LayerInfo& row, const CheckpointHeader& header) {
  if (row.layer == Layer::soil || row.layer == Layer::sand || row.layer == Layer::water)
    return {0, deepest_quanta, "quanta"};  // check_heights() says how far up
  if (row.storage == Storage::quanta) return {row.lowest < 0 ? -highest_quanta : 0, highest_quanta, "quanta"};
  if (row.layer == Layer::water_flux_x || row.layer == Layer::water_flux_y)
    return {-highest_flux(header), highest_flux(header), row.unit};
  return {row.lowest, row.highest, row.unit};
}

std::string cell_text(std::size_t i, int width) {
  const auto columns = static_cast<std::size_t>(width);
  return "at cell (" + std::to_string(i % columns) + ", " + std::to_string(i / columns) + ")";
}

void check_layer(const LayerInfo& row, const CheckpointHeader& header, const WordsInFile& words,
                 const std::string& path) {
  const Range range = range_of(row, header);
  const bool quanta = row.storage == Storage::quanta;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const double value =
        quanta ? static_cast<Quanta>(words[i]) : static_cast<double>(float_from_bits(words[i]));
    if (!range.has(value))
      refuse(path + ": layer " + row.name + " " + cell_text(i, header.scenario.grid.width), value, range);
  }
}

/// The surface of ground and water has to stay below that of walls, too.
void check_heights(const CheckpointHeader& header, const CheckpointWords& words, const std::string& path) {
  std::vector<const WordsInFile*> column;
  for (std::size_t n = 0; n < header.layers.size(); ++n)
    for (Layer layer : {Layer::bedrock, Layer::soil, Layer::sand, Layer::water})
      if (header.layers[n] == layer) column.push_back(&words.layers[n]);
  for (std::size_t i = 0; i < column.front()->size(); ++i) {
    long long height = 0;
    for (const WordsInFile* layer : column) height += static_cast<Quanta>((*layer)[i]);
    if (height > static_cast<long long>(highest_quanta))
      refuse(path + ": bedrock, soil, sand and water together " + cell_text(i, header.scenario.grid.width),
             height, {-highest_quanta, highest_quanta, "quanta"});
  }
}

void check_plants(const CheckpointHeader& header, const WordsInFile& words, const std::string& path) {
  constexpr double any = std::numeric_limits<float>::max();
  const Grid grid = header.scenario.make_grid();
  const double least = std::numeric_limits<float>::denorm_min();
  // In the order of the columns. A plant may be wider than its species since a parameter was changed.
  const std::array<Range, plants::column_count> ranges{
      {{0, static_cast<double>(grid.width) * grid.cell_size, "m"},
       {0, static_cast<double>(grid.height) * grid.cell_size, "m"},
       {-highest_quanta, highest_quanta, "quanta"},
       {0, header.scenario.get<VegetationParameters>().largest_plant, "m"},
       {least, 1, "1"},
       {0, any, "m^3"},
       {0, any, "s"},
       {0, header.scenario.species.size() - 1.0, "1"}}};
  constexpr const char* names[plants::column_count] = {"x",      "y",     "z",   "radius",
                                                       "health", "water", "age", "species"};
  const std::size_t count = header.numbers.plants;
  for (std::size_t c = 0; c < ranges.size(); ++c) {
    const auto column = static_cast<plants::Column>(c);
    const bool whole = column == plants::Column::z || column == plants::Column::species;
    for (std::size_t n = 0; n < count; ++n) {
      const std::uint32_t word = words[c * count + n];
      const double value =
          whole ? static_cast<std::int32_t>(word) : static_cast<double>(float_from_bits(word));
      if (!ranges[c].has(value))
        refuse(path + ": plant " + std::to_string(n) + ": " + names[c], value, ranges[c]);
    }
  }
}

}  // namespace

void check_words(const CheckpointHeader& header, const CheckpointWords& words, const std::string& path) {
  for (std::size_t n = 0; n < header.layers.size(); ++n)
    check_layer(info(header.layers[n]), header, words.layers[n], path);
  check_heights(header, words, path);
  check_plants(header, words.plants, path);
}

}  // namespace desert_sim
