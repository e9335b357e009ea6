// GridMaps in bags that others recorded, as terrain: what they mean, and what is refused.

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <sys/stat.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "src/grid_map/message_bytes.hpp"
#include "src/ros/conversion/map_window.hpp"
#include "src/simulation/session.hpp"
#include "src/tools/rasters.hpp"
#include "test/src/grid_map/maps.hpp"
#include "test/support/temporary_folder.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

using test::a_map;
using test::add_layer;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

class ForeignBags : public testing::Test {
 protected:
  std::string write(const GridMap& map) {
    write_grid_map(path_, "/somebody/elevation_map", map);
    return path_;
  }
  const Simulation& load(bool fill_nodata = false) {
    session_.apply(command::LoadScenario{path_, true, 0, fill_nodata});
    return session_.simulation();
  }
  const Simulation& load(const GridMap& map) {
    write(map);
    return load();
  }
  float value(Layer layer, int x, int y) {
    const Terrain& terrain = session_.simulation().terrain();
    return terrain.values(layer).at(static_cast<std::size_t>(y * terrain.grid().width + x));
  }
  /// Why the bag is refused; the session stays as it was.
  std::string refusal() {
    const std::uint64_t before = session_.simulation().state().hash();
    std::string reason;
    try {
      load();
      ADD_FAILURE() << "was loaded";
    } catch (const ConfigError& e) {
      reason = e.what();
    }
    EXPECT_EQ(session_.simulation().state().hash(), before);
    EXPECT_NE(reason.find(path_), std::string::npos) << "names no file: " << reason;
    return reason;
  }
  void expect_refused(const std::function<void(GridMap&)>& spoil, const std::string& what) {
    GridMap map = a_map();
    spoil(map);
    write(map);
    const std::string reason = refusal();
    EXPECT_NE(reason.find(what), std::string::npos) << "'" << what << "' is not in: " << reason;
  }

  const test::TemporaryFolder folder_;
  const std::string path_ = folder_.path("somebodys.bag");
  Session session_{test::parsed("grid: {width: 12, height: 9}\nwind: {speed: 4, direction_deg: 90}\n"
                                "terrain: [uniform: {layer: sand, value: 2}]\n"),
                   raster_loader_with_bags(), "cpu", 1};
};

TEST_F(ForeignBags, ElevationAloneIsRockAtItsOwnPlace) {
  const Simulation& s = load(a_map());
  const GridParameters& grid = s.scenario().grid;
  EXPECT_EQ(grid.width, 5);
  EXPECT_EQ(grid.height, 4);
  EXPECT_EQ(grid.cell_size, 0.5);
  EXPECT_EQ(grid.origin_x, 20 - 1.25);
  EXPECT_EQ(grid.origin_y, -30 - 1.0);
  EXPECT_EQ(grid.boundary, Boundary::open);
  EXPECT_EQ(s.state().wind_above().y, 4) << "the wind stays";
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 5; ++x) {
      EXPECT_EQ(value(Layer::bedrock, x, y), 100 + x + 10 * y) << x << ", " << y;
      EXPECT_EQ(value(Layer::sand, x, y), 0);
    }
}

/// grid_map: index (0, 0) is the corner of largest x and y.
TEST_F(ForeignBags, TheFirstValueLiesInTheNorthEast) {
  GridMap map = test::an_empty_map(5, 4);
  add_layer(map, "elevation", [](int, int) { return 1; });
  map.data[0].data.front() = 9;
  map.data[0].data[4] = 7;  // the last row of the first column: as far north, in the west
  load(map);
  EXPECT_EQ(value(Layer::bedrock, 4, 3), 9);
  EXPECT_EQ(value(Layer::bedrock, 0, 3), 7);
  EXPECT_EQ(value(Layer::bedrock, 0, 0), 1);
}

TEST_F(ForeignBags, CircularBuffersAreUnrolled) {
  for (int outer = 0; outer < 5; ++outer)
    for (int inner = 0; inner < 4; ++inner) {
      GridMap map = test::an_empty_map(5, 4);
      map.outer_start_index = static_cast<std::uint16_t>(outer);
      map.inner_start_index = static_cast<std::uint16_t>(inner);
      add_layer(map, "elevation", [](int x, int y) { return 100 + x + 10 * y; });
      load(map);
      for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 5; ++x)
          ASSERT_EQ(value(Layer::bedrock, x, y), 100 + x + 10 * y) << outer << " " << inner;
    }
}

TEST_F(ForeignBags, SandAndSoilLieBelowTheElevation) {
  GridMap map = a_map();
  add_layer(map, "sand_depth", [](int x, int) { return 0.25 * x; });
  add_layer(map, "variance", [](int, int) { return nan; });
  add_layer(map, "soil_depth", [](int, int y) { return 0.5 * y; });
  add_layer(map, "vegetation", [](int, int) { return 0.75; });
  load(map);
  EXPECT_EQ(value(Layer::sand, 3, 2), 0.75);
  EXPECT_EQ(value(Layer::soil, 3, 2), 1);
  EXPECT_EQ(value(Layer::bedrock, 3, 2), 123 - 1.75);
  EXPECT_EQ(value(Layer::vegetation, 3, 2), 0.75);
}

TEST_F(ForeignBags, BedrockIsTakenBeforeElevation) {
  GridMap map = a_map();
  add_layer(map, "bedrock", [](int, int) { return 50; });
  add_layer(map, "sand", [](int, int) { return 2; });
  load(map);
  EXPECT_EQ(value(Layer::bedrock, 1, 1), 50);
  EXPECT_EQ(value(Layer::sand, 1, 1), 2);
}

TEST_F(ForeignBags, AreKnownByTheNamesThatMapsHave) {
  for (const MapLayer& layer : map_layers) {
    if (info(layer.layer).lifetime != Lifetime::persistent) continue;
    GridMap map = a_map();
    if (layer.layer != Layer::bedrock) add_layer(map, layer.name, [](int, int) { return 0.5; });
    if (layer.layer == Layer::bedrock) map.layers[0] = layer.name;
    load(map);
    EXPECT_EQ(value(layer.layer, 0, 0), layer.layer == Layer::bedrock ? 100 : 0.5f) << layer.name;
  }
}

TEST_F(ForeignBags, GapsAreRefusedOrFilled) {
  GridMap map = a_map();
  map.data[0].data[7] = static_cast<float>(nan);
  write(map);
  EXPECT_NE(refusal().find("1 cells without data; set fill_nodata to true"), std::string::npos);
  load(true);
  for (float height : session_.simulation().terrain().values(Layer::bedrock)) {
    EXPECT_GE(height, 100);
    EXPECT_LE(height, 134);
  }
  for (float& height : map.data[0].data) height = static_cast<float>(nan);
  write(map);
  EXPECT_THROW(load(true), ConfigError);
}

TEST_F(ForeignBags, TheLastMapCounts) {
  for (const auto compression :
       {rosbag::compression::Uncompressed, rosbag::compression::BZ2, rosbag::compression::LZ4})
    for (const std::uint32_t chunk : {100u, 1000000u}) {
      rosbag::Bag bag(path_, rosbag::bagmode::Write);
      bag.setCompression(compression);
      bag.setChunkThreshold(chunk);
      bag.write("/map", ros::Time(10), a_map("elevation"));
      bag.write("/map", ros::Time(30), a_map("bedrock"));
      GridMap between = a_map();
      between.data[0].data[0] = -7;
      bag.write("/map", ros::Time(20), between);
      bag.write("/words", ros::Time(40), std_msgs::Header());
      bag.close();
      EXPECT_EQ(read_grid_map(path_).layers.at(0), "bedrock") << compression << " " << chunk;
      load();
    }
}

TEST_F(ForeignBags, WithTwoTopicsOrNoMapAreRefused) {
  {
    rosbag::Bag bag(path_, rosbag::bagmode::Write);
    bag.write("/raw", ros::Time(10), a_map());
    bag.write("/fused", ros::Time(10), a_map());
  }
  EXPECT_NE(refusal().find("several topics: /fused, /raw"), std::string::npos);
  {
    rosbag::Bag bag(path_, rosbag::bagmode::Write);
    bag.write("/words", ros::Time(10), std_msgs::Header());
  }
  EXPECT_NE(refusal().find("contains no grid_map_msgs/GridMap (it contains: std_msgs/Header)"),
            std::string::npos);
  rosbag::Bag(path_, rosbag::bagmode::Write).close();
  EXPECT_NE(refusal().find("contains no grid_map_msgs/GridMap"), std::string::npos);
}

TEST_F(ForeignBags, OfAnotherDefinitionAreRefused) {
  rosbag::Bag bag(path_, rosbag::bagmode::Write);
  const auto header = boost::make_shared<ros::M_string>();
  (*header)["type"] = "grid_map_msgs/GridMap";
  (*header)["md5sum"] = "00000000000000000000000000000000";
  (*header)["message_definition"] = "float32 x\n";
  bag.write("/map", ros::Time(10), a_map(), header);
  bag.close();
  // rosbag writes the sum of the message that it is given into the header of the file.
  std::string bytes = test::file_bytes(path_);
  const std::string sum = GridMapType<GridMap>::md5;
  for (std::size_t at = bytes.find(sum); at != std::string::npos; at = bytes.find(sum))
    bytes.replace(at, sum.size(), sum.size(), '0');
  folder_.write("somebodys.bag", bytes);
  EXPECT_NE(refusal().find("another message definition"), std::string::npos);
}

TEST_F(ForeignBags, MapsThatAreNoneAreRefused) {
  const auto infinite = std::numeric_limits<float>::infinity();
  expect_refused([](GridMap& m) { m.layers[0] = "height"; },
                 "neither a layer bedrock nor a layer elevation (it contains: height)");
  expect_refused([](GridMap& m) { m.layers.clear(), m.data.clear(); }, "no layers");
  expect_refused([](GridMap& m) { m.layers.push_back("sand"); }, "names 2 layers but contains 1");
  expect_refused([](GridMap& m) { m.layers.push_back("elevation"), m.data.push_back(m.data[0]); },
                 "'elevation' is given twice");
  expect_refused([](GridMap& m) { m.info.resolution = 0; }, "resolution: 0");
  expect_refused([](GridMap& m) { m.info.resolution = nan; }, "resolution: nan");
  expect_refused([](GridMap& m) { m.info.length_x = std::numeric_limits<double>::infinity(); },
                 "must be finite");
  expect_refused([](GridMap& m) { m.info.pose.position.y = nan; }, "must be finite");
  expect_refused([](GridMap& m) { m.info.length_x = 3; },
                 "5 x 4 cells of 0.5 m do not match the map's lengths of 3 x 2 m");
  expect_refused([](GridMap& m) { m.info.pose.orientation.z = 0.7, m.info.pose.orientation.w = 0.714; },
                 "rotated");
  expect_refused([](GridMap& m) { std::swap(m.data[0].layout.dim[0], m.data[0].layout.dim[1]); },
                 "column-major");
  expect_refused([](GridMap& m) { m.data[0].layout.dim.clear(); }, "column-major");
  expect_refused([](GridMap& m) { m.data[0].data.pop_back(); }, "5 x 4 cells and 19 values");
  expect_refused([](GridMap& m) { m.data[0].layout.data_offset = 1; }, "values from offset 1");
  expect_refused([](GridMap& m) { m.data[0].layout.dim[0].size = 0xffffffffu; }, "4294967295 cells");
  expect_refused([](GridMap& m) { m.outer_start_index = 5; }, "(5, 0) are not below 5 x 4");
  expect_refused([](GridMap& m) { m.inner_start_index = 4; }, "(0, 4) are not below 5 x 4");
  expect_refused([&](GridMap& m) { m.data[0].data[3] = infinite; }, "infinite");
  expect_refused([](GridMap& m) { m.data[0].data[3] = 2e6f; }, "allowed: [-1000000");
  expect_refused([](GridMap& m) { m.layers.push_back("vegetation"), m.data.push_back(m.data[0]); },
                 "layer vegetation would be");
}

TEST_F(ForeignBags, WithoutAnOrientationAreTakenAsGridMapTakesThem) {
  GridMap map = a_map();
  map.info.pose.orientation.w = 0;
  load(map);
}

TEST_F(ForeignBags, CutAnywhereAreRefused) {
  GridMap map = a_map();
  add_layer(map, "sand_depth", [](int x, int y) { return x + y; });
  const std::string bytes = test::file_bytes(write(map));
  for (std::size_t n = 0; n < 60; ++n) {
    folder_.write("somebodys.bag", bytes.substr(0, bytes.size() * n / 60));
    EXPECT_FALSE(refusal().empty());
  }
}

/// Around the headers of all records: their lengths, fields, indexes and the beginning of what they hold.
TEST_F(ForeignBags, WithAByteFlippedAreReadOrRefused) {
  const std::string bytes = test::file_bytes(write(a_map()));
  EXPECT_EQ(read_grid_map(path_).layers.size(), 1u);
  int refused = 0;
  for (std::size_t op = bytes.find("op="); op != std::string::npos; op = bytes.find("op=", op + 1))
    for (std::size_t n = op - 40; n < std::min(op + 60, bytes.size()); ++n) {
      std::string broken = bytes;
      broken[n] = static_cast<char>(broken[n] ^ (n % 2 ? 0x80 : 0x01));
      folder_.write("somebodys.bag", broken);
      try {
        read_grid_map(path_);
      } catch (const ConfigError&) {
        ++refused;
      }
    }
  EXPECT_GT(refused, 100);
}

TEST_F(ForeignBags, ThatAreNoBagsAreRefused) {
  for (const std::string& text :
       {std::string(), std::string("#ROSBAG V2.0\n"), std::string("#ROSBAG V9.0\n" + std::string(9000, 'x')),
        std::string("grid: {width: 3}\n"), std::string(100000, '\0')}) {
    folder_.write("somebodys.bag", text);
    EXPECT_FALSE(refusal().empty());
  }
  std::filesystem::remove(path_);
  EXPECT_NE(refusal().find("no such file"), std::string::npos);
  std::filesystem::create_directory(path_);
  EXPECT_NE(refusal().find("is not a regular file"), std::string::npos);
  std::filesystem::remove(path_);
  ASSERT_EQ(mkfifo(path_.c_str(), 0600), 0);
  EXPECT_NE(refusal().find("is not a regular file"), std::string::npos) << "without waiting for a writer";
}

TEST_F(ForeignBags, AreReadBelowTheFolderOnly) {
  write(a_map());
  const std::string data = folder_.path("data"), inside = data + "/a.bag", link = data + "/link.bag";
  std::filesystem::create_directory(data);
  std::filesystem::copy_file(path_, inside);
  std::filesystem::create_symlink(path_, link);
  RasterRequest request;
  request.path = inside;
  const RasterLoader load = raster_loader_with_bags({data, false});
  EXPECT_EQ(load(request).width, 5);
  for (const std::string& outside : {path_, link}) {
    request.path = outside;
    EXPECT_THROW(load(request), ConfigError) << outside;
    EXPECT_EQ(raster_loader_with_bags()(request).width, 5);
  }
}

/// Four billion elements in four bytes: refused before memory is taken for them.
TEST_F(ForeignBags, LengthsThatLieTakeNoMemory) {
  std::vector<std::uint8_t> bytes(40, 0xff);
  std::vector<float> floats;
  std::vector<std::string> texts;
  std::vector<std_msgs::Float32MultiArray> layers;
  const auto message = [&] { return BoundedInputStream(bytes.data(), 40); };
  EXPECT_THROW(message().next(floats), ros::serialization::StreamOverrunException);
  EXPECT_THROW(message().next(texts), ros::serialization::StreamOverrunException);
  EXPECT_THROW(message().next(layers), ros::serialization::StreamOverrunException);
  EXPECT_LT(floats.capacity() + texts.capacity() + layers.capacity(), 100u);
}

/// For desert_run too.
TEST_F(ForeignBags, AreRastersOfScenariosWithLayersAsBands) {
  GridMap map = a_map("variance");
  add_layer(map, "elevation", [](int x, int y) { return x + y; });
  write(map);
  Session session(test::parsed("grid: {from_raster: " + path_ +
                               ", cell_size: 0.25, boundary: open}\n"
                               "terrain: [raster: {layer: bedrock, band: 2, scale: 2, offset: 1}]\n"),
                  raster_loader(), "cpu", 1);
  const Terrain& terrain = session.simulation().terrain();
  EXPECT_EQ(terrain.grid().width, 10);
  EXPECT_EQ(terrain.grid().height, 8);
  const std::vector<float> heights = terrain.values(Layer::bedrock);
  EXPECT_NEAR(heights[4 * 10 + 5], 1 + 2 * (2.25 + 1.75), 0.1) << "between the cells of the map";
  EXPECT_THROW(Session(test::parsed("grid: {from_raster: " + path_ + "}\nterrain: [raster: {band: 3}]\n"),
                       raster_loader(), "cpu", 1),
               ConfigError);
}

}  // namespace
}  // namespace desert_sim
