// Pictures: north is up, each material has its colour, sizes, unknown ground, and files.

#include "src/io/picture.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "src/core/error.hpp"
#include "test/support/full_disk.hpp"
#include "test/support/temporary_folder.hpp"

namespace desert_sim {
namespace {

namespace fs = std::filesystem;
constexpr int picture_side = 512;

/// A flat grid with all layers; its south-west, south-east, north-west and north-east quarters are numbered 0
/// to 3.
struct Ground {
  std::vector<float> elevation, layer;
  PictureInput input;

  Ground() : elevation(picture_side * picture_side, 10), layer(picture_side * picture_side, 0) {
    input.width = input.height = picture_side;
    input.elevation = elevation.data();
  }
  void fill_quarter(int quarter, float value) {
    for (int y = 0; y < picture_side / 2; ++y)
      for (int x = 0; x < picture_side / 2; ++x)
        layer[(y + quarter / 2 * (picture_side / 2)) * picture_side + x + quarter % 2 * (picture_side / 2)] =
            value;
  }
};

/// The pixel in the middle of a quarter of the map.
cv::Vec3b pixel(const cv::Mat& picture, int quarter) {
  return picture.at<cv::Vec3b>(picture.rows * (quarter / 2 == 0 ? 3 : 1) / 4,
                               picture.cols * (quarter % 2 == 0 ? 1 : 3) / 4);
}

int blue(cv::Vec3b p) { return p[0]; }
int green(cv::Vec3b p) { return p[1]; }
int red(cv::Vec3b p) { return p[2]; }
int brightness(cv::Vec3b p) { return p[0] + p[1] + p[2]; }

TEST(Hillshade, MaterialsHaveTheirColoursInTheirPlace) {
  const auto shown = [](const float* PictureInput::*member, float value) {
    Ground ground;
    ground.fill_quarter(2, value);  // north-west: upper left in the picture
    ground.input.*member = ground.layer.data();
    const cv::Mat picture = hillshade_picture(ground.input);
    EXPECT_EQ(picture.type(), CV_8UC3);
    EXPECT_EQ(picture.size(), cv::Size(picture_side, picture_side));
    const cv::Vec3b rock = pixel(picture, 1);
    EXPECT_EQ(pixel(picture, 0), rock);
    EXPECT_EQ(pixel(picture, 3), rock);
    EXPECT_LT(red(rock) - blue(rock), 40) << "rock is grey";
    EXPECT_GE(red(rock), blue(rock)) << "brownish";
    return pixel(picture, 2);
  };
  const cv::Vec3b sand = shown(&PictureInput::sand, 1);
  EXPECT_GT(red(sand), 180);
  EXPECT_GT(red(sand) - blue(sand), 80);
  EXPECT_GT(green(sand) - blue(sand), 40);
  const cv::Vec3b vegetation = shown(&PictureInput::vegetation, 1);
  EXPECT_GT(green(vegetation), red(vegetation) + 30);
  EXPECT_GT(green(vegetation), blue(vegetation) + 30);
  const cv::Vec3b obstacle = shown(&PictureInput::obstacle, 1);
  EXPECT_GT(blue(obstacle), red(obstacle));
  EXPECT_GT(red(obstacle), green(obstacle));
  EXPECT_LT(brightness(obstacle), 250);
  const cv::Vec3b shallow = shown(&PictureInput::water, 0.3F), deep = shown(&PictureInput::water, 10);
  EXPECT_GT(blue(shallow), red(shallow) + 40);
  EXPECT_GT(blue(deep), red(deep) + 40);
  EXPECT_LT(brightness(deep), brightness(shallow) - 100);
  const cv::Vec3b soil = shown(&PictureInput::soil, 1);
  EXPECT_GT(red(soil) - blue(soil), 40);
  EXPECT_LT(brightness(soil), 300);
  const cv::Vec3b shadow = shown(&PictureInput::wind_shadow, 1);
  EXPECT_LT(brightness(shadow), 330);
}

TEST(Hillshade, PlantsHaveTheirSpeciesColour) {
  Ground ground;
  std::vector<float> cover(ground.layer.size(), 1);
  ground.fill_quarter(2, 1);
  ground.fill_quarter(1, 2);
  ground.fill_quarter(0, 3);  // of which there is no colour
  ground.input.vegetation = cover.data();
  ground.input.plants = ground.layer.data();
  ground.input.crown_colours = {{0.5F, 0.1F, 0.1F}, {0.1F, 0.1F, 0.5F}};
  const cv::Mat picture = hillshade_picture(ground.input);
  EXPECT_GT(red(pixel(picture, 2)), 2 * blue(pixel(picture, 2)));
  EXPECT_GT(blue(pixel(picture, 1)), 2 * red(pixel(picture, 1)));
  for (int quarter : {0, 3}) EXPECT_GT(green(pixel(picture, quarter)), red(pixel(picture, quarter)));
}

TEST(Hillshade, SandBlendsIn) {
  Ground ground;
  ground.input.sand = ground.layer.data();
  std::vector<int> reds;
  for (float depth : {0.0F, 0.015F, 0.05F, 0.09F, 0.13F, 3.0F}) {
    std::fill(ground.layer.begin(), ground.layer.end(), depth);
    reds.push_back(red(pixel(hillshade_picture(ground.input), 2)));
  }
  EXPECT_EQ(reds[0], reds[1]) << "under 2 cm rock shows";
  EXPECT_LT(reds[1] + 5, reds[2]);
  EXPECT_LT(reds[2] + 5, reds[3]);
  EXPECT_LT(reds[3], reds[4]);
  EXPECT_EQ(reds[4], reds[5]) << "over 12 cm all is sand";
}

TEST(Hillshade, LightComesFromTheNorthWest) {
  // Tents of three steepnesses, ridge north-south: the west side is lit and the east side dark, on gentle
  // ground too.
  for (float slope : {0.002F, 0.1F, 1.0F}) {
    Ground ground;
    for (int y = 0; y < picture_side; ++y)
      for (int x = 0; x < picture_side; ++x)
        ground.elevation[y * picture_side + x] = -slope * std::abs(x - picture_side / 2.0F);
    const cv::Mat picture = hillshade_picture(ground.input);
    EXPECT_GT(brightness(pixel(picture, 2)), brightness(pixel(picture, 3)) + 20) << slope;
    for (int y = 0; y < picture_side; ++y)
      for (int x = 0; x < picture_side; ++x)
        ground.elevation[y * picture_side + x] = -slope * std::abs(y - picture_side / 2.0F);
    const cv::Mat other = hillshade_picture(ground.input);
    EXPECT_GT(brightness(pixel(other, 2)), brightness(pixel(other, 0)) + 20) << "the north side, " << slope;
  }
}

TEST(Hillshade, ExaggerationFollowsTheRelief) {
  Ground ground;
  EXPECT_EQ(picture_exaggeration(ground.input), 1) << "flat";
  const auto with_slope = [&](float slope) {
    for (int i = 0; i < picture_side * picture_side; ++i)
      ground.elevation[i] = slope * static_cast<float>(i % picture_side);
    return picture_exaggeration(ground.input);
  };
  EXPECT_NEAR(with_slope(0.1F), 6, 0.02);
  EXPECT_EQ(with_slope(0.001F), 60);
  EXPECT_EQ(with_slope(5), 0.5);
}

TEST(Hillshade, UnknownGroundIsLightGreyAndDoesNotSpread) {
  Ground ground;
  const cv::Vec3b known = pixel(hillshade_picture(ground.input), 0);
  for (int y = 0; y < picture_side / 2; ++y)
    for (int x = 0; x < picture_side / 2; ++x)
      ground.elevation[(y + picture_side / 2) * picture_side + x + picture_side / 2] =
          std::numeric_limits<float>::quiet_NaN();
  const cv::Mat picture = hillshade_picture(ground.input);
  EXPECT_EQ(pixel(picture, 3), cv::Vec3b(215, 215, 215));
  EXPECT_EQ(pixel(picture, 0), known);
  EXPECT_EQ(picture.at<cv::Vec3b>(picture_side / 2, picture_side * 3 / 4), known) << "just south of it";
  EXPECT_EQ(picture.at<cv::Vec3b>(picture_side / 4, picture_side / 2 - 1), known) << "just west of it";
  std::fill(ground.elevation.begin(), ground.elevation.end(), std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(pixel(hillshade_picture(ground.input), 1), cv::Vec3b(215, 215, 215));
}

TEST(Hillshade, Sizes) {
  struct Case {
    int width, height;
    cv::Size shown;
  };
  for (const Case& c :
       {Case{100, 40, {600, 240}}, Case{1, 1, {512, 512}}, Case{511, 300, {1022, 600}},
        Case{512, 3, {512, 3}}, Case{2048, 100, {2048, 100}}, Case{3000, 1500, {2048, 1024}}}) {
    // The north-west cells are sand whatever the size.
    std::vector<float> elevation(static_cast<std::size_t>(c.width) * c.height, 1), sand(elevation.size(), 0);
    for (int y = c.height / 2; y < c.height; ++y)
      for (int x = 0; x < (c.width + 1) / 2; ++x) sand[static_cast<std::size_t>(y) * c.width + x] = 1;
    PictureInput input;
    input.width = c.width;
    input.height = c.height;
    input.elevation = elevation.data();
    input.sand = sand.data();
    const cv::Mat picture = hillshade_picture(input);
    EXPECT_EQ(picture.size(), c.shown);
    const cv::Vec3b corner = picture.at<cv::Vec3b>(0, 0);
    EXPECT_GT(red(corner) - blue(corner), 80) << c.width << " x " << c.height;
    if (c.width > 1) {
      EXPECT_LT(red(pixel(picture, 3)) - blue(pixel(picture, 3)), 40);
    }
  }
}

TEST(Hillshade, RefusesWhatItCannotShow) {
  Ground ground;
  ground.input.elevation = nullptr;
  EXPECT_THROW(hillshade_picture(ground.input), ConfigError);
  ground.input.elevation = ground.elevation.data();
  ground.input.width = 0;
  EXPECT_THROW(hillshade_picture(ground.input), ConfigError);
  ground.input.width = picture_side;
  ground.input.cell_size = 0;
  EXPECT_THROW(picture_exaggeration(ground.input), ConfigError);
  EXPECT_THROW(wind_picture(4, 4, 1, ground.layer.data(), nullptr, nullptr), ConfigError);
}

TEST(Wind, SpeedIsBrightness) {
  std::vector<float> u(picture_side * picture_side, 1), v(picture_side * picture_side, 0);
  for (int y = picture_side / 2; y < picture_side; ++y)
    for (int x = 0; x < picture_side / 2; ++x) u[y * picture_side + x] = 9;  // north-west
  const cv::Mat picture = wind_picture(picture_side, picture_side, 1, u.data(), v.data(), nullptr);
  EXPECT_EQ(picture.size(), cv::Size(1024, 1024));
  const auto quarter = [&](int row, int column) {
    const cv::Scalar m = cv::mean(picture(cv::Rect(column + 100, row + 100, 320, 320)));
    return m[0] + m[1] + m[2];
  };
  const double fast = quarter(0, 0);
  EXPECT_GT(fast, quarter(0, 512) + 100);
  EXPECT_GT(fast, quarter(512, 0) + 100);
  EXPECT_GT(fast, quarter(512, 512) + 100);
}

TEST(Wind, ArrowsPointWhereTheAirMoves) {
  // An even wind: around the first arrow's centre its head, the wider end, must lie to the side of the
  // motion.
  struct Case {
    float u, v;
    int head_column, head_row;  // pixels from the centre
  };
  for (const Case& c : {Case{5, 0, 8, 0}, Case{-5, 0, -8, 0}, Case{0, 5, 0, -8}, Case{0, -5, 0, 8}}) {
    std::vector<float> u(picture_side * picture_side, c.u), v(picture_side * picture_side, c.v);
    const cv::Mat picture = wind_picture(picture_side, picture_side, 1, u.data(), v.data(), nullptr);
    const cv::Vec3b ground = picture.at<cv::Vec3b>(0, 0);
    const auto drawn = [&](int column,
                           int row) {  // pixels of the arrow in a 9 x 9 box about (16, 16) + offset
      int count = 0;
      for (int y = -4; y <= 4; ++y)
        for (int x = -4; x <= 4; ++x) count += picture.at<cv::Vec3b>(16 + row + y, 16 + column + x) != ground;
      return count;
    };
    EXPECT_GT(drawn(c.head_column, c.head_row), drawn(-c.head_column, -c.head_row) + 10)
        << c.u << ", " << c.v;
  }
}

TEST(Wind, CalmAndNaNAreDrawn) {
  std::vector<float> u(20 * 10, 0), v(20 * 10, 0), elevation(20 * 10, 2);
  EXPECT_EQ(wind_picture(20, 10, 1, u.data(), v.data(), elevation.data()).size(), cv::Size(1040, 520));
  u[3] = v[5] = elevation[9] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(wind_picture(20, 10, 1, u.data(), v.data(), elevation.data()).size(), cv::Size(1040, 520));
}

TEST(WritePng, WritesWholeFilesOrNone) {
  const test::TemporaryFolder folder;
  cv::Mat picture(4, 6, CV_8UC3, cv::Scalar(10, 20, 30));
  picture.at<cv::Vec3b>(0, 5) = {1, 2, 3};
  const std::string file = folder.path("a.png");
  write_png(file, picture);
  write_png(file, picture);
  const cv::Mat back = cv::imread(file, cv::IMREAD_UNCHANGED);
  ASSERT_EQ(back.size(), picture.size());
  EXPECT_EQ(cv::norm(back, picture, cv::NORM_INF), 0);
  EXPECT_THROW(write_png(file, cv::Mat()), ConfigError);
  EXPECT_EQ(cv::imread(file).size(), picture.size()) << "the old file stays";
  fs::create_directories(folder.path("taken.png/inside"));
  EXPECT_THROW(write_png(folder.path("taken.png"), picture), ConfigError);
  try {
    write_png(folder.path("none/b.png"), picture);
    ADD_FAILURE() << "not refused";
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("b.png"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("No such file"), std::string::npos) << error.what();
  }
  for (const auto& entry : fs::directory_iterator(folder.path(".")))
    EXPECT_NE(entry.path().extension(), ".part");
}

TEST(WritePng, DoesNotFollowLinksThatSomebodyHasPlanted) {
  const test::TemporaryFolder folder;
  const std::string file = folder.path("a.png"), victim = folder.write("victim", "precious");
  for (int n = 0; n < 100; ++n)
    fs::create_symlink(victim, file + "." + std::to_string(getpid()) + "-" + std::to_string(n) + ".part");
  write_png(file, cv::Mat(4, 6, CV_8UC1, cv::Scalar(10)));
  EXPECT_EQ(test::file_bytes(victim), "precious");
  EXPECT_EQ(cv::imread(file).cols, 6);
}

TEST(WritePng, OnAFullDiskLeavesNothing) {
  const test::TemporaryFolder folder;
  cv::Mat noise(100, 100, CV_8UC3);
  cv::randu(noise, 0, 255);
  {
    const test::FullDisk disk(1000);
    EXPECT_THROW(write_png(folder.path("a.png"), noise), WriteError);
  }
  EXPECT_TRUE(fs::is_empty(folder.path(".")));
}

}  // namespace
}  // namespace desert_sim
