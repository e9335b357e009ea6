#pragma once
/// The panel desert_sim/Panel with a node of its own.

#include <desert_sim/GetScenario.h>
#include <desert_sim/SimulationStatus.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <yaml-cpp/yaml.h>

#include <QApplication>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "test/src/rviz/panel_window.hpp"
#include "test/src/rviz/rviz_window.hpp"
#include "test/support/ros/child_process.hpp"

namespace rviz_test {

using desert_sim::SimulationStatus;
using node_test::Listener;
using node_test::NodeProcess;

class Panel : public testing::Test {
 public:
  /// The screen, after all suites.
  static void close() {
    delete qApp;
    delete screen_;
  }

 protected:
  static void SetUpTestSuite() {
    if (screen_) return;
    screen_ = new Screen;
    if (!screen_->problem().empty()) return;
    static int argument_count = 1;
    static char name[] = "panel_test";
    static char* arguments[] = {name, nullptr};
    new QApplication(argument_count, arguments);
  }
  void SetUp() override {
    if (!qApp) GTEST_SKIP() << screen_->problem();
    char folder[] = "/tmp/desert_panel_XXXXXX";
    data_dir_ = mkdtemp(folder);
    start();
    // The panel finds a node at once if it is there.
    ASSERT_TRUE(node_test::wait_until([] { return ros::service::exists(pause_service, false); }));
    window_ = std::make_unique<PanelWindow>(node_name);
    ASSERT_TRUE(window_->shows("state", "corner: paused")) << window_->text("state");
    statuses_ = std::make_unique<Listener<SimulationStatus>>(std::string(node_name) + "/status");
  }
  void TearDown() override {
    window_.reset();
    statuses_.reset();
    node_.reset();
    if (!data_dir_.empty()) std::filesystem::remove_all(data_dir_);
  }
  void start() {
    node_ = std::make_unique<NodeProcess>(node_name, std::map<std::string, XmlRpc::XmlRpcValue>{
                                                         {"data_dir", data_dir_}, {"status_rate", 10.0}});
  }
  /// Waits for a status of the node.
  bool node_has(const std::function<bool(const SimulationStatus&)>& fits) {
    return window_->run_until([&] { return statuses_->count() > 0 && fits(statuses_->last()); });
  }
  YAML::Node scenario() { return YAML::Load(node_->call<desert_sim::GetScenario>("get_scenario", {}).yaml); }
  bool scenario_has(const std::function<bool(const YAML::Node&)>& fits) {
    return window_->run_until([&] { return fits(scenario()); });
  }
  /// Waits until a line says in red why something was refused.
  bool refuses(const std::string& line, const std::string& reason) {
    return window_->run_until([&] { return window_->error(line).find(reason) != std::string::npos; });
  }
  QComboBox* list(const std::string& name) { return window_->find<QComboBox>(name); }

  static constexpr const char *node_name = "/panel_node", *pause_service = "/panel_node/pause";
  static inline Screen* screen_ = nullptr;
  std::string data_dir_;
  std::unique_ptr<NodeProcess> node_;
  std::unique_ptr<PanelWindow> window_;
  std::unique_ptr<Listener<SimulationStatus>> statuses_;
};

class ClosingOfPanel : public testing::Environment {
  void TearDown() override { Panel::close(); }
};

inline int run_panel_tests(int argc, char** argv, const char* name) {
  testing::InitGoogleTest(&argc, argv);
  testing::AddGlobalTestEnvironment(new ClosingOfPanel);
  ros::init(argc, argv, name, ros::init_options::NoSigintHandler);
  ros::start();
  ros::AsyncSpinner spinner(1);
  spinner.start();
  const int result = RUN_ALL_TESTS();
  ros::shutdown();
  return result;
}

}  // namespace rviz_test
