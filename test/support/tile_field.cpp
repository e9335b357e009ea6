#include "test/support/tile_field.hpp"

#include <cmath>
#include <cstring>
#include <functional>

#include "kernels/field/random.hpp"
#include "kernels/field/surface_laws.hpp"

namespace desert_sim::test {

namespace {

template <class T>
Buffer<T> on(Exec& exec, const std::vector<T>& values) {
  Buffer<T> buffer(exec, values.size());
  if (!values.empty()) buffer.upload(values);
  return buffer;
}

template <class T>
T* or_null(Buffer<T>& buffer, const std::vector<T>& values) {
  return values.empty() ? nullptr : buffer.data();
}

/// The bits of a buffer's values behind those that are there.
template <class T>
void append(std::vector<std::uint32_t>& bits, const Buffer<T>& buffer) {
  for (T value : buffer.download()) {
    bits.emplace_back();
    std::memcpy(&bits.back(), &value, sizeof value);
  }
}

/// Uniform in [0, 1), of its own for each purpose.
double chance(int purpose, int cell) {
  return random_unit(7, Purpose::terrain_noise, static_cast<std::uint32_t>(cell),
                     static_cast<std::uint32_t>(purpose));
}

using Height = std::function<double(int x, int y)>;  ///< [m]

/// A field in metres at a quantum of 2⁻²⁰ m.
TileField field(const std::string& name, const Grid& grid, const Height& ground, const Height& sand,
                double repose = 0.65) {
  TileField f;
  f.name = name;
  f.grid = grid;
  f.quanta_per_cell = grid.cell_size * 1048576.0f;
  for (int y = 0; y < grid.height; ++y)
    for (int x = 0; x < grid.width; ++x) {
      f.ground.push_back(static_cast<Quanta>(std::llround(ground(x, y) * 1048576)));
      f.sand.push_back(static_cast<Quanta>(std::llround(sand(x, y) * 1048576)));
      f.repose.push_back(static_cast<float>(repose * (0.5 + chance(1, y * grid.width + x))));
    }
  return f;
}

}  // namespace

struct TileField::DeviceField {
  Buffer<Quanta> ground, sand, soil;
  Buffer<float> obstacle, repose;
  avalanching::LevelView level;

  DeviceField(Exec& exec, const TileField& f)
      : ground(on(exec, f.ground)),
        sand(on(exec, f.sand)),
        soil(on(exec, f.soil)),
        obstacle(on(exec, f.obstacle)),
        repose(on(exec, f.repose)),
        level{f.grid,      ground.data(), or_null(soil, f.soil), or_null(obstacle, f.obstacle),
              sand.data(), repose.data(), f.quanta_per_cell} {}
};

std::vector<Quanta> TileField::relaxed(Exec& exec, int offset, int sweeps, bool by_law, float share,
                                       float continue_threshold, float edge_factor) const {
  DeviceField device(exec, *this);
  Buffer<Quanta> before = on(exec, coarse_before), after = on(exec, coarse_after);
  const avalanching::Prolong from_coarse{coarse(), or_null(after, coarse_after),
                                         or_null(before, coarse_before), grid, device.sand.data()};
  Buffer<Quanta> device_flags = on(exec, active_flags);
  const avalanching::RelaxTile law{{grid, offset},
                                   device.level,
                                   from_coarse,
                                   {share, edge_factor * share},
                                   sweeps,
                                   continue_threshold,
                                   or_null(device_flags, active_flags),
                                   by_gradient,
                                   first_shift};
  with_backend(exec, [&](auto& e) {
    by_law ? avalanching::relax_tiles_reference(e, law)
           : avalanching::relax_tiles(e, law, avalanching::NoFollowUp{});
  });
  return device.sand.download();
}

avalanching::RelaxTile TileField::four_sweeps(DeviceField& device, int offset) const {
  return {{grid, offset}, device.level, {}, {0.65f, 0.4f}, 4, 0.2f, nullptr, by_gradient, first_shift};
}

std::vector<std::uint32_t> TileField::relaxed_and_restricted(Exec& exec, int offset) const {
  DeviceField device(exec, *this);
  struct Coarse {
    Buffer<Quanta> ground, sand, sand_before;
    Buffer<float> repose;
    avalanching::LevelBuffers out;
    Coarse(Exec& e, const Grid& g)
        : ground(e, cells(g)),
          sand(e, cells(g)),
          sand_before(e, cells(g)),
          repose(e, cells(g)),
          out{g, ground.data(), sand.data(), sand_before.data(), repose.data()} {}
    static std::size_t cells(const Grid& g) { return static_cast<std::size_t>(g.cells()); }
  };
  const Grid half = coarse(),
             quarter{half.width / 2, half.height / 2, 2 * half.cell_size, half.periodic_x, half.periodic_y};
  Coarse first(exec, half), second(exec, quarter);
  with_backend(exec, [&](auto& e) {
    avalanching::relax_tiles(e, four_sweeps(device, offset),
                             avalanching::Restrict{device.level, first.out, second.out});
  });
  std::vector<std::uint32_t> bits;
  append(bits, device.sand);
  for (Coarse* level : {&first, &second}) {
    append(bits, level->ground);
    append(bits, level->sand);
    append(bits, level->sand_before);
    append(bits, level->repose);
  }
  return bits;
}

std::vector<std::uint32_t> TileField::relaxed_and_measured(Exec& exec, int offset) const {
  DeviceField device(exec, *this);
  surface::Heights heights = surface::make_heights(exec, grid);
  with_backend(exec, [&](auto& e) {
    avalanching::relax_tiles(e, four_sweeps(device, offset),
                             surface::ComputeBlockHeights{
                                 grid, device.ground.data(), or_null(device.soil, soil), device.sand.data(),
                                 heights.blocks, heights.cell_heights.data(), heights.highest.data()});
  });
  std::vector<std::uint32_t> bits;
  append(bits, device.sand);
  append(bits, heights.cell_heights);
  append(bits, heights.highest);
  return bits;
}

std::vector<TileField> tile_fields() {
  const auto flat = [](int, int) { return 0.0; };
  const auto dunes = [](int x, int y) { return 4 + 4 * std::sin(0.3 * x + 0.2 * std::sin(0.5 * y)); };
  const auto noise = [](int x, int y) { return 3 * chance(2, 1000 * y + x); };
  const auto pits = [](int x, int y) { return x % 3 == 1 && y % 3 == 1 ? 0.0 : 1.0; };
  const Grid torus{96, 64, 1, true, true};
  std::vector<TileField> fields;
  fields.push_back(field("dunes", torus, noise, dunes));
  fields.push_back(field("open and of an odd size", {77, 45, 1, false, false}, noise, dunes));
  fields.push_back(field("a torus of an odd size", {77, 45, 1, true, true}, noise, dunes));
  fields.push_back(field("periodic along one axis", {33, 70, 1, true, false}, noise, dunes));
  fields.push_back(field("less than a tile", {5, 3, 1, true, true}, noise, dunes));
  fields.push_back(field("one cell", {1, 1, 1, true, true}, noise, dunes));
  fields.push_back(field("small cells", {64, 64, 0.01f, true, true}, flat, noise));
  fields.push_back(
      field("large cells", {64, 64, 4, true, true}, dunes, [&](int x, int y) { return 9 * noise(x, y); }));
  fields.push_back(field("no sand", torus, noise, flat));
  fields.push_back(field("at rest", torus, flat, [](int, int) { return 2.0; }));
  fields.push_back(field(
      "cliffs", torus, [&](int x, int y) { return (x / 9 + y / 7) % 2 ? 300 : noise(x, y); }, noise));
  fields.push_back(field(
      "pits of eight donors, at no angle", torus, flat, [&](int x, int y) { return 200 * pits(x, y); }, 0));
  fields.push_back(field(
      "pits in small cells", {64, 64, 0.01f, true, true}, flat,
      [&](int x, int y) { return 500 * pits(x, y); }, 0));
  fields.push_back(field("columns", torus, flat,
                         [](int x, int y) { return chance(3, 100 * y + x) < 0.05 ? 400.0 : 0.0; }));
  fields.push_back(field(
      "as high and deep as can be", torus, [](int x, int y) { return (x + y) % 5 ? -511.9 : 0.0; },
      [](int x, int y) { return (x + y) % 5 ? 0.0 : 511.9; }, 0.1));
  fields.push_back(field(
      "films on steep rock", torus, [](int x, int y) { return 2.0 * (x % 32) + y % 32; },
      [](int x, int y) { return 1e-6 * (chance(4, 100 * y + x) < 0.5 ? x * y % 400 : 0); }, 0.1));
  fields.push_back(field("steeper than can matter", torus, noise, noise, 1e6));
  TileField walls = field("walls", torus, noise, dunes);
  TileField solid = field("obstacles on soil", {50, 40, 1, false, false}, noise, dunes);
  for (int i = 0; i < walls.grid.cells(); ++i)
    if (chance(5, i) < 0.2) walls.ground[static_cast<std::size_t>(i)] = wall_height;
  for (int i = 0; i < solid.grid.cells(); ++i) {
    solid.soil.push_back(static_cast<Quanta>(1e6 * chance(6, i)));
    solid.obstacle.push_back(chance(7, i) < 0.3 ? 1.0f : 0.0f);
  }
  TileField walled = field("walls in deep sand", torus, flat, noise);
  for (int i = 0; i < walled.grid.cells(); ++i)
    if (chance(5, i) < 0.2) walled.ground[static_cast<std::size_t>(i)] = wall_height;
  fields.push_back(walled);
  fields.push_back(walls);
  fields.push_back(solid);
  for (Quanta& ground : walls.ground) ground = wall_height;
  walls.name = "nothing but walls";
  fields.push_back(walls);
  return fields;
}

TileField tiled(const TileField& field, int columns, int rows) {
  TileField f;
  f.name = field.name + ", many";
  f.grid = field.grid;
  f.grid.width *= columns;
  f.grid.height *= rows;
  f.quanta_per_cell = field.quanta_per_cell;
  for (int y = 0; y < f.grid.height; ++y)
    for (int x = 0; x < f.grid.width; ++x) {
      const auto i = static_cast<std::size_t>(field.grid.index(x % field.grid.width, y % field.grid.height));
      f.ground.push_back(field.ground[i]);
      f.sand.push_back(field.sand[i]);
      f.repose.push_back(field.repose[i]);
    }
  return f;
}

std::vector<TileField> tile_fields_with_coarse_changes() {
  std::vector<TileField> fields;
  for (const TileField& field : tile_fields()) {
    if (field.name != "dunes" && field.name != "open and of an odd size" && field.name != "obstacles on soil")
      continue;
    TileField f = field;
    const Grid coarse = f.coarse();
    for (int y = 0; y < coarse.height; ++y)
      for (int x = 0; x < coarse.width; ++x) {
        const int c = f.grid.index(2 * x, 2 * y);
        Quanta mean = 0;
        for (int child : {c, c + 1, c + f.grid.width, c + f.grid.width + 1})
          mean += f.sand[static_cast<std::size_t>(child)] / 4;
        f.coarse_before.push_back(mean);
        const double kind = chance(8, coarse.index(x, y));
        f.coarse_after.push_back(
            static_cast<Quanta>(kind < 0.3 ? mean : (kind < 0.4 ? 0 : mean * (1.4 * kind))));
      }
    fields.push_back(f);
  }
  return fields;
}

}  // namespace desert_sim::test
