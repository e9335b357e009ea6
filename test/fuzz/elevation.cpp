// Messages that a TerrainClient takes, as a sequence from one input: each is refused or becomes a map
// that can be asked anywhere.
#include <boost/make_shared.hpp>
#include <cmath>

#include "include/desert_sim/client/layer_assembler.hpp"
#include "test/fuzz/fuzz.hpp"
#include "test/fuzz/message_source.hpp"

namespace desert_sim {
namespace {

const std::vector<std::string> words{"map", "terrain", "/map", "", "no frame"};

ElevationGrid::ConstPtr keyframe(FuzzedDataProvider& data) {
  auto grid = boost::make_shared<ElevationGrid>(fuzz::next_message<ElevationGrid>(data, words));
  if (data.ConsumeBool()) return grid;
  // One whose size is right, of more blocks than one.
  grid->width = data.ConsumeIntegralInRange(1u, 80u);
  grid->height = data.ConsumeIntegralInRange(1u, 80u);
  const float height = grid->elevation.empty() ? 0 : grid->elevation[0];
  grid->elevation.assign(std::size_t{grid->width} * grid->height, height);
  grid->cell_size = std::isfinite(grid->cell_size) ? std::abs(grid->cell_size) + 0.01 : 1;
  grid->header.frame_id = "map";
  grid->origin.orientation.x = grid->origin.orientation.y = grid->origin.orientation.z = 0;
  grid->origin.orientation.w = 1;
  grid->origin.position.z = 0;
  return grid;
}

/// Makes the lengths of a tile's arrays right.
void fit(LayerTile& tile, FuzzedDataProvider& data) {
  tile.width = data.ConsumeIntegralInRange(1u, 80u);
  tile.height = data.ConsumeIntegralInRange(1u, 80u);
  const std::size_t cells = std::size_t{tile.width} * tile.height;
  std::size_t selected = cells;
  tile.changed.clear();
  if (data.ConsumeBool()) {
    tile.changed = data.ConsumeBytes<std::uint8_t>((cells + 7) / 8);
    tile.changed.resize((cells + 7) / 8);
    if (cells % 8 != 0) tile.changed.back() &= static_cast<std::uint8_t>(0xff << (8 - cells % 8));
    selected = 0;
    for (const std::uint8_t byte : tile.changed)
      selected += static_cast<std::size_t>(__builtin_popcount(byte));
  }
  const float value = tile.data.empty() ? 1 : tile.data[0];
  const bool absolute = data.ConsumeBool();
  tile.data.assign(absolute ? selected : 0, value);
  tile.bits = absolute ? 0 : (data.ConsumeBool() ? 4 : 8);
  tile.changes.assign(absolute ? 0 : (tile.bits == 4 ? (selected + 1) / 2 : selected), 0x30);
}

ElevationUpdate::ConstPtr update(FuzzedDataProvider& data, const ElevationMap* map) {
  auto message = boost::make_shared<ElevationUpdate>(fuzz::next_message<ElevationUpdate>(data, words));
  for (LayerTile& tile : message->tiles)
    if (data.ConsumeBool()) fit(tile, data);
  if (map && data.ConsumeBool()) {  // the next one
    message->header.frame_id = map->info().frame;
    message->header.stamp = map->info().stamp;
    message->keyframe = map->info().keyframe;
    message->sequence = map->info().sequence + 1;
    message->step = map->info().step;
    message->sim_time = map->info().sim_time;
  }
  return message;
}

void ask(const ElevationMap& map, double x, double y) {
  map.elevation(x, y);
  map.normal(x, y);
  map.slope(x, y);
}

void ask_everywhere(const ElevationMap& map) {
  const ElevationMap::Info& info = map.info();
  for (const double fraction : {0.0, 0.3, 1.0, -1e9, 1e300, double(NAN), double(INFINITY)})
    ask(map, info.origin_x + fraction * info.width * info.cell_size,
        info.origin_y + fraction * info.height * info.cell_size);
  map.at(info.width - 1, info.height - 1);
  if (map.elevations().size() != std::size_t{info.width} * info.height) std::abort();
}

}  // namespace
}  // namespace desert_sim

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace desert_sim;
  FuzzedDataProvider data(bytes, size);
  ElevationAssembler assembler;
  for (int n = 0; n < 24 && data.remaining_bytes() > 0; ++n) {
    MapChange change;
    try {
      if (data.ConsumeIntegralInRange(0, 3) == 0)
        change = assembler.process(keyframe(data));
      else
        change = assembler.process(update(data, assembler.map().get()));
    } catch (const ros::serialization::StreamOverrunException&) {  // too few bytes
      continue;
    }
    if (data.ConsumeIntegralInRange(0, 30) == 0) assembler.keyframe_overdue();
    if (!change.map) continue;
    ask_everywhere(*change.map);
    change.map->elevations(change.cells);
  }
  return 0;
}
