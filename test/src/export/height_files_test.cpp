// Heights in files for other programs: read again, they are those of the terrain. What Gazebo makes of a
// world is computed as Gazebo 11.1 was seen to do it.

#include "src/export/height_files.hpp"

#include <gdal_priv.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <regex>

#include "src/core/log.hpp"
#include "src/io/raster.hpp"
#include "src/render/terrain_colours.hpp"
#include "test/src/export/exported.hpp"

namespace export_test {
namespace {

std::smatch found(const std::string& text, const char* expression) {
  std::smatch match;
  EXPECT_TRUE(std::regex_search(text, match, std::regex(expression))) << expression << " in\n" << text;
  return match;
}

/// The ground of Gazebo 11 at a point of its world [m].
class Gazebo {
 public:
  Gazebo(const test::TemporaryFolder& folder, const std::string& world)
      : text_(test::file_bytes(folder.path(world))) {
    const std::smatch map =
        found(text_, "<uri>file://([^<]*)</uri><size>(\\S+) (\\S+) (\\S+)</size><pos>0 0 0</pos>");
    heights_ = read_raster(folder.path(map[1]));
    size_x_ = std::stod(map[2]);
    size_y_ = std::stod(map[3]);
    size_z_ = std::stod(map[4]);
    const std::smatch middle = found(text_, "Gazebo's is \\((\\S+), (\\S+)\\) of it");
    middle_x_ = std::stod(middle[1]);
    middle_y_ = std::stod(middle[2]);
    const auto range = std::minmax_element(heights_.values.begin(), heights_.values.end());
    lowest_ = *range.first;
    relief_ = static_cast<double>(*range.second) - lowest_;
  }
  /// At a place of the terrain's frame.
  double height_at(double x, double y) const {
    const double column = ((x - middle_x_) / size_x_ + 0.5) * (heights_.width - 1),
                 row = ((y - middle_y_) / size_y_ + 0.5) * (heights_.height - 1);
    const double scale = relief_ > 0 ? size_z_ / relief_ : size_z_;
    return lowest_ + scale * (interpolated(column, row) - lowest_);
  }
  const Raster& heights() const { return heights_; }
  std::string picture() const { return found(text_, "<diffuse>file://([^<]*)</diffuse>")[1]; }

 private:
  double interpolated(double column, double row) const {
    const double x = std::clamp(column, 0.0, heights_.width - 1.0),
                 y = std::clamp(row, 0.0, heights_.height - 1.0);
    const auto at = [&](double c, double r) {
      return static_cast<double>(
          heights_.values.at(static_cast<std::size_t>(r) * static_cast<std::size_t>(heights_.width) +
                             static_cast<std::size_t>(c)));
    };
    const double west = std::floor(x), east = std::ceil(x), south = std::floor(y), north = std::ceil(y);
    const double a = at(west, south) + (x - west) * (at(east, south) - at(west, south)),
                 b = at(west, north) + (x - west) * (at(east, north) - at(west, north));
    return a + (y - south) * (b - a);
  }

  std::string text_;
  Raster heights_;
  double size_x_ = 0, size_y_ = 0, size_z_ = 0, middle_x_ = 0, middle_y_ = 0, lowest_ = 0, relief_ = 0;
};

bool is_power_of_two(int n) { return n > 0 && (n & (n - 1)) == 0; }

class HeightFiles : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder_.path(name); }
  /// All cells of the terrain have their height in Gazebo within a millimetre.
  Gazebo expect_in_gazebo(const std::shared_ptr<Snapshot>& s) {
    write_gazebo_world(path("a.world"), terrain_of(s));
    Gazebo gazebo(folder_, "a.world");
    EXPECT_EQ(gazebo.heights().width, gazebo.heights().height);
    EXPECT_TRUE(is_power_of_two(gazebo.heights().width - 1)) << gazebo.heights().width;
    double worst = 0;
    for (int y = 0; y < s->height; ++y)
      for (int x = 0; x < s->width; ++x)
        worst = std::max(worst, std::abs(gazebo.height_at(s->origin_x + (x + 0.5) * s->cell_size,
                                                          s->origin_y + (y + 0.5) * s->cell_size) -
                                         static_cast<double>(elevation(*s, x, y))));
    EXPECT_LT(worst, 1e-3);
    return gazebo;
  }
  test::TemporaryFolder folder_;
};

TEST_F(HeightFiles, GazeboHasTheHeightsOfEveryCell) {
  expect_in_gazebo(dunes(33, 33));
  expect_in_gazebo(dunes(64, 64));
  expect_in_gazebo(dunes(70, 23));
  expect_in_gazebo(dunes(21, 100));
  expect_in_gazebo(dunes(2, 3));
}

TEST_F(HeightFiles, GazeboHasTheHeightsOfPlacesOfUtm) {
  const auto s = dunes(50, 40);
  s->origin_x = 555160.25;
  s->origin_y = 4385105.5;
  s->cell_size = 0.1;
  expect_in_gazebo(s);
}

TEST_F(HeightFiles, GazeboHasLevelGround) {
  const auto s = dunes(40, 40);
  for (float& z : s->layers[Layer::elevation]) z = -7.25f;
  expect_in_gazebo(s);
}

TEST_F(HeightFiles, GazeboHasGroundBelowZeroAndHighMountains) {
  const auto s = dunes(40, 40);
  for (float& z : s->layers[Layer::elevation]) z = 60 * z - 4000;
  expect_in_gazebo(s);
}

TEST_F(HeightFiles, AroundAnOpenTerrainItsEdgeGoesOnAndAPeriodicOneRepeats) {
  const auto open = dunes(40, 40), periodic = dunes(40, 40, true);
  const double y = open->origin_y + 41, beyond = open->origin_x + 2 * 40 + 7;  // x of the cell 43
  EXPECT_NEAR(expect_in_gazebo(open).height_at(beyond, y), elevation(*open, 39, 20), 1e-3);
  EXPECT_NEAR(expect_in_gazebo(periodic).height_at(beyond, y), elevation(*periodic, 3, 20), 1e-3);
}

TEST_F(HeightFiles, GazeboTakesTheirRaster) {
  write_gazebo_world(path("a.world"), terrain_of(dunes(40, 40)));
  GDALAllRegister();
  GDALDatasetUniquePtr raster(GDALDataset::FromHandle(GDALOpen(path("a_heights.tif").c_str(), GA_ReadOnly)));
  ASSERT_TRUE(raster);
  int declared = 0;
  raster->GetRasterBand(1)->GetNoDataValue(&declared);
  EXPECT_EQ(declared, 0) << "of NaN, Gazebo takes all heights for missing";
  EXPECT_EQ(raster->GetRasterBand(1)->GetRasterDataType(), GDT_Float32);
  OGRSpatialReference earth;
  earth.SetWellKnownGeogCS("WGS84");
  const std::unique_ptr<OGRCoordinateTransformation> way(
      OGRCreateCoordinateTransformation(raster->GetSpatialRef(), &earth));
  double x = 0, y = 0;
  ASSERT_TRUE(way && way->Transform(1, &x, &y)) << "Gazebo refuses a raster without a place";
}

TEST_F(HeightFiles, ThePictureOfAWorldLiesOnItsHeights) {
  const auto s = dunes(40, 24);
  s->layers.erase(Layer::water);
  for (int cell = 0; cell < 40 * 24; ++cell) s->layers[Layer::obstacle].push_back(cell == 17 * 40 + 31);
  const Gazebo gazebo = expect_in_gazebo(s);
  const cv::Mat picture = cv::imread(path(gazebo.picture()), cv::IMREAD_COLOR);
  ASSERT_EQ(picture.cols, gazebo.heights().width);
  ASSERT_EQ(picture.rows, gazebo.heights().height);
  int obstacles = 0;
  for (int row = 0; row < picture.rows; ++row)
    for (int column = 0; column < picture.cols; ++column) {
      const auto bgr = picture.at<cv::Vec3b>(row, column);
      if (bgr != cv::Vec3b(88, 30, 64)) continue;  // the violet of obstacles
      ++obstacles;
      // 64 cells of 65 points: 12 of them in the west, 20 in the south.
      EXPECT_EQ(column, 12 + 31);
      EXPECT_EQ(picture.rows - 1 - row, 20 + 17);
    }
  EXPECT_EQ(obstacles, 1);
}

TEST_F(HeightFiles, NamesInAWorldAreTextOfXml) {
  write_gazebo_world(path("a&b.world"), terrain_of(dunes(20, 20)));
  const std::string text = test::file_bytes(path("a&b.world"));
  EXPECT_NE(text.find("file://a&amp;b_heights.tif<"), std::string::npos) << text;
  EXPECT_TRUE(std::filesystem::exists(path("a&b_heights.tif")));
}

TEST_F(HeightFiles, ExrHasTheElevationAsItIs) {
  const auto s = dunes(31, 17);
  write_elevation_exr(path("a.exr"), terrain_of(s));
  const Raster raster = read_raster(path("a.exr"));
  ASSERT_EQ(raster.width, 31);
  ASSERT_EQ(raster.height, 17);
  EXPECT_EQ(raster.values, *s->find(Layer::elevation));
}

TEST_F(HeightFiles, PngHasTheElevationBetweenTheHeightsOfItsDescription) {
  const auto s = dunes(40, 24);
  write_height_png(path("a.png"), terrain_of(s));
  const cv::Mat picture = cv::imread(path("a.png"), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(picture.type(), CV_16UC1);
  ASSERT_EQ(picture.cols, 65);
  ASSERT_EQ(picture.rows, 65);
  const std::smatch said =
      found(test::file_bytes(path("a.png")),
            "0 is (\\S+) m high, 65535 is (\\S+) m; pixels are 2 m apart, and the middle "
            "is at \\((\\S+), ([-0-9.]+)\\)");
  const double low = std::stod(said[1]), high = std::stod(said[2]);
  const double west = std::stod(said[3]) - 64, south = std::stod(said[4]) - 64;
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 40; ++x) {
      const int column = static_cast<int>(std::lround((1000 + 2 * x + 1 - west) / 2)),
                row = static_cast<int>(std::lround((-300 + 2 * y + 1 - south) / 2));
      const double z = low + (high - low) * picture.at<std::uint16_t>(64 - row, column) / 65535.0;
      EXPECT_NEAR(z, elevation(*s, x, y), 0.51 * (high - low) / 65535);
    }
}

TEST_F(HeightFiles, PngOfLevelGroundIsBlackAndOneOfMountainsWarns) {
  std::vector<std::string> warnings;
  const LogSink before =
      set_log_sink([&](Severity, const std::string& message) { warnings.push_back(message); });
  const auto s = dunes(40, 24);
  for (float& z : s->layers[Layer::elevation]) z = 3;
  write_height_png(path("level.png"), terrain_of(s));
  EXPECT_EQ(cv::countNonZero(cv::imread(path("level.png"), cv::IMREAD_UNCHANGED)), 0);
  EXPECT_TRUE(warnings.empty());
  s->layers[Layer::elevation][5] = 2003;
  write_height_png(path("high.png"), terrain_of(s));
  set_log_sink(before);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("high.png: its heights are in steps of 3.05 cm"), std::string::npos)
      << warnings[0];
}

}  // namespace
}  // namespace export_test
