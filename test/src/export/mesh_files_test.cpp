// Meshes in files: read again, they have the heights of the terrain, the right side upwards, and its colours.

#include "src/export/mesh_files.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <utility>

#include "src/core/error.hpp"
#include "src/export/export_formats.hpp"
#include "src/render/terrain_colours.hpp"
#include "test/src/export/exported.hpp"
#include "test/support/full_disk.hpp"

namespace export_test {
namespace {

class MeshFiles : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder_.path(name); }
  test::TemporaryFolder folder_;
  std::shared_ptr<Snapshot> snapshot_ = dunes(9, 6);
};

std::size_t kinds_of(const std::vector<Triple>& colours) {
  std::vector<Triple> kinds = colours;
  std::sort(kinds.begin(), kinds.end());
  return static_cast<std::size_t>(std::unique(kinds.begin(), kinds.end()) - kinds.begin());
}

/// The vertex of a cell, by its place.
std::size_t vertex_of(const ReadMesh& mesh, const Snapshot& s, int x, int y) {
  for (std::size_t n = 0; n < mesh.vertices.size(); ++n)
    if (std::abs(mesh.vertices[n][0] - (x + 0.5) * s.cell_size) < 0.01 &&
        std::abs(mesh.vertices[n][1] - (y + 0.5) * s.cell_size) < 0.01)
      return n;
  ADD_FAILURE() << "no vertex of the cell " << x << ", " << y;
  return 0;
}

TEST_F(MeshFiles, PlyHasTheGroundAndItsColoursThroughWater) {
  write_ply(path("a.ply"), terrain_of(snapshot_));
  const ReadMesh mesh = read_ply(path("a.ply"));
  expect_ground(mesh, *snapshot_);
  EXPECT_GT(kinds_of(mesh.colours), 2u);
  const Triple dry = mesh.colours[vertex_of(mesh, *snapshot_, 5, 0)],
               wet = mesh.colours[vertex_of(mesh, *snapshot_, 5, 4)];
  EXPECT_GT(dry[0], dry[2]) << "sand is yellow";
  EXPECT_GT(wet[2], wet[0]) << "water is blue";
}

TEST_F(MeshFiles, StlHasTheGroundWithTheNormalsOfItsTriangles) {
  std::vector<Triple> normals;
  write_stl(path("a.stl"), terrain_of(snapshot_));
  const ReadMesh mesh = read_stl(path("a.stl"), normals);
  expect_ground(mesh, *snapshot_);
  for (std::size_t n = 0; n < normals.size(); ++n) {
    const Triple& a = mesh.vertices[3 * n];
    for (std::size_t corner = 1; corner < 3; ++corner) {
      const Triple& b = mesh.vertices[3 * n + corner];
      double along = 0;
      for (std::size_t i = 0; i < 3; ++i) along += normals[n][i] * (b[i] - a[i]);
      EXPECT_NEAR(along, 0, 1e-5);
    }
    EXPECT_GT(normals[n][2], 0);
  }
}

TEST_F(MeshFiles, ObjHasGroupsMaterialsAndAPictureOfTheGround) {
  write_obj(path("a.obj"), terrain_of(snapshot_));
  std::map<std::string, ObjGroup> groups = read_obj(path("a.obj"));
  ASSERT_EQ(groups.count("ground"), 1u);
  ASSERT_EQ(groups.count("water"), 1u);
  EXPECT_EQ(groups.count("plants"), 0u) << "it has none";
  const ObjGroup& ground = groups["ground"];
  expect_ground(ground.mesh, *snapshot_);
  const std::string materials = test::file_bytes(path("a.mtl"));
  EXPECT_NE(test::file_bytes(path("a.obj")).find("mtllib a.mtl\n"), std::string::npos);
  EXPECT_NE(materials.find("map_Kd a_ground.png\n"), std::string::npos);
  for (const auto& [name, group] : groups)
    EXPECT_NE(materials.find("newmtl " + group.material + "\n"), std::string::npos) << name;

  // A vertex and its place in the picture have one colour; v goes up from the lower edge of the picture.
  const cv::Mat picture = cv::imread(path("a_ground.png"), cv::IMREAD_COLOR);
  ASSERT_EQ(picture.cols, 9);
  ASSERT_EQ(picture.rows, 6);
  EXPECT_GT(kinds_of(ground.mesh.colours), 2u);
  ASSERT_EQ(ground.places.size(), ground.mesh.vertices.size());
  for (std::size_t n = 0; n < ground.places.size(); ++n) {
    const auto pixel = picture.at<cv::Vec3b>(static_cast<int>(6 - 6 * ground.places[n][1]),
                                             static_cast<int>(9 * ground.places[n][0]));
    for (std::size_t channel = 0; channel < 3; ++channel)
      EXPECT_NEAR(ground.mesh.colours[n][channel] * 255, pixel[2 - static_cast<int>(channel)], 0.02) << n;
  }
}

TEST_F(MeshFiles, ObjHasTheWaterLevelWithItsShore) {
  write_obj(path("a.obj"), terrain_of(snapshot_));
  const ReadMesh water = read_obj(path("a.obj"))["water"].mesh;
  ASSERT_FALSE(water.faces.empty());
  const double z = water.vertices[vertex_of(water, *snapshot_, 4, 4)][2];
  EXPECT_NEAR(z, elevation(*snapshot_, 4, 4) + 0.5f, 1e-6);
  for (const Triple& v : water.vertices) EXPECT_GT(v[0], 2) << "west of x = 1 no cell is beside water";
  for (const auto& face : water.faces) EXPECT_GT(area_from_above(water, face), 0);
}

TEST_F(MeshFiles, AreAsTheyWereWhereTheyCannotBeWritten) {
  std::filesystem::create_directory(path("a_ground.png"));
  folder_.write("a.obj", "an older one");
  EXPECT_THROW(write_obj(path("a.obj"), terrain_of(snapshot_)), ConfigError);
  EXPECT_EQ(test::file_bytes(path("a.obj")), "an older one");
  EXPECT_THROW(write_ply(path("none/a.ply"), terrain_of(snapshot_)), ConfigError);
}

TEST_F(MeshFiles, AreAsTheyWereOnAFullDisk) {
  const auto large = terrain_of(dunes(100, 100));
  for (const ExportFormat& format : export_formats()) {
    const std::string name = "a" + std::string(format.ending);
    folder_.write(name, "an older one");
    const test::FullDisk full(1 << 12);
    EXPECT_THROW(export_terrain(path(name), large), WriteError) << name;
    EXPECT_EQ(test::file_bytes(path(name)), "an older one");
  }
}

TEST_F(MeshFiles, AreAsTheyWereWhereTheyAreInterrupted) {
  auto large = terrain_of(dunes(100, 100));
  int pieces = 0;
  large.after_piece = [&pieces] {
    ++pieces;
    throw ConfigError("enough");
  };
  for (const ExportFormat& format : export_formats()) {
    const std::string ending = format.ending, name = "a" + ending;
    if (ending == ".exr" || ending == ".png" || ending == ".world") continue;  // which are pictures
    folder_.write(name, "an older one");
    EXPECT_THROW(export_terrain(path(name), large), ConfigError) << name;
    EXPECT_EQ(test::file_bytes(path(name)), "an older one");
    EXPECT_EQ(std::exchange(pieces, 0), 1) << name;
  }
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path("")))
    EXPECT_NE(entry.path().extension(), ".part") << entry.path();
}

TEST_F(MeshFiles, NeedASurface) {
  EXPECT_THROW(write_ply(path("a.ply"), terrain_of(dunes(5, 1))), ConfigError);
  EXPECT_FALSE(std::filesystem::exists(path("a.ply")));
  write_ply(path("a.ply"), terrain_of(dunes(2, 2)));
  EXPECT_EQ(read_ply(path("a.ply")).faces.size(), 2u);
}

TEST_F(MeshFiles, OfALargeTerrainAreOneMeshWithoutSeams) {
  const auto large = dunes(300, 170);
  write_ply(path("a.ply"), terrain_of(large));
  const ReadMesh mesh = read_ply(path("a.ply"));
  EXPECT_EQ(mesh.vertices.size(), 300u * 170u);
  expect_ground(mesh, *large);
}

#if DESERT_WITH_TINYGLTF
TEST_F(MeshFiles, GlbHasYUpwardsAndBoxes) {
  write_glb(path("a.glb"), terrain_of(snapshot_));
  std::map<std::string, GlbMesh> meshes = read_glb(path("a.glb"));
  ASSERT_EQ(meshes.count("ground"), 1u);
  ASSERT_EQ(meshes.count("water"), 1u);
  const GlbMesh& ground = meshes["ground"];
  expect_ground(ground.mesh, *snapshot_);
  const std::vector<float>& heights = *snapshot_->find(Layer::elevation);
  const auto range = std::minmax_element(heights.begin(), heights.end());
  EXPECT_EQ(ground.low, (Triple{1, *range.first, -11})) << "x, y up, z south";
  EXPECT_EQ(ground.high, (Triple{17, *range.second, -1}));
  EXPECT_GT(kinds_of(ground.mesh.colours), 2u);
  EXPECT_EQ(meshes["water"].material["alphaMode"], "BLEND");
  EXPECT_EQ(ground.material.count("alphaMode"), 0u) << "opaque";
}

TEST_F(MeshFiles, GlbHasLinearColours) {
  for (float& depth : snapshot_->layers[Layer::sand]) depth = 1;
  write_glb(path("a.glb"), terrain_of(snapshot_));
  const ReadMesh ground = read_glb(path("a.glb"))["ground"].mesh;
  for (const Triple& colour : ground.colours)
    EXPECT_NEAR(colour[0] / 65535, 0.701, 0.001) << "0.855 of a display's red";
}

TEST_F(MeshFiles, GlbAndObjHaveThePlants) {
  auto plants = std::make_shared<PlantList>();
  plants->species.emplace_back();
  plants->plants.push_back({7.0f, 5.0f, 4.0f, 1.5f, 0, 255});
  write_glb(path("a.glb"), {snapshot_, plants});
  write_obj(path("a.obj"), {snapshot_, plants});
  const ReadMesh meshes[] = {read_glb(path("a.glb"))["plants"].mesh, read_obj(path("a.obj"))["plants"].mesh};
  for (const ReadMesh& mesh : meshes) {
    ASSERT_FALSE(mesh.faces.empty());
    for (const Triple& v : mesh.vertices) {
      EXPECT_LE(std::hypot(v[0] - 7, v[1] - 5), 1.5 + 1e-5);
      EXPECT_GE(v[2], 4 - 1e-5);
    }
  }
}
#endif

}  // namespace
}  // namespace export_test
