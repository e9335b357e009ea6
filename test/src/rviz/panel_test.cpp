// The panel desert_sim/Panel on a screen of Xvfb, with a node of its own: what is clicked and typed reaches
// the node, and what the node refuses, or that it has gone, is shown.

#include <desert_sim/ApplySettings.h>
#include <desert_sim/EditTerrain.h>
#include <desert_sim/PlannerStatus.h>
#include <desert_sim/RoverStatus.h>
#include <desert_sim/SetWeather.h>
#include <desert_sim/SetWind.h>
#include <dynamic_reconfigure/Config.h>
#include <geometry_msgs/Twist.h>
#include <std_srvs/Trigger.h>

#include <QTableWidget>
#include <QTimer>
#include <cmath>
#include <csignal>
#include <fstream>

#include "test/src/rviz/panel_fixture.hpp"

namespace rviz_test {
namespace {

TEST_F(Panel, RunsPausesStepsAndResets) {
  window_->type("steps", "7");
  window_->click("step");
  EXPECT_TRUE(node_has([](const SimulationStatus& s) { return s.step == 7; }));
  EXPECT_TRUE(window_->shows("progress", "step 7,"));
  EXPECT_TRUE(window_->shows("balance", "mass residual 0"));
  window_->type("rate", "40");
  EXPECT_TRUE(node_has([](const SimulationStatus& s) { return s.step_rate == 40; }));
  window_->type("acceleration", "0.5");
  EXPECT_TRUE(
      node_has([](const SimulationStatus& s) { return s.acceleration == 0.5 && s.step_rate == 0.5; }));
  EXPECT_TRUE(window_->run_until([&] { return !window_->enabled("rate"); })) << "the acceleration sets it";
  EXPECT_TRUE(window_->shows("pace", "× 0.5: slower than real time, a second of wind takes 2 s"));
  window_->type("acceleration", "0");
  EXPECT_TRUE(node_has([](const SimulationStatus& s) { return s.acceleration == 0 && s.step_rate == 40; }));
  EXPECT_TRUE(window_->shows("pace", "not tied to a clock: 40 steps of ")) << window_->text("pace");
  EXPECT_FALSE(window_->enabled("pause")) << "it is paused";
  window_->click("run");
  EXPECT_TRUE(
      node_has([](const SimulationStatus& s) { return s.state == SimulationStatus::RUNNING && s.step > 9; }));
  EXPECT_TRUE(window_->run_until([&] { return window_->enabled("pause") && !window_->enabled("run"); }));
  window_->click("pause");
  EXPECT_TRUE(node_has([](const SimulationStatus& s) { return s.state == SimulationStatus::PAUSED; }));
  window_->click("reset");
  EXPECT_TRUE(node_has([](const SimulationStatus& s) { return s.step == 0; }));
}

TEST_F(Panel, PauseDoesNotWaitForSteps) {
  window_->type("steps", "100000000");
  window_->click("step");
  EXPECT_TRUE(node_has([](const SimulationStatus& s) { return s.step > 5; }));
  EXPECT_TRUE(window_->shows("step_error", "step ..."));
  window_->type("rate", "20");
  EXPECT_TRUE(node_has([](const SimulationStatus& s) { return s.step_rate == 20; }));
  window_->click("reset");
  EXPECT_TRUE(window_->run_until([&] {
    return window_->error("step_error").find("reset") != std::string::npos;
  })) << "why the steps have ended: "
      << window_->text("step_error");
}

TEST_F(Panel, DraggingTheNeedleSetsTheWind) {
  auto* const dial = window_->find<QWidget>("wind_dial");
  const QPoint centre = dial->rect().center();
  QTest::mousePress(dial, Qt::LeftButton, {}, centre + QPoint(10, 0));
  QTest::mouseMove(dial, centre + QPoint(0, -20));
  QTest::mouseRelease(dial, Qt::LeftButton, {}, centre + QPoint(0, -30));
  const double speed = window_->find<QDoubleSpinBox>("wind_speed")->value();
  EXPECT_GT(speed, 1);
  EXPECT_NEAR(window_->find<QDoubleSpinBox>("wind_direction")->value(), 90, 3) << "up is north";
  EXPECT_TRUE(node_has([&](const SimulationStatus& s) {
    return std::abs(s.wind_above.y - speed) < 0.05 * speed && std::abs(s.wind_above.x) < 0.06 * speed;
  }));
  window_->type("wind_speed", "9");
  window_->type("wind_direction", "180");
  EXPECT_TRUE(node_has([](const SimulationStatus& s) {
    return std::abs(s.wind_above.x + 9) < 1e-6 && std::abs(s.wind_above.y) < 1e-6;
  }));
  EXPECT_EQ(window_->error("wind_error"), "");
}

TEST_F(Panel, TheNeedleFollowsTheWindThatOthersSet) {
  auto* const dial = window_->find<QWidget>("wind_dial");
  const auto needle_is = [&](double speed) {
    return window_->run_until([&] {
      return dial->property("wanted_speed").toDouble() == speed &&
             window_->find<QDoubleSpinBox>("wind_speed")->value() == speed;
    });
  };
  const auto set_by_others = [&](double speed) {
    desert_sim::SetWind::Request request;
    request.speed = speed;
    node_->call<desert_sim::SetWind>("set_wind", request);
  };
  set_by_others(7);
  EXPECT_TRUE(needle_is(7));
  // One's own wind is shown until it is there: here a ramp leads to it, and the node is paused.
  window_->type("wind_ramp", "2");
  window_->type("wind_speed", "9");
  window_->type("rate", "30");  // another status
  EXPECT_TRUE(node_has([](const SimulationStatus& s) { return s.step_rate == 30 && s.wind_above.x < 7.5; }));
  EXPECT_TRUE(needle_is(9));
  window_->type("steps", "200");
  window_->click("step");
  EXPECT_TRUE(node_has([](const SimulationStatus& s) { return s.step == 200 && s.wind_above.x > 8.9; }));
  set_by_others(4);
  EXPECT_TRUE(needle_is(4));
  QTest::mousePress(dial, Qt::LeftButton, {}, dial->rect().center() + QPoint(30, 0));
  const double dragged = dial->property("wanted_speed").toDouble();
  set_by_others(6);
  EXPECT_TRUE(window_->shows("present_wind", "6.0 m/s"));
  EXPECT_EQ(dial->property("wanted_speed").toDouble(), dragged) << "it is being dragged";
  QTest::mouseRelease(dial, Qt::LeftButton, {}, dial->rect().center() + QPoint(30, 0));
}

TEST_F(Panel, ShowsHowAPlannerWaitsForItsForecast) {
  using desert_sim::PlannerStatus;
  ros::NodeHandle node;
  ros::Publisher planner = node.advertise<PlannerStatus>("/made_up/desert_planner/status", 1, true);
  PlannerStatus status;
  status.state = PlannerStatus::DRIVING;
  status.remaining = 12.34;
  status.forecast_age = -1;
  status.forecast_progress = 0.24;
  planner.publish(status);
  EXPECT_TRUE(window_->shows("planners", "/made_up: driving, 12.3 m to go, no forecast yet (24 %)"));
  status.forecast_age = 31;
  planner.publish(status);
  EXPECT_TRUE(window_->shows("planners", "forecast of 31 s ago, the next one 24 %"));
  status.forecast_progress = -1;
  status.state = PlannerStatus::ARRIVED;
  planner.publish(status);
  EXPECT_TRUE(window_->run_until(
      [&] { return window_->text("planners") == "/made_up: arrived, forecast of 31 s ago"; }));
  planner.shutdown();
  EXPECT_TRUE(window_->run_until([&] { return window_->text("planners").empty(); })) << "it has gone";
}

TEST_F(Panel, ThePadDrivesARoverWhileItIsHeld) {
  ros::NodeHandle node;
  const ros::Publisher rover =
      node.advertise<desert_sim::RoverStatus>("/made_up/desert_rover/status", 1, true);
  window_->show_tab(drive);
  auto* const pad = window_->find<QWidget>("drive_pad");
  EXPECT_FALSE(pad->isEnabled()) << "there is no rover";
  ASSERT_TRUE(window_->run_until(
      [&] { return window_->find<QComboBox>("rover")->currentText() == "/made_up" && pad->isEnabled(); }));
  Listener<geometry_msgs::Twist> commands("/made_up/cmd_vel");
  const QPoint top(pad->rect().center().x(), 0);
  const auto drives = [&](double forward, double left) {
    return window_->run_until([&] {
      return commands.count() > 0 && std::abs(commands.last().linear.x - forward) < 0.01 &&
             std::abs(commands.last().angular.z - left) < 0.01;  // a pixel is 0.005
    });
  };
  const auto last = [&] {
    return ::testing::Message() << commands.last().linear.x << ", " << commands.last().angular.z;
  };
  QTest::mousePress(pad, Qt::LeftButton, {}, top);
  EXPECT_TRUE(drives(0.2, 0)) << last();
  const auto count = commands.count();
  EXPECT_TRUE(window_->run_until([&] { return commands.count() > count + 3; })) << "while it is held";
  QTest::mouseRelease(pad, Qt::LeftButton, {}, top);
  EXPECT_TRUE(drives(0, 0)) << last();

  window_->type("drive_speed", "0.1");
  QTest::keyPress(pad, Qt::Key_Down);
  QTest::keyPress(pad, Qt::Key_Left);
  EXPECT_TRUE(drives(-0.1, 0.4)) << last();
  QTest::keyRelease(pad, Qt::Key_Down);
  EXPECT_TRUE(drives(0, 0.4)) << last();
  QFocusEvent lost(QEvent::FocusOut);
  QApplication::sendEvent(pad, &lost);
  EXPECT_TRUE(drives(0, 0)) << last();
  QTest::mousePress(pad, Qt::LeftButton, {}, top);
  EXPECT_TRUE(drives(0.1, 0)) << last();
  window_->show_tab(wind);
  EXPECT_TRUE(drives(0, 0)) << "it is hidden";
}

TEST_F(Panel, SetsTimelinesAndRoses) {
  auto* const table = window_->find<QTableWidget>("segments_table");
  const auto cell = [&](int row, int column) {
    return qobject_cast<QDoubleSpinBox*>(table->cellWidget(row, column));
  };
  cell(0, 0)->setValue(270);
  cell(0, 1)->setValue(8);
  cell(0, 3)->setValue(0);
  window_->click("apply_schedule");
  EXPECT_TRUE(node_has([](const SimulationStatus& s) { return std::abs(s.wind_above.y + 8) < 1e-6; }));
  EXPECT_EQ(window_->error("schedule_error"), "");

  cell(1, 2)->setValue(5);
  cell(1, 3)->setValue(20);
  window_->click("apply_schedule");
  EXPECT_TRUE(window_->run_until([&] {
    return window_->error("schedule_error").find("ramp") != std::string::npos;
  })) << "a ramp longer than its segment: "
      << window_->error("schedule_error");

  window_->find<QComboBox>("schedule_kind")->setCurrentIndex(1);
  EXPECT_TRUE(table->isColumnHidden(2)) << "a rose has no durations";
  window_->click("segments_remove");
  ASSERT_EQ(table->rowCount(), 1);
  cell(0, 0)->setValue(0);
  cell(0, 1)->setValue(5);
  window_->click("apply_schedule");
  EXPECT_TRUE(node_has([](const SimulationStatus& s) { return std::abs(s.wind_above.x - 5) < 1e-6; }));
  EXPECT_EQ(window_->error("schedule_error"), "") << "what was refused before is not shown any more";
}

TEST_F(Panel, ChangesTheWeatherThatIsTicked) {
  window_->show_tab(weather);
  window_->click("apply_weather");
  EXPECT_TRUE(window_->run_until([&] { return !window_->error("weather_error").empty(); }))
      << "nothing is ticked";
  window_->click("change_rain_rate");
  window_->type("rain_rate", "36000");
  window_->click("apply_weather");
  EXPECT_TRUE(window_->run_until([&] { return window_->text("weather_error").empty(); }));
  window_->click("step");
  EXPECT_TRUE(node_has([](const SimulationStatus& s) {
    for (const auto& volume : s.volumes)
      if (volume.material == "water" && volume.entered > 0) return true;
    return false;
  }));

  desert_sim::SetWeather::Request others;
  others.change = {"evaporation", "rain_rate"};
  others.evaporation = 0.5;
  node_->call<desert_sim::SetWeather>("set_weather", others);
  const auto value = [&](const char* name) { return window_->find<QDoubleSpinBox>(name)->value(); };
  EXPECT_TRUE(window_->run_until([&] { return value("evaporation") == 0.5; })) << "what others set is shown";
  EXPECT_EQ(value("rain_rate"), 36000) << "but what is ticked stays as it was typed";
}

TEST_F(Panel, LoadsScenariosByName) {
  window_->show_tab(scenes);
  auto* const list = window_->find<QComboBox>("scenario");
  EXPECT_TRUE(window_->run_until([&] { return list->findText("nebkha") >= 0; }))
      << "installed ones are listed";
  std::ofstream(data_dir_ + "/mine.yaml") << "grid: {width: 9, height: 7}\n";
  window_->click("refresh");
  EXPECT_TRUE(window_->run_until([&] { return list->findText("mine.yaml") >= 0; }));
  for (const char* name : {"mine.yaml", "nebkha"}) {
    list->setCurrentIndex(list->findText(name));
    window_->click("load_scenario");
    EXPECT_TRUE(node_has([&](const SimulationStatus& s) {
      return s.scenario == std::string(name).substr(0, s.scenario.size());
    }));
  }
  list->setEditText("nowhere");
  window_->click("load_scenario");
  EXPECT_TRUE(window_->run_until(
      [&] { return window_->error("scenario_error").find("nowhere") != std::string::npos; }));
  EXPECT_EQ(statuses_->last().scenario, "nebkha");
}

TEST_F(Panel, SavesAndLoads) {
  window_->show_tab(scenes);
  window_->find<QComboBox>("checkpoint")->setEditText("at7.ckpt");
  window_->find<QComboBox>("terrain")->setEditText("site");
  window_->type("steps", "7");
  window_->click("step");
  ASSERT_TRUE(node_has([](const SimulationStatus& s) { return s.step == 7; }));
  window_->click("save_checkpoint");
  EXPECT_TRUE(window_->shows("checkpoint_error", data_dir_ + "/at7.ckpt"));
  window_->click("save_terrain");
  EXPECT_TRUE(window_->shows("terrain_error", data_dir_ + "/site/terrain.yaml"));
  window_->click("load_terrain");
  EXPECT_TRUE(node_has([](const SimulationStatus& s) { return s.step == 0; }));
  window_->click("load_checkpoint");
  EXPECT_TRUE(node_has([](const SimulationStatus& s) { return s.step == 7; }));
  EXPECT_TRUE(window_->run_until([&] { return window_->find<QComboBox>("terrain")->findText("site") >= 0; }));
  window_->find<QComboBox>("checkpoint")->setEditText("../outside.ckpt");
  window_->click("save_checkpoint");
  EXPECT_TRUE(window_->run_until(
      [&] { return window_->error("checkpoint_error").find("~data_dir") != std::string::npos; }));
}

TEST_F(Panel, UndoesAndRedoes) {
  EXPECT_FALSE(window_->enabled("undo"));
  const std::string before = statuses_->last().state_hash;
  desert_sim::EditTerrain::Request brush;
  brush.layer = "sand";
  brush.shape = "circle";
  brush.merge = "add";
  brush.center.x = brush.center.y = 20;
  brush.radius = 5;
  brush.value = 1;
  node_->call<desert_sim::EditTerrain>("edit_terrain", brush);
  const auto button = [&](const char* name) {
    return window_->find<QAbstractButton>(name)->text().toStdString();
  };
  ASSERT_TRUE(window_->run_until([&] { return button("undo") == "Undo (1)"; })) << button("undo");
  EXPECT_TRUE(node_has([&](const SimulationStatus& s) { return s.state_hash != before; }));
  window_->click("undo");
  EXPECT_TRUE(node_has([&](const SimulationStatus& s) { return s.state_hash == before; }));
  ASSERT_TRUE(window_->run_until([&] { return button("redo") == "Redo (1)"; })) << button("redo");
  window_->click("redo");
  EXPECT_TRUE(node_has([&](const SimulationStatus& s) { return s.state_hash != before && s.undoable == 1; }));
}

TEST_F(Panel, UndoesTheWindASettingAndAReset) {
  const auto undo_reaches = [&](const char* count) {
    return window_->run_until(
        [&] { return window_->find<QAbstractButton>("undo")->text() == QString("Undo (%1)").arg(count); });
  };
  const double calm = statuses_->last().wind_above.x;
  desert_sim::SetWind::Request wind;
  wind.speed = 11;
  node_->call<desert_sim::SetWind>("set_wind", wind);
  ASSERT_TRUE(undo_reaches("1"));
  desert_sim::ApplySettings::Request settings;
  settings.settings = {"saltation.lift=0.125"};
  node_->call<desert_sim::ApplySettings>("apply_settings", settings);
  ASSERT_TRUE(undo_reaches("2"));
  window_->click("undo");
  EXPECT_TRUE(window_->shows("undo_error", "set back: saltation.lift")) << window_->text("undo_error");
  ASSERT_TRUE(undo_reaches("1"));
  EXPECT_TRUE(node_has([](const SimulationStatus& s) { return s.wind_above.x == 11; }));
  window_->click("undo");
  EXPECT_TRUE(node_has([&](const SimulationStatus& s) { return s.wind_above.x == calm; }));
  window_->click("redo");
  ASSERT_TRUE(undo_reaches("1"));
  window_->click("reset");
  EXPECT_TRUE(node_has([&](const SimulationStatus& s) { return s.wind_above.x == calm; }));
  ASSERT_TRUE(undo_reaches("1"));
  window_->click("undo");
  EXPECT_TRUE(node_has([](const SimulationStatus& s) { return s.wind_above.x == 11; }));
  EXPECT_TRUE(window_->shows("undo_error", "the terrain is the one of before"))
      << window_->text("undo_error");
}

TEST_F(Panel, ShowsThatTheNodeHasVanishedAndIsBack) {
  node_->end(SIGKILL);
  EXPECT_TRUE(window_->shows("state", "/panel_node is not there")) << window_->text("state");
  EXPECT_NE(window_->text("hint").find("roslaunch"), std::string::npos);
  EXPECT_FALSE(window_->enabled("controls"));
  start();
  EXPECT_TRUE(window_->shows("state", "corner: paused")) << window_->text("state");
  EXPECT_TRUE(window_->enabled("controls"));
}

/// A node that is stopped, as by a debugger, answers nothing and holds its connections. It is stopped until
/// the panel has gone: if that waited for the node, this would not end.
TEST_F(Panel, NeverWaitsForANodeThatHangs) {
  node_->hold();
  window_->click("step");
  window_->click("reset");
  int served = 0;
  QTimer timer;
  QObject::connect(&timer, &QTimer::timeout, [&served] { ++served; });
  timer.start(1);
  EXPECT_TRUE(window_->run_until([&] { return served > 100; }));
  EXPECT_EQ(window_->text("run_error"), "reset ...");
  window_->type("node", "/other_node");
  EXPECT_EQ(window_->text("run_error"), "");
  EXPECT_TRUE(window_->shows("state", "/other_node is not there")) << window_->text("state");
  window_->type("node", node_name);
  window_->click("reset");
  window_.reset();
  node_->release();
}

/// Whatever a node says, the panel is there to show what it says next.
TEST_F(Panel, ShowsNumbersThatNoNodeHas) {
  const std::string name = "/node_of_nonsense";
  ros::NodeHandle node;
  const ros::Publisher statuses = node.advertise<SimulationStatus>(name + "/status", 1, true),
                       parameters =
                           node.advertise<dynamic_reconfigure::Config>(name + "/parameter_updates", 1, true);
  const boost::function<bool(std_srvs::TriggerRequest&, std_srvs::TriggerResponse&)> serve =
      [](std_srvs::TriggerRequest&, std_srvs::TriggerResponse&) { return true; };
  const ros::ServiceServer pause = node.advertiseService(name + "/pause", serve);
  window_->type("node", name);
  for (const double number : {double(NAN), HUGE_VAL, -HUGE_VAL, 1e300, -1e300, 12.5}) {
    SimulationStatus status;
    status.scenario = "of " + std::to_string(number);
    status.state = std::string(100000, 'x');
    status.sim_time = status.step_rate = status.acceleration = status.lag = status.steps_per_second = number;
    status.wind_above.x = status.wind_above.y = number;
    status.step = status.undoable = status.redoable = -1;
    status.volumes.resize(1);
    status.volumes[0].residual = number;
    dynamic_reconfigure::Config config;
    config.doubles.resize(3);
    for (const char* const parameter : {"rain__rate", "water__sea_level", "rain__evaporation"}) {
      auto& entry = config.doubles.emplace_back();
      entry.name = parameter;
      entry.value = number;
    }
    config.strs.resize(1);
    config.strs[0].name = "water__sea";
    config.strs[0].value = "no such sea";
    parameters.publish(config);
    statuses.publish(status);
    EXPECT_TRUE(window_->shows("state", status.scenario)) << window_->text("state").substr(0, 80);
    window_->show_tab(weather);
    window_->panel().repaint();
    window_->show_tab(wind);
    window_->panel().repaint();
  }
  EXPECT_NE(window_->text("progress").find(", 12.5 s simulated"), std::string::npos)
      << window_->text("progress");
}

TEST_F(Panel, IsSavedWithRviz) {
  window_->type("steps", "25");
  rviz::Config config;
  window_->panel().save(config);
  PanelWindow other("/other_node");
  other.panel().load(config);
  EXPECT_EQ(other.find<QLineEdit>("node")->text().toStdString(), node_name);
  EXPECT_EQ(other.find<QSpinBox>("steps")->value(), 25);
  EXPECT_TRUE(other.shows("state", "corner: paused"));
}

TEST_F(Panel, RefusesNamesThatAreNone) {
  window_->type("node", "no such name");
  EXPECT_NE(window_->error("node_error").find("'no such name'"), std::string::npos);
  window_->type("node", node_name);
  EXPECT_EQ(window_->error("node_error"), "");
}

}  // namespace
}  // namespace rviz_test

int main(int argc, char** argv) { return rviz_test::run_panel_tests(argc, argv, "panel_test"); }
