// The tab Wind of the panel: the list of local features.

#include <desert_sim/EditWind.h>
#include <desert_sim/WindFeatureList.h>
#include <std_srvs/Trigger.h>

#include <QMenu>
#include <QPushButton>
#include <QTableWidget>
#include <cmath>

#include "test/src/rviz/panel_fixture.hpp"

namespace rviz_test {
namespace {

using desert_sim::EditWind;
using desert_sim::WindFeatureItem;
using desert_sim::WindFeatureList;

EditWind::Request feature(int id, const std::string& kind, double x) {
  EditWind::Request request;
  request.operation = EditWind::Request::ADD;
  request.id = id;
  request.kind = kind;
  request.center.x = x;
  request.center.y = 12.345678;
  request.radius = 7.654321;
  request.speed = 3;
  if (kind == EditWind::Request::JET) request.length = 20, request.direction_deg = 30;
  if (kind == EditWind::Request::TURBULENCE) request.scale = 2, request.life_time = 9, request.seed = 4;
  return request;
}

class PanelWinds : public Panel {
 protected:
  void SetUp() override {
    Panel::SetUp();
    if (!window_) return;
    list_ = std::make_unique<Listener<WindFeatureList>>(std::string(node_name) + "/wind_features");
    table_ = window_->find<QTableWidget>("wind_features_table");
  }
  void TearDown() override {
    list_.reset();
    Panel::TearDown();
  }
  void edit(const EditWind::Request& request) { node_->call<EditWind>("edit_wind", request); }
  bool rows(int count) {
    return window_->run_until([&] { return table_->rowCount() == count; });
  }
  std::string cell(int row, int column) { return table_->item(row, column)->text().toStdString(); }
  void choose(int row) {
    QTest::mouseClick(table_->viewport(), Qt::LeftButton, {},
                      table_->visualItemRect(table_->item(row, 1)).center());
  }
  bool seen(const char* name) {
    auto* const widget = window_->find<QWidget>(name);
    return widget->isVisibleTo(widget->window());
  }
  double value(const char* name) { return window_->find<QDoubleSpinBox>(name)->value(); }
  bool node_lists(const std::function<bool(const std::vector<WindFeatureItem>&)>& fits) {
    return window_->run_until([&] { return list_->count() > 0 && fits(list_->last().features); });
  }

  std::unique_ptr<Listener<WindFeatureList>> list_;
  QTableWidget* table_ = nullptr;
};

TEST_F(PanelWinds, AreListedChangedAndDeleted) {
  EXPECT_FALSE(window_->enabled("delete_all_features"));
  edit(feature(3, EditWind::Request::VORTEX, 30));
  edit(feature(5, EditWind::Request::TURBULENCE, 60));
  edit(feature(8, EditWind::Request::JET, 90));
  ASSERT_TRUE(rows(3));
  EXPECT_EQ(cell(1, 0), "5");
  EXPECT_EQ(cell(1, 1), "turbulence");
  EXPECT_EQ(cell(2, 2), "90.0");
  EXPECT_FALSE(seen("apply_feature")) << "none is chosen";
  choose(1);
  EXPECT_TRUE(seen("feature_scale"));
  EXPECT_FALSE(seen("feature_length"));
  EXPECT_EQ(value("feature_life_time"), 9);
  choose(2);
  EXPECT_TRUE(seen("feature_length"));
  EXPECT_FALSE(seen("feature_scale"));
  window_->type("feature_speed", "7.5");
  edit(feature(9, EditWind::Request::VORTEX, 100));
  ASSERT_TRUE(rows(4));
  EXPECT_EQ(value("feature_speed"), 7.5) << "what is typed stays though the list grows";
  window_->click("apply_feature");
  ASSERT_TRUE(node_lists([](const auto& list) { return list.size() == 4 && list[2].speed == 7.5; }))
      << window_->error("wind_features_error");
  const WindFeatureItem jet = list_->last().features[2];
  EXPECT_EQ(jet.id, 8);
  EXPECT_EQ(jet.center.y, 12.345678) << "what nobody changed keeps all its digits";
  EXPECT_FLOAT_EQ(static_cast<float>(jet.radius), 7.654321f);
  EXPECT_EQ(jet.length, 20);
  EXPECT_EQ(jet.direction_deg, 30);
  EXPECT_TRUE(window_->run_until([&] { return cell(2, 4) == "7.5"; }));
  window_->save("panel_winds", 1400);

  window_->click("delete_feature");
  EXPECT_TRUE(node_lists([](const auto& list) { return list.size() == 3 && list[2].id == 9; }));
  ASSERT_TRUE(rows(3));
  EXPECT_FALSE(window_->enabled("delete_feature")) << "the chosen one has gone";
  window_->click("delete_all_features");
  EXPECT_TRUE(node_lists([](const auto& list) { return list.empty(); }));
  EXPECT_TRUE(rows(0));
}

TEST_F(PanelWinds, APathIsText) {
  edit(feature(3, EditWind::Request::VORTEX, 30));
  ASSERT_TRUE(rows(1));
  choose(0);
  EXPECT_TRUE(seen("feature_x"));
  window_->type("feature_path", "0 20 10; 5 40");
  window_->click("apply_feature");
  EXPECT_NE(window_->error("wind_features_error").find("is no path"), std::string::npos);
  window_->type("feature_path", "0 20 10; 5 40 10; 9 40 30");
  window_->click("apply_feature");
  const auto has = [](std::size_t points, double x) {
    return [=](const auto& list) {
      return list.size() == 1 && list[0].path.size() == points && list[0].center.x == x;
    };
  };
  ASSERT_TRUE(node_lists(has(3, 0))) << window_->error("wind_features_error");
  EXPECT_TRUE(window_->run_until([&] { return cell(0, 2) == "20.0" && !seen("feature_x"); }));
  window_->type("feature_path", " ");
  window_->click("apply_feature");
  EXPECT_TRUE(node_lists(has(0, 20))) << "it stands where its path began";
}

/// The panel is then not the first subscriber in its process, as beside the tool WindTool.
TEST_F(PanelWinds, OfAnotherNodeAreForgotten) {
  edit(feature(3, EditWind::Request::VORTEX, 30));
  ASSERT_TRUE(rows(1));
  window_->type("node", "/other_node");
  EXPECT_EQ(table_->rowCount(), 0);
  window_->type("node", node_name);
  EXPECT_TRUE(rows(1));
}

/// A scenario can give a feature no id; and whatever a node says, the panel shows it.
TEST_F(PanelWinds, WithoutAnIdAreSeenButNotChosen) {
  const std::string name = "/node_of_whirls";
  ros::NodeHandle node;
  const ros::Publisher statuses = node.advertise<SimulationStatus>(name + "/status", 1, true),
                       winds = node.advertise<WindFeatureList>(name + "/wind_features", 1, true);
  const boost::function<bool(std_srvs::TriggerRequest&, std_srvs::TriggerResponse&)> serve =
      [](std_srvs::TriggerRequest&, std_srvs::TriggerResponse&) { return true; };
  const ros::ServiceServer pause = node.advertiseService(name + "/pause", serve);
  WindFeatureList list;
  list.features.resize(2);
  list.features[0].kind = EditWind::Request::VORTEX;
  list.features[1].id = 2;
  list.features[1].kind = "none that is known";
  list.features[1].speed = list.features[1].radius = NAN;
  list.features[1].center.x = HUGE_VAL;
  winds.publish(list);
  statuses.publish(SimulationStatus());
  window_->type("node", name);
  ASSERT_TRUE(rows(2));
  choose(0);
  EXPECT_FALSE(window_->enabled("delete_feature"));
  EXPECT_TRUE(window_->enabled("delete_all_features"));
  choose(1);
  EXPECT_TRUE(window_->enabled("delete_feature"));
  EXPECT_FALSE(seen("feature_length"));
  window_->panel().repaint();
}

/// A regime by its name, as a rose and as a timeline.
TEST_F(PanelWinds, PresetsFillTheTableOfTheSchedule) {
  auto* const segments = window_->find<QTableWidget>("segments_table");
  auto* const rose = window_->find<QWidget>("wind_rose");
  const auto number = [&](int row, int column) {
    return qobject_cast<QDoubleSpinBox*>(segments->cellWidget(row, column))->value();
  };
  const auto choose_preset = [&](const QString& name) {
    for (QAction* const action : window_->find<QPushButton>("schedule_presets")->menu()->actions())
      if (action->text() == name) return action->trigger();
    ADD_FAILURE() << "there is no preset " << name.toStdString();
  };
  EXPECT_EQ(rose->property("petals").toInt(), 2) << "what the table begins with";
  choose_preset("obtuse bimodal");
  ASSERT_EQ(segments->rowCount(), 2);
  EXPECT_GT(std::abs(number(0, 0) - number(1, 0)), 90) << "obtuse";
  window_->click("apply_schedule");
  window_->type("steps", "20");
  window_->click("step");
  EXPECT_TRUE(node_has([](const SimulationStatus& s) {
    return s.step == 20 && std::abs(s.wind_above.y - 7 * std::sin(M_PI / 3)) < 1e-3;
  })) << "the first of them, after its ramp";
  EXPECT_EQ(rose->property("petals").toInt(), 2);
  choose_preset("complex (star dunes)");
  ASSERT_EQ(segments->rowCount(), 3);
  EXPECT_EQ(rose->property("petals").toInt(), 3);
  choose_preset("seasonal reversal");
  ASSERT_EQ(segments->rowCount(), 2);
  EXPECT_EQ(number(1, 0) - number(0, 0), 180);
  EXPECT_GT(number(0, 2), number(1, 2)) << "one season is longer";
  EXPECT_GT(number(0, 4), number(1, 4)) << "and its wind is drawn more often";
  window_->save("panel_rose", 1200);
  window_->click("segments_add");
  EXPECT_EQ(rose->property("petals").toInt(), 2) << "a second wind of that direction makes the petal longer";
  qobject_cast<QDoubleSpinBox*>(segments->cellWidget(2, 0))->setValue(90);
  EXPECT_EQ(rose->property("petals").toInt(), 3);
  qobject_cast<QDoubleSpinBox*>(segments->cellWidget(2, 1))->setValue(0);
  EXPECT_EQ(rose->property("petals").toInt(), 2) << "a calm";
}

}  // namespace
}  // namespace rviz_test
