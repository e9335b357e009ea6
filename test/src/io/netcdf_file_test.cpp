// desert_run --format netcdf, read back by this package and, where it is installed, by xarray.

#include "src/io/netcdf_file.hpp"

#include <gdal_priv.h>

#include <cmath>
#include <memory>

#include "src/core/error.hpp"
#include "src/io/raster.hpp"
#include "test/support/refusal.hpp"
#include "test/support/run_fixture.hpp"

namespace desert_sim {
namespace {

class Netcdf : public test::DesertRun {
 protected:
  /// The status of a Python program on the file; 42 if a module of it is missing.
  int python(const std::string& body, const std::string& file) const {
    const std::string script = folder_.write(
        "look.py",
        "import sys\ntry:\n    import netCDF4, xarray, numpy\nexcept ImportError:\n    sys.exit(42)\n" +
            body);
    return test::run_program("/usr/bin/python3", {script, file}).status;
  }
};

TEST_F(Netcdf, HasTheStartEveryNthStepAndTheEnd) {
  run_cpu({scenario_, "--steps", "10", "--every", "4", "--out", path("out"), "--format", "netcdf"});
  run_cpu({scenario_, "--steps", "8", "--out", path("eight")});
  const NetcdfReader file(path("out") + "/terrain.nc");
  EXPECT_EQ(file.times(), (std::vector<double>{0, 4, 8, 10}));
  EXPECT_EQ(file.width(), 40);
  EXPECT_EQ(file.height(), 24);
  EXPECT_EQ(file.cell_size(), 2);
  EXPECT_EQ(file.origin_x(), 1000);
  EXPECT_EQ(file.origin_y(), -300);
  EXPECT_TRUE(file.periodic());
  for (const char* layer : {"elevation", "sand", "wind_x"})
    EXPECT_EQ(file.read(layer, 2), read_raster(path("eight") + "/" + layer + ".tif").values) << layer;
  EXPECT_FALSE(std::filesystem::exists(path("out") + "/elevation.tif"));
  EXPECT_FALSE(std::filesystem::exists(path("out") + "/step_00000004"));
  EXPECT_TRUE(std::filesystem::exists(path("out") + "/summary.json"));
}

TEST_F(Netcdf, ATimeThatIsNotFiniteIsRefused) {
  run_cpu({scenario_, "--steps", "10", "--every", "4", "--out", path("out"), "--format", "netcdf"});
  std::string bytes = test::file_bytes(path("out") + "/terrain.nc");
  const double ten = 10, infinite = INFINITY;
  const std::size_t at = bytes.find(std::string(reinterpret_cast<const char*>(&ten), sizeof ten));
  ASSERT_NE(at, std::string::npos);
  bytes.replace(at, sizeof infinite, reinterpret_cast<const char*>(&infinite), sizeof infinite);
  const std::string file = folder_.write("changed.nc", bytes);
  EXPECT_NE(
      test::refusal([&] { NetcdfReader reader(file); }).find("the time inf, number 4 of 4, is not finite"),
      std::string::npos);
}

TEST_F(Netcdf, IsReadByXarray) {
  folder_.write("wind.csv", "time,speed,direction\n2001-03-04T15:00,6,30\n");
  run_cpu({scenario_, "--steps", "6", "--every", "3", "--out", path("out"), "--format", "netcdf", "--set",
           "wind.regime=series", "--set", "wind.series_file=" + path("wind.csv"), "--set",
           "saltation.flux=true"});
  const int status = python(
      "d = xarray.open_dataset(sys.argv[1])\n"
      "assert d.sizes == {'time': 3, 'y': 24, 'x': 40}, d.sizes\n"
      "assert d.time.values[1] == numpy.datetime64('2001-03-04T15:00:03'), d.time\n"
      "assert d.x.values[0] == 1001 and d.y.values[0] == -299, (d.x, d.y)\n"
      "assert d.elevation.attrs['standard_name'] == 'surface_altitude' and d.elevation.units == 'm'\n"
      "assert d.flux_x.units == 'm^2/s' and float(d.flux_x[2].max()) > 0\n"
      "assert d.sand.dtype == 'float32' and not d.sand.isnull().any()\n"
      "n = netCDF4.Dataset(sys.argv[1])\n"
      "assert n.Conventions == 'CF-1.8' and n['sand'].filters()['complevel'] == 4\n"
      "assert n['sand'].chunking() == [1, 24, 40], n['sand'].chunking()\n",
      path("out") + "/terrain.nc");
  if (status == 42) GTEST_SKIP() << "python3-xarray or python3-netcdf4 is not installed";
  EXPECT_EQ(status, 0);
}

TEST_F(Netcdf, IsReadWhileItIsWritten) {
  Snapshot s;
  s.width = 3;
  s.height = 2;
  s.layers[Layer::sand] = {1, 2, 3, 4, 5, 6};
  NetcdfWriter writer(path("live.nc"), {"live", "", {}}, s);
  for (const int n : {1, 2, 3}) {
    s.time = n;
    s.step = static_cast<std::uint64_t>(n);
    writer.add(s);
    const int status =
        python("n = netCDF4.Dataset(sys.argv[1])\nassert len(n['time']) == " + std::to_string(n) +
                   " and float(n['sand'][-1, 1, 2]) == 6, n\n",
               path("live.nc"));
    if (status == 42) GTEST_SKIP() << "python3-xarray or python3-netcdf4 is not installed";
    EXPECT_EQ(status, 0) << n;
  }
}

TEST_F(Netcdf, LayersThatComeIntoUseLaterWereNotThereBefore) {
  Snapshot s;
  s.width = 3;
  s.height = 2;
  s.layers[Layer::sand] = {1, 2, 3, 4, 5, 6};
  {
    NetcdfWriter file(path("a.nc"), {"test", "", {}}, s);
    file.add(s);
    s.time = 5;
    s.layers[Layer::water] = {0, 0, 0, 0, 0, 7};
    file.add(s);
    s.width = 2;
    EXPECT_NE(test::refusal([&] { file.add(s); }).find("3 x 2"), std::string::npos);
  }
  const NetcdfReader file(path("a.nc"));
  EXPECT_TRUE(std::isnan(file.read("water", 0).at(5)));
  EXPECT_EQ(file.read("water", 1).at(5), 7);
  EXPECT_EQ(file.read("sand", 1).at(3), 4) << "the first cell of the northern row";
  EXPECT_NE(test::refusal([&] { file.read("soil", 0); }).find("soil"), std::string::npos);
}

/// By GDAL, as QGIS reads it: place, north up, and the reference system.
TEST_F(Netcdf, IsReadByGdal) {
  const std::string utm =
      "PROJCS[\"WGS 84 / UTM zone 29N\",GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS "
      "84\",6378137,298.257223563]],PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]],PROJECTION["
      "\"Transverse_Mercator\"],PARAMETER[\"latitude_of_origin\",0],PARAMETER[\"central_meridian\",-9],"
      "PARAMETER[\"scale_factor\",0.9996],PARAMETER[\"false_easting\",500000],PARAMETER[\"false_northing\",0]"
      ",UNIT[\"metre\",1]]";
  Snapshot s;
  s.width = 3;
  s.height = 2;
  s.cell_size = 10;
  s.origin_x = 500100;
  s.origin_y = 4100200;
  s.layers[Layer::sand] = {1, 2, 3, 4, 5, 6};
  NetcdfWriter(path("a.nc"), {"test", utm, {}}, s).add(s);
  GDALAllRegister();
  if (!GetGDALDriverManager()->GetDriverByName("netCDF")) GTEST_SKIP() << "GDAL was built without NetCDF";
  const std::unique_ptr<GDALDataset> file(
      GDALDataset::Open(("NETCDF:\"" + path("a.nc") + "\":sand").c_str(), GDAL_OF_RASTER));
  ASSERT_TRUE(file);
  double transform[6];
  ASSERT_EQ(file->GetGeoTransform(transform), CE_None);
  const double expected[6] = {500100, 10, 0, 4100220, 0, -10};
  for (int n = 0; n < 6; ++n) EXPECT_NEAR(transform[n], expected[n], 1e-9) << n;
  float north_west = 0;
  ASSERT_EQ(file->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, 1, 1, &north_west, 1, 1, GDT_Float32, 0, 0),
            CE_None);
  EXPECT_EQ(north_west, 4);
  ASSERT_TRUE(file->GetSpatialRef());
  EXPECT_EQ(file->GetSpatialRef()->GetUTMZone(), 29);
}

TEST_F(Netcdf, RefusesWhatItCannotWriteOrRead) {
  EXPECT_EQ(run({scenario_, "--out", path("out"), "--format", "hdf"}).status, 2);
  EXPECT_EQ(run({scenario_, "--format", "netcdf"}).status, 2);
  EXPECT_FALSE(test::refusal([&] { NetcdfReader file(scenario_); }).empty());
  EXPECT_FALSE(test::refusal([&] { NetcdfReader file(path("none.nc")); }).empty());
}

}  // namespace
}  // namespace desert_sim
