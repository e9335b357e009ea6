// desert_run --export: which files there are, and what is refused before the run.

#include <filesystem>

#include "src/export/export_formats.hpp"
#include "src/io/raster.hpp"
#include "test/support/run_fixture.hpp"

namespace desert_sim {
namespace {

namespace fs = std::filesystem;

class Export : public test::DesertRun {
 protected:
  void refused(const std::vector<std::string>& words, const std::string& reason) {
    std::vector<std::string> all{scenario_, "--backend", "cpu", "--quiet", "--steps", "1"};
    all.insert(all.end(), words.begin(), words.end());
    const test::ProgramRun r = run(all);
    EXPECT_EQ(r.status, 2) << r.err;
    EXPECT_NE(r.err.find(reason), std::string::npos) << r.err;
  }
  std::string small(const std::string& step) {
    return folder_.write("of_raster.yaml", "grid: {width: 8, height: 8}\nterrain: [" + step + "]\n");
  }
};

TEST_F(Export, WritesTheEndInEveryFormatOfTheTable) {
  std::vector<std::string> words{scenario_, "--steps", "3", "--out", path("out")};
  for (const ExportFormat& format : export_formats())
    words.insert(words.end(), {"--export", path("all" + std::string(format.ending))});
  run_cpu(words);
  std::size_t files = 0;
  for (const ExportFormat& format : export_formats())
    for (const std::string& file : exported_files(path("all" + std::string(format.ending)))) {
      EXPECT_GT(fs::file_size(file), 50u) << file;
      ++files;
    }
  for (const auto& entry : fs::directory_iterator(fs::path(path("all.ply")).parent_path()))
    if (entry.path().filename().string().rfind("all", 0) == 0) --files;
  EXPECT_EQ(files, 0u) << "each is named in the table, and there are no others";
  EXPECT_EQ(read_raster(path("all.exr")).values, read_raster(path("out") + "/elevation.tif").values);
}

TEST_F(Export, DoesNotChangeTheState) {
  run_cpu({scenario_, "--steps", "3", "--out", path("with"), "--export", path("a.ply")});
  run_cpu({scenario_, "--steps", "3", "--out", path("without")});
  EXPECT_EQ(hash("with"), hash("without"));
}

TEST_F(Export, OfACheckpointNeedsNoStep) {
  run_cpu({scenario_, "--steps", "3", "--checkpoint", path("a.ckpt"), "--export", path("a.stl")});
  run_cpu({"--resume", path("a.ckpt"), "--steps", "0", "--export", path("b.stl")});
  EXPECT_EQ(test::file_bytes(path("a.stl")), test::file_bytes(path("b.stl")));
}

TEST_F(Export, RefusesWhatCannotBeWrittenBeforeTheRun) {
  refused({"--export", path("a.dae")},
          "a.dae: '.dae' is not an ending that this build exports (allowed: .ply, .stl");
  refused({"--export", path("a.objj")}, "did you mean '.obj'?");
  refused({"--export", path("a")}, "a: has no ending");
  refused({"--export", path("none/a.ply")}, "none/a.ply: cannot be written");
  fs::create_directory(path("b_surface.png"));
  refused({"--export", path("b.world")}, "b_surface.png: cannot be written: is a folder");
  refused({"--export", path("c.obj"), "--export", path("c_ground.png")}, "c_ground.png: is written twice");
  refused({"--set", "grid.width=1", "--export", path("d.stl")},
          "d.stl: a terrain of 1 x 24 cells has no surface");
  for (const char* name : {"a.ply", "b.world", "b_heights.tif", "c.obj", "d.stl"})
    EXPECT_FALSE(fs::exists(path(name))) << name;
}

TEST_F(Export, DoesNotReplaceWhatTheRunReads) {
  run_cpu({scenario_, "--steps", "0", "--export", path("dem.exr")});
  const std::string before = test::file_bytes(path("dem.exr"));
  const test::ProgramRun r = run({small("raster: {layer: bedrock, file: dem.exr, stretch: true}"), "--steps",
                                  "1", "--backend", "cpu", "--export", path("dem.exr")});
  EXPECT_EQ(r.status, 2);
  EXPECT_NE(r.err.find("would replace " + path("dem.exr") + ", which the run reads"), std::string::npos)
      << r.err;
  EXPECT_EQ(test::file_bytes(path("dem.exr")), before);
}

}  // namespace
}  // namespace desert_sim
