// The panel's tab Timeline: what is typed happens in the node at its time, is listed, changed and removed.

#include <desert_sim/ApplySettings.h>
#include <desert_sim/QueryTerrain.h>

#include <QPlainTextEdit>

#include "test/src/rviz/panel_fixture.hpp"

namespace rviz_test {
namespace {

class TimelineTab : public Panel {
 protected:
  void SetUp() override {
    Panel::SetUp();
    if (!window_) return;
    window_->show_tab(timeline);
    ASSERT_TRUE(node_has([](const SimulationStatus& s) { return s.time_step > 0; }));
    time_step_ = statuses_->last().time_step;
    ASSERT_TRUE(window_->run_until([&] { return !text("entry_time").empty(); }));
  }
  std::string text(const std::string& field) { return window_->find<QLineEdit>(field)->text().toStdString(); }
  /// So many steps of simulated time, as somebody types it.
  std::string steps(double count) { return QString::number(count * time_step_, 'g', 9).toStdString(); }
  int row_count() { return window_->find<QTableWidget>("timeline_table")->rowCount(); }
  bool has_rows(int count) {
    return window_->run_until([&] { return row_count() == count; });
  }
  std::string listed(int row) { return window_->cell_text("timeline_table", row, 1); }
  bool shows_past(int row) {
    return window_->run_until(
        [&] { return window_->cell_text("timeline_table", row, 0).find("(past)") != std::string::npos; });
  }
  void type_keys(const std::string& keys) {
    auto* const field = window_->find<QPlainTextEdit>("entry_keys");
    field->setFocus();
    field->selectAll();
    QTest::keyClicks(field, QString::fromStdString(keys));
  }
  void add_parameter(const std::string& time, const std::string& path, const std::string& value) {
    list("entry_kind")->setCurrentIndex(0);
    window_->type("entry_time", time);
    window_->type("entry_path_0", path);
    window_->type("entry_value_0", value);
    window_->click("add_entry");
  }
  void make_steps(int count) {
    const std::uint64_t before = statuses_->last().step;
    window_->type("steps", std::to_string(count));
    window_->click("step");
    ASSERT_TRUE(node_has(
        [&](const SimulationStatus& s) { return s.step == before + static_cast<std::uint64_t>(count); }));
    ASSERT_TRUE(window_->shows("progress", "step " + std::to_string(statuses_->last().step) + ","));
  }
  float lift() { return scenario()["saltation"]["lift"].as<float>(); }
  double sand_at(double x, double y) {
    desert_sim::QueryTerrainRequest request;
    request.points.resize(1);
    request.points[0].x = x;
    request.points[0].y = y;
    return node_->call<desert_sim::QueryTerrain>("query_terrain", request).samples.at(0).sand;
  }
  /// The entries that the node has.
  std::vector<std::string> entries() {
    std::vector<std::string> all;
    for (const YAML::Node& entry : scenario()["run"]["timeline"]) all.push_back(YAML::Dump(entry));
    return all;
  }
  void set_timeline(const std::string& list) { apply("run.timeline=" + list); }
  void apply(const std::string& setting) {
    desert_sim::ApplySettingsRequest request;
    request.settings = {setting};
    node_->call<desert_sim::ApplySettings>("apply_settings", request);
  }

  double time_step_ = 0;  ///< [s]
};

TEST_F(TimelineTab, AParameterChangesAtItsTimeAndTheListSaysSo) {
  EXPECT_EQ(text("entry_time"), steps(10)) << "a few steps ahead";
  const float start = lift();
  ASSERT_NE(start, 0.35f);
  ASSERT_TRUE(window_->run_until([&] { return list("entry_path_0")->findText("saltation.lift") >= 0; }));
  make_steps(1);
  add_parameter(steps(2), "saltation.lift", "0.35");
  ASSERT_TRUE(has_rows(1)) << window_->text("entry_error");
  EXPECT_EQ(window_->cell_text("timeline_table", 0, 0), steps(3) + " s") << "two steps from now";
  EXPECT_EQ(listed(0), "saltation.lift → 0.35");
  EXPECT_TRUE(window_->run_until([&] { return window_->enabled("change_entry"); })) << "it is chosen";
  make_steps(2);
  EXPECT_EQ(lift(), start) << "it is not yet time";
  make_steps(1);
  EXPECT_EQ(lift(), 0.35f);
  EXPECT_TRUE(shows_past(0));
  window_->save("panel_timeline", 900);
}

TEST_F(TimelineTab, AnEntryIsUndoneAndRedone) {
  set_timeline("[{time: 1.0e5, set: {saltation.lift: 0.5}}]");
  ASSERT_TRUE(has_rows(1));
  add_parameter(steps(1.0e6), "saltation.lift",
                "0.35");  // ~status does not tell of it: it is not the next one
  ASSERT_TRUE(has_rows(2)) << window_->text("entry_error");
  ASSERT_TRUE(window_->run_until([&] { return window_->enabled("undo"); }));
  window_->click("undo");
  EXPECT_TRUE(has_rows(1)) << "the list follows";
  EXPECT_EQ(entries().size(), 1u);
  ASSERT_TRUE(window_->run_until([&] { return window_->enabled("redo"); }));
  window_->click("redo");
  EXPECT_TRUE(has_rows(2));
  EXPECT_EQ(entries().size(), 2u);
}

TEST_F(TimelineTab, AnEntryIsChangedAndRemovedAndOthersStayAsTheyAre) {
  std::string raster;  // 20 x 20 floats of 0 in base64
  for (int n = 0; n < 2133; ++n) raster += 'A';
  raster += "A==";
  raster.resize(2136);
  raster.replace(2134, 2, "==");
  set_timeline(
      "[{time: 1.0e5, ramp: 0.12345678901234567, set: {saltation.lift: 3.50e-1, avalanching.quality: "
      "fast}}, {time: 100001, every: 7, until: 2.0e5, command: edit_terrain, shape: patch, x: 60, y: "
      "20, radius: 8, radius_y: 8, value: 0.25, patch_columns: 20, patch_rows: 20, patch: \"" +
      raster +
      "\"}, {time: 100002, command: set_wind_schedule, regime: rose, hold_time: 20, segments: "
      "[{direction_deg: 0}, {direction_deg: 90, speed: 7}]}]");
  ASSERT_TRUE(has_rows(3)) << "~status tells that there is something new";
  const std::vector<std::string> before = entries();
  EXPECT_NE(listed(1).find("edit_terrain: shape patch, x 60"), std::string::npos) << listed(1);

  window_->choose_row("timeline_table", 1);
  EXPECT_EQ(list("entry_kind")->currentText(), "edit_terrain");
  EXPECT_EQ(text("entry_every"), "7");
  QString keys = window_->find<QPlainTextEdit>("entry_keys")->toPlainText();
  EXPECT_FALSE(keys.contains("AAAA")) << "a raster is no text";
  ASSERT_TRUE(keys.contains("value: 0.25")) << keys.toStdString();
  type_keys(keys.replace("value: 0.25", "value: 0.5").toStdString());
  window_->click("change_entry");
  ASSERT_TRUE(window_->run_until([&] { return listed(1).find("value 0.5") != std::string::npos; }))
      << window_->text("entry_error");
  window_->save("panel_timeline_list", 1000);
  const YAML::Node changed = YAML::Load(entries().at(1));
  EXPECT_EQ(changed["value"].as<double>(), 0.5);
  EXPECT_EQ(changed["patch"].as<std::string>(), raster) << "what was not shown";
  EXPECT_EQ(changed["until"].as<double>(), 2e5);
  EXPECT_EQ(entries().at(0), before.at(0));
  EXPECT_EQ(entries().at(2), before.at(2));

  window_->choose_row("timeline_table", 0);
  EXPECT_EQ(window_->find<QComboBox>("entry_path_1")->currentText(), "avalanching.quality");
  window_->type("entry_value_1", "good");
  window_->click("change_entry");
  ASSERT_TRUE(window_->run_until([&] { return listed(0).find("good") != std::string::npos; }))
      << window_->text("entry_error");
  EXPECT_EQ(scenario()["run"]["timeline"][0]["ramp"].as<double>(), 0.12345678901234567)
      << "also the digits that are not shown";

  window_->choose_row("timeline_table", 1);
  window_->click("remove_entry");
  ASSERT_TRUE(has_rows(2)) << window_->text("entry_error");
  EXPECT_EQ(entries().at(1), before.at(2));
}

TEST_F(TimelineTab, AnEditIsRepeated) {
  apply("saltation.enabled=false");  // the wind would carry it away
  const double before = sand_at(60, 20), elsewhere = sand_at(100, 50);
  list("entry_kind")->setCurrentText("edit_terrain");
  EXPECT_TRUE(window_->find<QWidget>("entry_keys")->toolTip().contains("radius: Radius;"));
  type_keys("layer: sand, x: 60, y: 20, radius: 6, inner: 1, value: 0.2");
  window_->type("entry_time", steps(1));
  window_->type("entry_every", steps(2));
  window_->type("entry_until", steps(5));
  window_->click("add_entry");
  ASSERT_TRUE(has_rows(1)) << window_->text("entry_error");
  EXPECT_EQ(window_->cell_text("timeline_table", 0, 0),
            steps(1) + " s, every " + steps(2) + " s until " + steps(5) + " s");
  EXPECT_TRUE(window_->run_until([&] { return window_->enabled("change_entry"); })) << "it is chosen";
  window_->save("panel_timeline_command", 900);
  make_steps(1);
  EXPECT_NEAR(sand_at(60, 20), before, 0.05);
  make_steps(1);
  EXPECT_NEAR(sand_at(60, 20), before + 0.2, 0.05);
  make_steps(2);
  EXPECT_NEAR(sand_at(60, 20), before + 0.4, 0.05) << "again";
  make_steps(8);
  EXPECT_NEAR(sand_at(60, 20), before + 0.6, 0.05) << "three times in all";
  EXPECT_NEAR(sand_at(100, 50), elsewhere, 0.05);
  EXPECT_TRUE(shows_past(0));
}

TEST_F(TimelineTab, WhatTheNodeRefusesIsShownAndNothingIsLost) {
  make_steps(3);
  list("entry_from")->setCurrentText("at [s]");
  add_parameter("0", "saltation.lift", "0.35");
  EXPECT_TRUE(refuses("entry_error", "run.timeline.0.time: 0 s is past")) << window_->text("entry_error");
  EXPECT_EQ(text("entry_value_0"), "0.35") << "what was typed stays";
  list("entry_from")->setCurrentText("in [s]");
  add_parameter("5", "saltation.lift", "[0.35");
  EXPECT_TRUE(refuses("entry_error", "'[0.35' is")) << window_->text("entry_error");
  add_parameter("5", "saltation.lifd", "0.35");
  EXPECT_TRUE(refuses("entry_error", "unknown parameter")) << window_->text("entry_error");
  add_parameter("soon", "saltation.lift", "0.35");
  EXPECT_TRUE(refuses("entry_error", "soon is not a time")) << window_->text("entry_error");
  window_->type("entry_time", "5");
  list("entry_kind")->setCurrentText("edit_plants");
  type_keys("operation: clear, raduis: 3");
  window_->click("add_entry");
  EXPECT_TRUE(refuses("entry_error", "raduis")) << window_->text("entry_error");
  type_keys("operation: clear}, {radius: 3");
  window_->click("add_entry");
  EXPECT_TRUE(refuses("entry_error", "is not one value")) << window_->text("entry_error");
  EXPECT_EQ(entries(), std::vector<std::string>());
  EXPECT_EQ(row_count(), 0);
  EXPECT_TRUE(window_->find<QWidget>("add_entry")->isEnabled());
}

TEST_F(TimelineTab, WhatIsTypedStaysWhileTheListIsShownAnew) {
  window_->type("entry_path_0", "saltation.lift");
  window_->type("entry_value_0", "0.3");
  set_timeline("[{time: 1.0e5, set: {saltation.lift: 0.5}}]");
  ASSERT_TRUE(has_rows(1));
  EXPECT_EQ(text("entry_value_0"), "0.3");
  window_->choose_row("timeline_table", 0);
  EXPECT_EQ(text("entry_value_0"), "0.5");
  window_->type("entry_value_0", "0.6");
  set_timeline("[{time: 5.0e4, set: {saltation.lift: 0.1}}, {time: 1.0e5, set: {saltation.lift: 0.5}}]");
  ASSERT_TRUE(has_rows(2));
  window_->click("change_entry");
  ASSERT_TRUE(window_->run_until([&] { return listed(1) == "saltation.lift → 0.6"; }))
      << "the same entry is chosen, at another place: " << listed(0) << "; " << listed(1);
  EXPECT_EQ(listed(0), "saltation.lift → 0.1");
  window_->click("reset");
  EXPECT_TRUE(has_rows(0)) << "as the scenario began";
}

}  // namespace
}  // namespace rviz_test
