// desert_run and rasters: georeference, orientation, what each layer's file holds. Needs GDAL.

#include <gdal_priv.h>

#include <cmath>

#include "src/io/raster.hpp"
#include "test/support/run_fixture.hpp"

namespace desert_sim {
namespace {

class Rasters : public test::DesertRun {
 protected:
  /// An ESRI ASCII grid, north row first, as on paper.
  std::string dem() {
    return folder_.write(
        "dem.asc",
        "ncols 6\nnrows 4\nxllcorner 500100.5\nyllcorner 4100200\ncellsize 10\nNODATA_value -9999\n"
        "10 11 12 13 14 90\n20 21 22 23 24 25\n30 31 32 33 34 35\n70 41 42 43 44 45\n");
  }
  std::string dem_scenario(const std::string& more = "") {
    dem();
    return folder_.write(
        "dem.yaml",
        "grid: {from_raster: dem.asc, boundary: open}\nterrain: [raster: {layer: bedrock}]\n" + more);
  }
};

TEST_F(Rasters, ElevationHasTheGeoreferenceAndOrientationOfTheInput) {
  run_cpu({dem_scenario(), "--steps", "0", "--out", path("out")});
  const Raster in = read_raster(dem()), out = read_raster(path("out") + "/elevation.tif");
  EXPECT_EQ(out.width, 6);
  EXPECT_EQ(out.height, 4);
  EXPECT_EQ(out.cell_size, in.cell_size);
  EXPECT_EQ(out.origin_x, 500100.5);
  EXPECT_EQ(out.origin_y, 4100200);
  ASSERT_EQ(out.values.size(), in.values.size());
  for (std::size_t i = 0; i < in.values.size(); ++i) EXPECT_NEAR(out.values[i], in.values[i], 1e-5);
  EXPECT_NEAR(out.values[0], 70, 1e-5) << "south-west";
  EXPECT_NEAR(out.values[23], 90, 1e-5) << "north-east";
}

TEST_F(Rasters, EveryLayerInUseHasAFileAndThereArePictures) {
  run_cpu({scenario_, "--steps", "2", "--out", path("out"), "--set",
           "terrain.2={uniform: {layer: soil, value: 1}}", "--set", "echo_dunes.enabled=true"});
  for (const char* layer :
       {"bedrock", "soil", "sand", "airborne_sand", "elevation", "wind_x", "wind_y", "wind_shadow", "echo"}) {
    const std::string file = path("out") + "/" + layer + ".tif";
    ASSERT_TRUE(std::filesystem::exists(file)) << layer;
    const Raster r = read_raster(file);
    EXPECT_EQ(r.width, 40);
    EXPECT_EQ(r.origin_x, 1000) << layer;
    EXPECT_EQ(r.origin_y, -300) << layer;
    EXPECT_EQ(r.nodata_count(), 0) << layer;
  }
  EXPECT_FALSE(std::filesystem::exists(path("out") + "/water.tif"));
  for (const char* picture : {"elevation.png", "wind.png"})
    EXPECT_GT(std::filesystem::file_size(path("out") + "/" + picture), 1000u);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(path("out")))
    EXPECT_TRUE(entry.path().extension() == ".tif" || entry.path().extension() == ".png" ||
                entry.path().extension() == ".json")
        << entry.path();
}

TEST_F(Rasters, ElevationIsTheSumOfItsLayers) {
  run_cpu({scenario_, "--steps", "3", "--out", path("out")});
  const Raster elevation = read_raster(path("out") + "/elevation.tif"),
               bedrock = read_raster(path("out") + "/bedrock.tif"),
               sand = read_raster(path("out") + "/sand.tif");
  for (std::size_t i = 0; i < elevation.values.size(); ++i)
    ASSERT_NEAR(elevation.values[i], bedrock.values[i] + sand.values[i], 1e-5);
}

TEST_F(Rasters, WindBlowsSandTheWayItSays) {
  // A heap in the middle of bare rock, wind to the north: all sand is north of it. Rock keeps what does not
  // bounce, a share of 0.4; the rest is in the air.
  const std::string file =
      folder_.write("north.yaml",
                    "grid: {width: 21, height: 41, boundary: open}\n"
                    "terrain: [column: {layer: sand, x: 10.5, y: 20.5, size_x: 1, size_y: 1, height: 1}]\n"
                    "wind: {speed: 3, direction_deg: 90}\navalanching: {enabled: false}\n");
  run_cpu({file, "--steps", "3", "--out", path("out")});
  const Raster sand = read_raster(path("out") + "/sand.tif");
  double north = 0, south = 0;
  for (int y = 0; y < 41; ++y)
    for (int x = 0; x < 21; ++x)
      (y > 20 ? north : south) += y == 20 ? 0 : sand.values[static_cast<std::size_t>(y * 21 + x)];
  EXPECT_NEAR(north, 0.4, 1e-3);
  EXPECT_EQ(south, 0);
}

TEST_F(Rasters, WrittenElevationIsReadBackAsATerrain) {
  run_cpu({scenario_, "--steps", "2", "--out", path("a")});
  const std::string file = folder_.write(
      "again.yaml", "grid: {from_raster: a/elevation.tif}\nterrain: [raster: {layer: bedrock}]\n");
  run_cpu({file, "--steps", "0", "--out", path("b")});
  const Raster a = read_raster(path("a") + "/elevation.tif"), b = read_raster(path("b") + "/elevation.tif");
  EXPECT_EQ(a.origin_x, b.origin_x);
  EXPECT_EQ(a.origin_y, b.origin_y);
  EXPECT_EQ(a.cell_size, b.cell_size);
  for (std::size_t i = 0; i < a.values.size(); ++i) ASSERT_NEAR(a.values[i], b.values[i], 2e-6 * 10);
}

TEST_F(Rasters, NoDataIsRefusedUnlessItIsToBeFilled) {
  folder_.write(
      "holes.asc",
      "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9999\n1 2 3\n4 -9999 6\n");
  const std::string text = "grid: {from_raster: holes.asc}\nterrain: [raster: {layer: bedrock, fill_nodata: ";
  const test::ProgramRun refused =
      run({folder_.write("a.yaml", text + "false}]\n"), "--backend", "cpu", "--out", path("out")});
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.err.find("holes.asc"), std::string::npos) << refused.err;
  EXPECT_FALSE(std::filesystem::exists(path("out")));
  run_cpu({folder_.write("b.yaml", text + "true}]\n"), "--steps", "0", "--out", path("out")});
  const Raster r = read_raster(path("out") + "/elevation.tif");
  EXPECT_GT(r.values[1], 1);
  EXPECT_LT(r.values[1], 6);
}

TEST_F(Rasters, AHugeSparseRasterIsRefusedByItsHeader) {
  constexpr int extent = 30000;
  GDALAllRegister();
  const char* options[] = {"SPARSE_OK=TRUE", "COMPRESS=DEFLATE", "TILED=YES", nullptr};
  GDALDatasetUniquePtr sparse(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
      path("sparse.tif").c_str(), extent, extent, 1, GDT_Float64, const_cast<char**>(options)));
  ASSERT_TRUE(sparse);
  double placement[6] = {0, 1, 0, extent, 0, -1};
  sparse->SetGeoTransform(placement);
  sparse.reset();
  ASSERT_LT(std::filesystem::file_size(path("sparse.tif")), 2u << 20);
  const test::ProgramRun refused =
      run({folder_.write("sparse.yaml", "grid: {from_raster: sparse.tif}\nterrain: [raster: {}]\n"),
           "--backend", "cpu", "--threads", "1"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.err.find("30000 x 30000 cells needs"), std::string::npos) << refused.err;
  EXPECT_LT(refused.resident_bytes, 4e8) << "the cells would take 3.6 GB";
}

TEST_F(Rasters, AHeaderThatPromisesTooMuchCostsNoMoreThanTheFile) {
  folder_.write(
      "short.asc",
      "ncols 20000\nnrows 20000\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9999.0\n1 2 3\n");
  const test::ProgramRun refused = run(
      {folder_.write("short.yaml",
                     "grid: {width: 8, height: 8, cell_size: 2500}\nterrain: [raster: {file: short.asc}]\n"),
       "--backend", "cpu", "--threads", "1"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.err.find("has 3 numbers after its header"), std::string::npos) << refused.err;
  EXPECT_LT(refused.resident_bytes, 4e8) << "the cells would take 1.6 GB";
}

TEST_F(Rasters, OtherFormatsNeedASwitch) {
  dem();
  folder_.write("dem.vrt",
                "<VRTDataset rasterXSize=\"6\" rasterYSize=\"4\"><VRTRasterBand dataType=\"Float32\" "
                "band=\"1\"><SimpleSource><SourceFilename relativeToVRT=\"1\">dem.asc</SourceFilename>"
                "<SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>");
  const std::string file =
      folder_.write("vrt.yaml", "grid: {from_raster: dem.vrt}\nterrain: [raster: {layer: bedrock}]\n");
  const test::ProgramRun refused = run({file, "--backend", "cpu"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.err.find("--all-raster-formats"), std::string::npos) << refused.err;
  run_cpu({file, "--all-raster-formats", "--steps", "0", "--out", path("out")});
  EXPECT_EQ(read_raster(path("out") + "/elevation.tif").values[0], 70);
}

TEST_F(Rasters, UndeclaredNoDataIsNamedOnTheStandardError) {
  folder_.write("sea.asc", "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3\n4 -9999 -9999\n");
  const std::string text =
      "grid: {from_raster: sea.asc}\nterrain: [raster: {layer: bedrock, fill_nodata: true";
  const test::ProgramRun warned =
      run({folder_.write("a.yaml", text + "}]\n"), "--backend", "cpu", "--steps", "0", "--quiet"});
  EXPECT_EQ(warned.status, 0);
  EXPECT_NE(warned.err.find("33.3 % of its cells (2 of 6) are -9999"), std::string::npos) << warned.err;
  const test::ProgramRun declared = run({folder_.write("b.yaml", text + ", nodata: -9999}]\n"), "--backend",
                                         "cpu", "--steps", "0", "--quiet", "--out", path("out")});
  EXPECT_EQ(declared.status, 0);
  EXPECT_EQ(declared.err, "");
  EXPECT_GT(read_raster(path("out") + "/elevation.tif").values[1], 0);
}

}  // namespace
}  // namespace desert_sim
