// Rasters that name other files, hosts or devices; and what is read of those that may be.

#include <sys/stat.h>

#include <filesystem>

#include "src/io/raster_loader.hpp"
#include "src/simulation/session.hpp"
#include "test/support/raster_test.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

namespace fs = std::filesystem;

const char* const not_allowed = "is not a raster that may be read here (GeoTIFF,";

class RasterAccessTest : public RasterTest {
 protected:
  void SetUp() override {
    RasterTest::SetUp();
    fs::create_directory(path("data"));
    secret_ = folder_.write("secret.asc", grid_text);
  }
  RasterAccess confined() const { return {path("data"), false}; }
  /// In the data folder.
  std::string write(const std::string& name, const std::string& text) const {
    return folder_.write("data/" + name, text);
  }
  /// A service that loads the raster as a terrain; a refusal has to leave the session as it is.
  std::string session_refusal(const std::string& raster) const {
    Session session(test::parsed("grid: {width: 8, height: 8}\n"), gdal_raster_loader(confined()), "cpu", 1);
    session.confine_commands(path("data"));
    const std::uint64_t before = session.simulation().state().hash();
    std::string message;
    try {
      session.apply(command::LoadScenario{
          write("s.yaml", "grid: {from_raster: " + raster + "}\nterrain: [raster: {layer: bedrock}]\n"),
          false, 0});
    } catch (const ConfigError& e) {
      message = e.what();
    }
    EXPECT_EQ(session.simulation().state().hash(), before);
    return message;
  }

  static constexpr const char* grid_text =
      "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n3 4\n";
  std::string secret_;
};

std::string vrt(const std::string& band) {
  return "<VRTDataset rasterXSize=\"2\" rasterYSize=\"2\">" + band + "</VRTDataset>";
}

std::string vrt_with_source(const std::string& source) {
  return vrt(
      "<VRTRasterBand dataType=\"Float32\" band=\"1\"><SimpleSource><SourceFilename relativeToVRT=\"0\">" +
      source + "</SourceFilename><SourceBand>1</SourceBand></SimpleSource></VRTRasterBand>");
}

TEST_F(RasterAccessTest, AVrtReadsNothing) {
  const std::string raw =
      vrt("<VRTRasterBand dataType=\"Byte\" band=\"1\" subClass=\"VRTRawRasterBand\"><SourceFilename "
          "relativetoVRT=\"0\">/etc/passwd</SourceFilename><ImageOffset>0</ImageOffset><PixelOffset>1</"
          "PixelOffset>"
          "<LineOffset>2</LineOffset></VRTRasterBand>");
  for (const auto& [name, text] : std::vector<std::pair<std::string, std::string>>{
           {"raw.vrt", raw},
           {"source.vrt", vrt_with_source(secret_)},
           {"http.vrt", vrt_with_source("/vsicurl/http://127.0.0.1:9/a.tif")},
           {"renamed.tif", vrt_with_source(secret_)}}) {
    const std::string file = write(name, text);
    expect_says(refusal(file, {}, confined()), {name.c_str(), not_allowed});
    expect_says(refusal(file), {name.c_str(), not_allowed, "--all-raster-formats"});
    expect_says(session_refusal(name), {name.c_str(), not_allowed});
  }
  EXPECT_EQ(refusal(path("data/source.vrt"), {}, {"", true}), "") << "the switch allows it";
}

TEST_F(RasterAccessTest, AWmsFileCallsNobodyAndWritesNoCache) {
  const std::string wms =
      write("wms.xml", "<GDAL_WMS><Service name=\"TMS\"><ServerUrl>file://" + secret_ +
                           "</ServerUrl></Service><DataWindow><SizeX>2</SizeX><SizeY>2"
                           "</SizeY></DataWindow><BandsCount>1</BandsCount><Cache><Path>" +
                           path("cache") + "</Path></Cache></GDAL_WMS>");
  expect_says(refusal(wms, {}, confined()), {"wms.xml", not_allowed});
  expect_says(session_refusal("wms.xml"), {"wms.xml", not_allowed});
  EXPECT_FALSE(fs::exists(path("cache")));
}

TEST_F(RasterAccessTest, APdsLabelReadsNoOtherFile) {
  const std::string label =
      write("label.lbl",
            "PDS_VERSION_ID = PDS3\nRECORD_TYPE = FIXED_LENGTH\nRECORD_BYTES = 4\n"
            "^IMAGE = (\"../secret.asc\", 1)\nOBJECT = IMAGE\nLINES = 2\nLINE_SAMPLES = 2\n"
            "SAMPLE_TYPE = UNSIGNED_INTEGER\nSAMPLE_BITS = 8\nEND_OBJECT = IMAGE\nEND\n");
  expect_says(refusal(label, {}, confined()), {"label.lbl", not_allowed});
  expect_says(session_refusal("label.lbl"), {"label.lbl", not_allowed});
}

TEST_F(RasterAccessTest, NamesOfGdalsFileSystemsAreNoFiles) {
  for (const std::string& name : {std::string("/vsicurl/http://127.0.0.1:9/a.tif"), "/vsizip/" + secret_,
                                  "GTIFF_DIR:1:" + secret_, "/vsisubfile/0_10," + secret_}) {
    EXPECT_NE(refusal(name), "") << name;
    EXPECT_NE(refusal(name, {}, confined()), "") << name;
  }
}

TEST_F(RasterAccessTest, CompanionsAreReadInTheFolderOnly) {
  const float values[] = {1, 2, 3, 4};
  const std::string raw(reinterpret_cast<const char*>(values), sizeof values);
  const std::string header =
      "ENVI\nsamples = 2\nlines = 2\nbands = 1\nheader offset = 0\ndata type = 4\ninterleave = bsq\n"
      "byte order = 0\n";
  write("a.img", raw);
  write("a.hdr", header);
  EXPECT_EQ(refusal(path("data/a.img"), {}, confined()), "");
  write("b.img", raw);
  folder_.write("b.hdr", header);
  fs::create_symlink(path("b.hdr"), path("data/b.hdr"));
  expect_says(refusal(path("data/b.img"), {}, confined()), {"b.hdr", "is not below"});
  EXPECT_EQ(refusal(path("data/b.img")), "") << "links are followed where there is no folder";
}

TEST_F(RasterAccessTest, AWorldFileAndAProjectionBelongToARaster) {
  make("data/a.png", "PNG", 2, 2, GDT_Byte, std::vector<std::uint8_t>{1, 2, 3, 4});
  fs::remove(path("data/a.png.aux.xml"));
  write("a.pgw", "10\n0\n0\n-10\n105\n215\n");
  const Raster png = read_raster(path("data/a.png"), {}, confined());
  EXPECT_EQ(png.cell_size, 10);
  EXPECT_EQ(png.origin_x, 100);
  EXPECT_EQ(png.origin_y, 200);
  OGRSpatialReference utm;
  utm.importFromEPSG(32613);
  char* wkt = nullptr;
  utm.exportToWkt(&wkt);
  write("b.asc", grid_text);
  write("b.prj", wkt);
  CPLFree(wkt);
  EXPECT_NE(read_raster(path("data/b.asc"), {}, confined()).projection.find("13N"), std::string::npos);
}

TEST_F(RasterAccessTest, OtherFilesOutsideTheFolderAreRefused) {
  expect_says(refusal(secret_, {}, confined()), {"secret.asc", "is not below"});
  expect_says(session_refusal("../secret.asc"), {"secret.asc", "is not below"});
  expect_says(session_refusal(secret_), {"secret.asc", "is not below"});
  fs::create_symlink(secret_, path("data/link.asc"));
  expect_says(session_refusal("link.asc"), {"link.asc", "is not below"});
  write("inside.asc", grid_text);
  EXPECT_EQ(refusal(path("data/inside.asc"), {}, confined()), "");
}

/// Nobody writes to the FIFOs: opening one of them would take for ever.
TEST_F(RasterAccessTest, AFifoIsRefusedAtOnce) {
  for (const char* name : {"a.tif", "a.exr", "a.asc"}) {
    ASSERT_EQ(mkfifo(path(std::string("data/") + name).c_str(), 0600), 0);
    const std::string file = path(std::string("data/") + name);
    expect_says(refusal(file), {name, "is not a regular file"});
    expect_says(refusal(file, {}, confined()), {name, "is not a regular file"});
    if (std::string(name) != "a.exr")
      expect_says(refusal(file, {}, {"", true}), {name, "is not a regular file"});
  }
}

TEST_F(RasterAccessTest, ARasterLargerThanTheLargestGridIsRefusedByItsHeader) {
  const std::string file = make("data/long.tif", "GTiff", 70000, 1, GDT_Byte,
                                std::vector<std::uint8_t>(70000, 1), {0, 1, 0, 1, 0, -1});
  expect_says(session_refusal("long.tif"), {"grid.width", "70000 cells", "[1, 65536]", "grid.cell_size"});
}

TEST_F(RasterAccessTest, OnlyTheWindowThatTheGridCoversIsRead) {
  // The far half of this file cannot be read, because it is missing.
  std::vector<float> values(400 * 400);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i % 97);
  const std::string file = make("data/a.tif", "GTiff", 400, 400, GDT_Float32, values, {0, 1, 0, 400, 0, -1});
  const RasterField whole =
      gdal_raster_loader()({file, 1, 1, 0, {}, false, false, 50, 40, 1, 20.0, 340, false});
  fs::resize_file(file, fs::file_size(file) / 2);
  EXPECT_NE(refusal(file), "");
  const RasterField north =
      gdal_raster_loader()({file, 1, 1, 0, {}, false, false, 50, 40, 1, 20.0, 340, false});
  EXPECT_EQ(north.values, whole.values);
  EXPECT_EQ(north.values[0], static_cast<float>((59 * 400 + 20) % 97)) << "south-west corner";
  EXPECT_THROW(gdal_raster_loader()({file, 1, 1, 0, {}, false, false, 50, 40, 1, 20.0, 0, false}),
               ConfigError);
}

}  // namespace
}  // namespace desert_sim
