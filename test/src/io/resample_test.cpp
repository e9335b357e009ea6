// Resampling: ramps stay ramps, averages keep the mean, nodata has no weight, outside is NaN; holes are
// filled.

#include "src/io/resample.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "src/core/error.hpp"

namespace desert_sim {
namespace {

constexpr float nan_value = std::numeric_limits<float>::quiet_NaN();

/// Far from the coordinates' zero, as real DEMs are.
Raster blank(int width, int height, double cell_size) {
  Raster r;
  r.width = width;
  r.height = height;
  r.cell_size = cell_size;
  r.origin_x = 500000.5;
  r.origin_y = 4100000.25;
  r.values.assign(static_cast<std::size_t>(width) * height, 0);
  return r;
}

double ramp_at(double east, double north) { return 3 + 0.25 * east - 0.125 * north; }

double centre(const Raster& r, int i) { return (i + 0.5) * r.cell_size; }

/// Values of ramp_at() at the cell centres, measured from (500000.5, 4100000.25).
Raster ramp(int width, int height, double cell_size) {
  Raster r = blank(width, height, cell_size);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      r.values[static_cast<std::size_t>(y) * width + x] =
          static_cast<float>(ramp_at(centre(r, x), centre(r, y)));
  return r;
}

Raster noise(int width, int height, double cell_size) {
  Raster r = blank(width, height, cell_size);
  std::mt19937 random(7);
  for (float& v : r.values) v = std::uniform_real_distribution<float>(0, 10)(random);
  return r;
}

double mean(const Raster& r) {
  double sum = 0;
  for (float v : r.values) sum += v;
  return sum / static_cast<double>(r.values.size());
}

/// Largest difference from the ramp among cells whose centre is at least `margin` inside the source's extent.
double ramp_error(const Raster& r, double width_m, double height_m, double margin, int& counted) {
  double largest = 0;
  counted = 0;
  for (int y = 0; y < r.height; ++y)
    for (int x = 0; x < r.width; ++x) {
      const double east = r.origin_x - 500000.5 + centre(r, x),
                   north = r.origin_y - 4100000.25 + centre(r, y);
      if (east < margin || north < margin || east > width_m - margin || north > height_m - margin) continue;
      const double error =
          std::abs(r.values[static_cast<std::size_t>(y) * r.width + x] - ramp_at(east, north));
      largest = std::isnan(error) ? 1e9 : std::max(largest, error);
      ++counted;
    }
  return largest;
}

TEST(Resample, LinearRampIsExact) {
  const Raster source = ramp(40, 30, 2);  // 80 m x 60 m
  struct Case {
    Resampling method;
    double cell_size, shift, margin;
  };
  for (const Case& c : {Case{Resampling::bilinear, 0.7, 0.3, 1.1}, Case{Resampling::cubic, 0.7, 0.3, 3.1},
                        Case{Resampling::bilinear, 2, 0.9, 1.1}, Case{Resampling::average, 4, 0, 0},
                        Case{Resampling::cubic, 1, 0, 3.1}}) {
    const int width = static_cast<int>(80 / c.cell_size), height = static_cast<int>(60 / c.cell_size);
    const Raster r = resample(source, width, height, c.cell_size, source.origin_x + c.shift,
                              source.origin_y - c.shift, c.method);
    int counted = 0;
    EXPECT_LT(ramp_error(r, 80, 60, c.margin, counted), 1e-4) << "cell_size " << c.cell_size;
    EXPECT_GT(counted, width * height / 2);
  }
}

TEST(Resample, SameGridIsTheSame) {
  const Raster source = noise(17, 9, 3.3);
  for (Resampling method : {Resampling::bilinear, Resampling::cubic, Resampling::average}) {
    const Raster r = resample(source, 17, 9, 3.3, source.origin_x, source.origin_y, method);
    for (std::size_t i = 0; i < r.values.size(); ++i) EXPECT_NEAR(r.values[i], source.values[i], 1e-5);
  }
}

TEST(Resample, HalvedCellsKeepTheirValueAndSouthStaysSouth) {
  Raster source = blank(3, 2, 10);
  source.values = {4, 5, 6, 1, 2, 3};
  const Raster r = resample(source, 6, 4, 5, source.origin_x, source.origin_y, Resampling::average);
  EXPECT_EQ(r.values,
            (std::vector<float>{4, 4, 5, 5, 6, 6, 4, 4, 5, 5, 6, 6, 1, 1, 2, 2, 3, 3, 1, 1, 2, 2, 3, 3}));
  // One cell further north and east.
  const Raster moved =
      resample(source, 2, 1, 10, source.origin_x + 10, source.origin_y + 10, Resampling::average);
  EXPECT_EQ(moved.values, (std::vector<float>{2, 3}));
}

TEST(Resample, AverageKeepsTheMean) {
  const Raster source = noise(60, 48, 1);
  for (double cell_size : {2.0, 3.0, 4.0, 6.0, 12.0}) {
    const Raster r = resample(source, static_cast<int>(60 / cell_size), static_cast<int>(48 / cell_size),
                              cell_size, source.origin_x, source.origin_y, Resampling::average);
    EXPECT_NEAR(mean(r), mean(source), 1e-4) << cell_size;
  }
}

TEST(Resample, OutsideIsNaN) {
  Raster source = blank(4, 4, 1);
  std::fill(source.values.begin(), source.values.end(), 2.0F);
  for (Resampling method : {Resampling::bilinear, Resampling::cubic, Resampling::average}) {
    const Raster r = resample(source, 8, 8, 1, source.origin_x - 2, source.origin_y - 1, method);
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 8; ++x) {
        const float value = r.values[y * 8 + x];
        if (x >= 2 && x < 6 && y >= 1 && y < 5)
          EXPECT_FLOAT_EQ(value, 2) << x << ", " << y;
        else
          EXPECT_TRUE(std::isnan(value)) << x << ", " << y;
      }
    const Raster away = resample(source, 2, 2, 1, source.origin_x + 100, source.origin_y, method);
    EXPECT_EQ(away.nodata_count(), 4);
  }
}

/// A cliff of 100 m, resampled at any ratio and shift, stays between its foot and its rim.
TEST(Resample, NothingOvershootsBesideAStep) {
  Raster source = blank(20, 20, 4);
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 20; ++x) source.values[y * 20 + x] = x + y < 20 ? 0.0F : 100.0F;
  for (Resampling method : {Resampling::bilinear, Resampling::cubic, Resampling::average})
    for (double cell_size : {0.5, 1.9, 3.0, 4.0, 6.0, 13.0})
      for (double shift : {0.0, 0.7}) {
        const int cells = static_cast<int>(80 / cell_size);
        const Raster r = resample(source, cells, cells, cell_size, source.origin_x + shift,
                                  source.origin_y + shift, method);
        for (float value : r.values)
          if (!std::isnan(value)) {
            EXPECT_GE(value, 0) << cell_size;
            EXPECT_LE(value, 100) << cell_size;
          }
      }
}

TEST(Resample, ALimitedCubicIsStillSmootherThanALinearOne) {
  const auto mean_error = [](Resampling method) {
    Raster source = blank(40, 40, 2);
    const auto hill = [](double east, double north) {
      return static_cast<float>(30 * std::sin(east / 9) * std::cos(north / 11));
    };
    for (int y = 0; y < 40; ++y)
      for (int x = 0; x < 40; ++x) source.values[y * 40 + x] = hill(centre(source, x), centre(source, y));
    const Raster r = resample(source, 160, 160, 0.5, source.origin_x, source.origin_y, method);
    double sum = 0;
    for (int y = 20; y < 140; ++y)
      for (int x = 20; x < 140; ++x)
        sum += std::abs(r.values[y * 160 + x] - hill(centre(r, x), centre(r, y)));
    return sum / (120 * 120);
  };
  EXPECT_LT(mean_error(Resampling::cubic), 0.25 * mean_error(Resampling::bilinear));
}

TEST(Resample, NoDataHasNoWeight) {
  Raster source = blank(12, 12, 1);
  std::fill(source.values.begin(), source.values.end(), 5.0F);
  for (int y = 4; y < 8; ++y)
    for (int x = 4; x < 8; ++x) source.values[y * 12 + x] = nan_value;
  for (Resampling method : {Resampling::bilinear, Resampling::cubic, Resampling::average})
    for (double cell_size : {0.5, 3.0}) {
      const int cells = static_cast<int>(12 / cell_size);
      const Raster r = resample(source, cells, cells, cell_size, source.origin_x, source.origin_y, method);
      for (float value : r.values)
        if (!std::isnan(value)) {
          EXPECT_NEAR(value, 5, 1e-5);
        }
      EXPECT_FLOAT_EQ(r.values[0], 5);
      if (cell_size < 1) {
        EXPECT_GT(r.nodata_count(), 0);
      }
    }
  const Raster coarse = resample(source, 4, 4, 3, source.origin_x, source.origin_y, Resampling::average);
  EXPECT_EQ(coarse.nodata_count(), 0);  // each coarse cell has some valid cell
}

TEST(Resample, RefusesGridsWithoutCells) {
  const Raster source = ramp(4, 3, 2);
  EXPECT_THROW(resample(source, 0, 3, 1, 0, 0, Resampling::average), ConfigError);
  EXPECT_THROW(resample(source, 3, 3, 0, 0, 0, Resampling::average), ConfigError);
  EXPECT_THROW(resample(source, 3, 3, nan_value, 0, 0, Resampling::average), ConfigError);
  EXPECT_THROW(resample(source, 3, 3, 1, nan_value, 0, Resampling::average), ConfigError);
  Raster wrong = source;
  wrong.values.pop_back();
  EXPECT_THROW(resample(wrong, 3, 3, 1, 0, 0, Resampling::average), ConfigError);
}

TEST(FillNoData, FillsHolesFromAround) {
  Raster r = ramp(60, 50, 1);
  const Raster whole = r;
  for (int y = 20; y < 26; ++y)
    for (int x = 30; x < 36; ++x) r.values[y * 60 + x] = nan_value;
  r.values[0] = nan_value;
  fill_nodata(r);
  EXPECT_EQ(r.nodata_count(), 0);
  for (std::size_t i = 0; i < r.values.size(); ++i) EXPECT_NEAR(r.values[i], whole.values[i], 0.6) << i;
  EXPECT_EQ(r.values[10 * 60 + 10], whole.values[10 * 60 + 10]);
}

TEST(FillNoData, ReachesEverywhereFromOneCell) {
  Raster r = blank(300, 400, 1);
  std::fill(r.values.begin(), r.values.end(), nan_value);
  r.values[5] = 7;
  fill_nodata(r);
  for (float v : r.values) ASSERT_FLOAT_EQ(v, 7);
}

TEST(FillNoData, RefusesWhenNothingIsValid) {
  Raster r = blank(3, 2, 1);
  fill_nodata(r);  // no holes: nothing to do
  std::fill(r.values.begin(), r.values.end(), nan_value);
  EXPECT_THROW(fill_nodata(r), ConfigError);
  EXPECT_EQ(r.nodata_count(), 6);
}

}  // namespace
}  // namespace desert_sim
