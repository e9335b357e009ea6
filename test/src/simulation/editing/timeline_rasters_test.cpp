// Rasters that the commands of a timeline name: they act as the patch that they hold, and stay in what is
// saved.

#include "src/simulation/editing/timeline_rasters.hpp"

#include "src/simulation/session.hpp"
#include "test/support/refusal.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

/// 3 × 2 cells; the southern row is 1, 2, 3.
RasterField stamp(const RasterRequest& request) {
  if (request.path.find("stamp") == std::string::npos) throw ConfigError(request.path + ": there is none");
  RasterField field;
  field.width = 3;
  field.height = 2;
  if (request.path.find("large") != std::string::npos) field.width = 800, field.height = 900;
  if (request.width == 0) return field;
  field.values.assign(static_cast<std::size_t>(field.width) * static_cast<std::size_t>(field.height), 6);
  for (int n = 0; n < 3; ++n) field.values[static_cast<std::size_t>(n)] = static_cast<float>(n + 1);
  return field;
}

std::string world(const std::string& entry) {
  return "grid: {width: 40, height: 32}\nterrain: [uniform: {layer: sand, value: 2}]\nwind: {speed: 6}\n"
         "run:\n  timeline:\n    - {time: 2, command: edit_terrain, shape: patch, x: 20, y: 16, radius: 9, "
         "radius_y: 6, value: 0.5" +
         entry + "}\n";
}

std::uint64_t hash_after(Session& session, int steps) {
  for (int n = 0; n < steps; ++n) session.step();
  return session.simulation().state().hash();
}

/// A session without a timeline, to which somebody gives the patch before its third step.
std::uint64_t hash_with(const command::Patch& patch, PatchUse use) {
  Scenario plain = test::parsed(world(""));
  plain.timeline.clear();
  Session session(plain, no_raster_loader, "cpu", 1);
  hash_after(session, 2);
  command::EditTerrain edit;
  edit.shape = BrushShape::patch;
  edit.x = 20, edit.y = 16, edit.radius = 9, edit.radius_y = 6, edit.value = 0.5;
  edit.patch_use = use;
  edit.patch = patch;
  session.apply(edit);
  return hash_after(session, 3);
}

TEST(TimelineRasters, ActAsThePatchThatTheyHold) {
  Session heights(test::parsed(world(", image_file: stamp.tif, image_scale: 0.25")), stamp, "cpu", 1);
  EXPECT_EQ(hash_after(heights, 5),
            hash_with({3, 2, {1.5f, 1.5f, 1.5f, 0.25f, 0.5f, 0.75f}}, PatchUse::heights));
  Session unscaled(test::parsed(world(", image_file: stamp.tif")), stamp, "cpu", 1);
  EXPECT_EQ(hash_after(unscaled, 5), hash_with({3, 2, {6, 6, 6, 1, 2, 3}}, PatchUse::heights));
  Session mask(test::parsed(world(", image_file: stamp.tif, patch_use: mask")), stamp, "cpu", 1);
  EXPECT_EQ(hash_after(mask, 5), hash_with({3, 2, {1, 1, 1, 0, 0.2f, 0.4f}}, PatchUse::mask));
}

/// What is saved before the edit is due runs without the file; a scenario that is loaded reads it, too.
TEST(TimelineRasters, AreKeptInSavedScenarios) {
  Session session(test::parsed(world(", image_file: stamp.tif")), stamp, "cpu", 1);
  const std::string saved = dump_scenario(session.simulation().scenario());
  EXPECT_EQ(saved.find("image_file"), std::string::npos);
  Session other(test::parsed(saved), no_raster_loader, "cpu", 1);
  EXPECT_EQ(hash_after(other, 5), hash_after(session, 5));
  Session loads(test::parsed("{}"), stamp, "cpu", 1);
  command::LoadScenario load;
  load.path = "scene.yaml";
  load.yaml = world(", image_file: stamp.tif");
  loads.apply(load);
  EXPECT_EQ(hash_after(loads, 5), session.simulation().state().hash());
}

TEST(TimelineRasters, AreAmongWhatTheScenarioReads) {
  const Scenario s = test::parsed(world(", image_file: /data/stamp.tif"));
  EXPECT_EQ(raster_paths(s), std::vector<std::string>{"/data/stamp.tif"});
}

TEST(TimelineRasters, ThatCannotBeAreRefusedWithTheirEntry) {
  const auto refused = [](const std::string& entry, const std::string& what) {
    const std::string reason = test::refusal([&] { Session(test::parsed(world(entry)), stamp, "cpu", 1); });
    EXPECT_NE(reason.find("run.timeline.0 (at 2 s): "), std::string::npos) << reason;
    EXPECT_NE(reason.find(what), std::string::npos) << reason;
  };
  refused(", image_file: nothing.tif", "nothing.tif: there is none");
  refused(", image_file: [stamp]", "image_file: a list is not the name of a file");
  refused(", image_file: stamp, image_scale: .nan", "image_scale: .nan is not a finite number");
  refused(", image_file: stamp, image_scale: 2, patch_use: mask", "a mask does not use it");
  refused(", image_file: stamp, patch: AAAA", "beside `patch`");
  refused(", image_scale: 2", "image_scale: unknown key");
  const std::string two = world(", image_file: large_stamp") +
                          "    - {time: 3, command: edit_terrain, shape: patch, image_file: large_stamp}\n";
  EXPECT_NE(
      test::refusal([&] {
        Session(test::parsed(two), stamp, "cpu", 1);
      }).find("run.timeline.1 (at 3 s): image_file: the rasters of the timeline have more than 1048576"),
      std::string::npos);
}

}  // namespace
}  // namespace desert_sim
