// The panel's tabs for parameters, species and new scenes: what is typed reaches the node, and what it
// refuses is shown.

#include "src/rviz/scene_lists.hpp"
#include "test/src/rviz/panel_fixture.hpp"

namespace rviz_test {
namespace {

class Authoring : public Panel {};

TEST_F(Authoring, AnyLiveParameterIsSetWithinItsRangeAndReset) {
  window_->show_tab(physics);
  ASSERT_TRUE(window_->run_until([&] { return list("physics_section")->findText("saltation") >= 0; }));
  EXPECT_LT(list("physics_section")->findText("publishers"), 0) << "which are no physics";
  list("physics_section")->setCurrentText("saltation");
  EXPECT_NE(window_->find<QLineEdit>("physics_saltation.lift")->toolTip().indexOf("0 … 10 m/s"), -1)
      << window_->find<QLineEdit>("physics_saltation.lift")->toolTip().toStdString();
  const auto start = scenario()["saltation"]["lift"].as<double>();
  window_->type("physics_saltation.lift", "0.35");
  EXPECT_TRUE(scenario_has([](const YAML::Node& s) { return s["saltation"]["lift"].as<float>() == 0.35f; }));
  window_->save("panel_physics", 900);
  window_->type("physics_saltation.lift", "-1");
  EXPECT_TRUE(refuses("physics_error", "saltation.lift: -1 is not in [0, 10]"));
  auto* const flux = window_->find<QAbstractButton>("physics_saltation.flux");
  QTest::mouseClick(flux, Qt::LeftButton, {}, QPoint(8, flux->height() / 2));
  EXPECT_TRUE(scenario_has([](const YAML::Node& s) { return s["saltation"]["flux"].as<bool>(); }));
  window_->click("reset_section");
  EXPECT_TRUE(scenario_has([&](const YAML::Node& s) {
    return s["saltation"]["lift"].as<double>() == start && !s["saltation"]["flux"].as<bool>();
  }));
  EXPECT_TRUE(window_->run_until([&] {
    return window_->find<QLineEdit>("physics_saltation.lift")->text().toDouble() == start;
  })) << "what the node has is shown";
}

TEST_F(Authoring, ParametersAreFoundInAllSections) {
  window_->show_tab(physics);
  ASSERT_TRUE(window_->run_until([&] { return list("physics_section")->count() > 0; }));
  auto* const search = window_->find<QLineEdit>("physics_search");
  QTest::keyClicks(search, "quality");
  auto* const quality = list("physics_avalanching.quality");
  quality->setCurrentText("fast");
  Q_EMIT quality->activated(quality->currentIndex());
  EXPECT_TRUE(scenario_has(
      [](const YAML::Node& s) { return s["avalanching"]["quality"].as<std::string>() == "fast"; }));
}

TEST_F(Authoring, PlantsComeAliveAndTheirTraitsChange) {
  window_->show_tab(plants);
  ASSERT_TRUE(window_->run_until([&] { return list("species_preset")->findText("bush") >= 0; }));
  list("species_preset")->setCurrentText("bush");
  window_->type("species_name", "thorn");
  window_->click("add_species");
  ASSERT_TRUE(window_->run_until([&] { return list("species")->findText("thorn") == 0; }))
      << window_->text("plants_error");
  window_->click("let_live");
  EXPECT_TRUE(scenario_has([](const YAML::Node& s) { return s["vegetation"]["enabled"].as<bool>(); }));
  EXPECT_TRUE(window_->run_until([&] { return !window_->find<QWidget>("let_live")->isVisible(); }));
  window_->type("trait_max_radius", "0.7");
  window_->type("trait_hue", "60");
  window_->click("set_traits");
  EXPECT_TRUE(scenario_has([](const YAML::Node& s) {
    return s["species"][0]["max_radius"].as<float>() == 0.7f && s["species"][0]["hue"].as<float>() == 60;
  }));
  window_->save("panel_plants", 1200);
  window_->type("trait_stem", "-3");
  window_->click("set_traits");
  EXPECT_TRUE(refuses("plants_error", "species.0.stem: -3 is not in")) << window_->text("plants_error");
}

TEST_F(Authoring, ASceneBeginsFromTheForm) {
  window_->show_tab(scenes);
  window_->save("panel_scenes", 1000);
  window_->type("new_width", "40");
  window_->type("new_height", "24");
  window_->type("new_rock", "5");
  window_->type("new_sand", "0.4");
  EXPECT_EQ(window_->find<QDoubleSpinBox>("new_relief")->value(), 0.8)
      << "hills are no higher than sand allows";
  window_->type("new_speed", "9");
  list("new_boundary")->setCurrentText("open");
  list("new_model")->setCurrentText("werner");
  window_->click("begin_scene");
  EXPECT_TRUE(node_has([](const SimulationStatus& s) { return s.scenario == "new" && s.wind_above.x == 9; }))
      << window_->text("new_scene_error");
  const YAML::Node now = scenario();
  EXPECT_EQ(now["grid"]["width"].as<int>(), 40);
  EXPECT_EQ(now["grid"]["height"].as<int>(), 24);
  EXPECT_EQ(now["grid"]["boundary"].as<std::string>(), "open");
  EXPECT_EQ(now["sand"]["model"].as<std::string>(), "werner");
  EXPECT_EQ(now["terrain"].size(), 2u);
  list("new_model")->setCurrentText("desertscape_2019");
  window_->click("begin_scene");
  EXPECT_TRUE(scenario_has([](const YAML::Node& s) {
    return s["sand"]["model"].as<std::string>() == "desertscape_2019" &&
           s["saltation"]["lift"].as<float>() == 0.1f && s["reptation"]["slab"].as<float>() == 0.01f &&
           s["avalanching"]["scheme"].as<std::string>() == "multilevel";
  })) << window_->text("new_scene_error");
}

TEST_F(Authoring, ASavedScenarioWithAnInstalledNameHasAPathInTheList) {
  desert_sim::SceneLists lists;
  lists.installed = QStringList{"barchan", "oasis"};
  lists.scenarios = QStringList{"mine", "oasis"};
  name_apart(lists);
  EXPECT_EQ(lists.installed, (QStringList{"barchan", "package://desert_sim/config/scenarios/oasis.yaml"}));
  EXPECT_EQ(lists.scenarios, (QStringList{"mine", "oasis/scenario.yaml"}));
}

TEST_F(Authoring, AScenarioIsLoadedWithSettingsAndSavedWhole) {
  window_->show_tab(scenes);
  list("scenario")->setEditText("nebkha");
  window_->type("scenario_settings", "grid.width=32; grid.height=20");
  window_->click("load_scenario");
  ASSERT_TRUE(node_has([](const SimulationStatus& s) { return s.scenario == "nebkha"; }));
  EXPECT_EQ(scenario()["grid"]["width"].as<int>(), 32);
  window_->type("steps", "3");
  window_->click("step");
  ASSERT_TRUE(node_has([](const SimulationStatus& s) { return s.step == 3; }));
  const std::string hash = statuses_->last().state_hash;
  list("scenario")->setEditText("kept");
  window_->click("save_scenario");
  EXPECT_TRUE(window_->shows("scenario_error", data_dir_ + "/kept/scenario.yaml"));
  window_->click("reset");
  ASSERT_TRUE(node_has([](const SimulationStatus& s) { return s.step == 0; }));
  EXPECT_TRUE(window_->run_until([&] { return list("scenario")->findText("kept") >= 0; }));
  window_->find<QLineEdit>("scenario_settings")->clear();
  list("scenario")->setEditText("kept");
  window_->click("load_scenario");
  EXPECT_TRUE(node_has([&](const SimulationStatus& s) { return s.step == 3 && s.state_hash == hash; }));
}

TEST_F(Authoring, TheTerrainIsExportedByItsNameAndTheListOfFormats) {
  window_->show_tab(scenes);
  const auto exports = [&](const std::string& name) {
    window_->click("export_terrain");
    return window_->shows("export_error", "exported: " + data_dir_ + "/" + name) &&
           std::filesystem::file_size(data_dir_ + "/" + name) > 0;
  };
  const auto ending = [&] { return list("export_ending")->currentText().toStdString(); };
  window_->type("export_name", "dune");
  list("export_ending")->setCurrentText(".obj");
  node_->hold();
  window_->click("export_terrain");
  EXPECT_EQ(window_->text("export_error"), "export_terrain ...");
  node_->release();
  EXPECT_TRUE(
      window_->shows("export_error", "exported: " + data_dir_ + "/dune.obj, dune.mtl, dune_ground.png"))
      << window_->text("export_error");
  window_->save("panel_export", 1000);
  for (const char* const file : {"/dune.obj", "/dune.mtl", "/dune_ground.png"})
    EXPECT_TRUE(std::filesystem::exists(data_dir_ + file)) << file;

  window_->type("export_name", "sites/dune.stl");
  EXPECT_EQ(ending(), ".stl") << "it is written";
  EXPECT_TRUE(exports("sites/dune.stl")) << window_->text("export_error");
  list("export_ending")->setCurrentText(".ply");
  EXPECT_TRUE(exports("sites/dune.ply")) << "it is chosen: " << window_->text("export_error");

  window_->type("export_name", "../dune");
  EXPECT_EQ(ending(), ".ply");
  window_->click("export_terrain");
  EXPECT_TRUE(refuses("export_error", "'../dune.ply': contains '..'")) << window_->text("export_error");
  window_->find<QLineEdit>("export_name")->clear();
  window_->click("export_terrain");
  EXPECT_TRUE(refuses("export_error", "is empty")) << window_->text("export_error");
  EXPECT_EQ(statuses_->last().step, 0u);
}

}  // namespace
}  // namespace rviz_test
