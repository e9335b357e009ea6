// The panel desert_sim/Panel when its ROS master ends and another one is started. The master is this
// program's own.

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <ros/master.h>
#include <ros/ros.h>
#include <sys/socket.h>

#include <QApplication>
#include <QTabWidget>
#include <csignal>
#include <cstdlib>

#include "test/src/rviz/panel_window.hpp"
#include "test/src/rviz/rviz_window.hpp"
#include "test/support/ros/child_process.hpp"

namespace rviz_test {
namespace {

using node_test::ChildProcess;
using node_test::NodeProcess;

std::string free_port() {
  const int socket_number = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  const bool found = bind(socket_number, reinterpret_cast<sockaddr*>(&address), size) == 0 &&
                     getsockname(socket_number, reinterpret_cast<sockaddr*>(&address), &size) == 0;
  close(socket_number);
  return found ? std::to_string(ntohs(address.sin_port)) : "";
}

std::string port;

std::unique_ptr<ChildProcess> start_master() {
  return std::make_unique<ChildProcess>(std::vector<std::string>{"rosmaster", "--core", "-p", port});
}

/// Its status comes often: a panel that hears nothing for a while looks for the node.
std::unique_ptr<NodeProcess> start_node() {
  return std::make_unique<NodeProcess>("/panel_node",
                                       std::map<std::string, XmlRpc::XmlRpcValue>{{"status_rate", 20.0}});
}

TEST(Panel, GoesOnWithoutAndWithAnotherMaster) {
  auto master = start_master();
  ASSERT_TRUE(node_test::wait_until([] { return ros::master::check(); })) << "rosmaster does not start";
  ros::start();
  const Screen screen;
  if (!screen.problem().empty()) GTEST_SKIP() << screen.problem();
  int argument_count = 1;
  char name[] = "panel_master_test";
  char* arguments[] = {name, nullptr};
  const QApplication application(argument_count, arguments);
  auto node = start_node();
  PanelWindow window("/panel_node");
  ASSERT_TRUE(window.shows("state", "corner: paused")) << window.text("state");

  // Who waited for the master in Qt's thread would wait for ever: this test starts another one later.
  master->end(SIGKILL);
  EXPECT_TRUE(window.run_until([&] {
    if (window.text("run_error").empty()) window.click("reset");
    return !window.error("run_error").empty();
  }));
  EXPECT_NE(window.error("run_error").find("master"), std::string::npos) << window.error("run_error");
  EXPECT_EQ(window.text("state"), "corner: paused") << "the status still comes";
  node->end(SIGKILL);
  EXPECT_TRUE(window.shows("state", "no ROS master")) << window.text("state");

  master = start_master();
  ASSERT_TRUE(window.run_until([] { return ros::master::check(); }));
  EXPECT_TRUE(window.shows("state", "/panel_node is not there")) << window.text("state");
  node = start_node();
  EXPECT_TRUE(window.shows("state", "corner: paused")) << window.text("state");
  window.click("step");
  EXPECT_TRUE(window.shows("progress", "step 1,"));
}

}  // namespace
}  // namespace rviz_test

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  rviz_test::port = rviz_test::free_port();
  setenv("ROS_MASTER_URI", ("http://localhost:" + rviz_test::port).c_str(), 1);
  setenv("ROS_HOSTNAME", "localhost", 1);
  ros::init(argc, argv, "panel_master_test", ros::init_options::NoSigintHandler);
  const int result = RUN_ALL_TESTS();
  ros::shutdown();
  return result;
}
