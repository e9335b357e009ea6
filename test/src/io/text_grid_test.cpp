// Grids in text have as many numbers as their header says, and nothing but numbers.

#include "src/io/text_grid.hpp"

#include "test/support/raster_test.hpp"

namespace desert_sim {
namespace {

class TextGrid : public RasterTest {
 protected:
  std::string grid(const std::string& cells, const std::string& nodata = "NODATA_value -9999\n") const {
    return folder_.write("grid.asc",
                         "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n" + nodata + cells);
  }
};

TEST_F(TextGrid, NumbersOfEverySortAreRead) {
  for (const char* cells :
       {"1 2 3\n4 5 6\n", "1 2 3 4 5 6\n", "1\n2\n3\r\n4\t5 6\n\n", "1,5 -2.5e1 +3\n.5 5. 6\n"})
    EXPECT_EQ(read_raster(grid(cells)).values.size(), 6U) << cells;
  EXPECT_FLOAT_EQ(read_raster(grid("1,5 2 3\n4 5 6\n")).values[3], 1.5F) << "a decimal comma";
  EXPECT_EQ(read_raster(grid("1.0 2 3\n4 nan 6\n", "nodata_value nan\n")).nodata_count(), 1);
  EXPECT_EQ(read_raster(grid("1 2 3\n4 5 6\n", "")).values[0], 4) << "nodata need not be declared";
}

TEST_F(TextGrid, WhatIsNoNumberIsNamedWithItsLine) {
  for (const char* word : {"abc", "NA", "****", "1.2.3", "12;5", "1e"})
    expect_says(refusal(grid(std::string("1 2 3\n4 ") + word + " 6\n")),
                {"grid.asc", "line 8: ", word, "is not a number"});
}

/// GDAL looks at the first hundred kilobytes, and takes 0 for nan among whole numbers.
TEST_F(TextGrid, AGridOfWholeNumbersHasNoOthers) {
  expect_says(refusal(grid("1 2 3\n4 nan 6\n")), {"line 8: 'nan' is no whole number", "decimal point"});
  EXPECT_EQ(read_raster(grid("-1 +2 3\n4 5 6\n")).values[3], -1);
}

TEST_F(TextGrid, AsManyAreNeededAsTheHeaderSays) {
  expect_says(refusal(grid("1 2 3 4\n5 6 7 8\n")), {"has 8 numbers", "3 columns and 2 rows: 6"});
  expect_says(refusal(grid("1 2 3\n4 5 6\n7 8 9\n")), {"has 9 numbers"});
  expect_says(refusal(grid("1 2 3\n4 5\n")), {"has 5 numbers"});
}

}  // namespace
}  // namespace desert_sim
