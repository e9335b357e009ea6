#include "src/ros/support/xmlrpc_backlog.hpp"

#include <netinet/in.h>
#include <ros/console.h>
#include <ros/xmlrpc_manager.h>
#include <sys/socket.h>

#include <cerrno>
#include <filesystem>
#include <string>
#include <system_error>

namespace desert_sim {
namespace {

bool listens(int fd) {
  int accepts = 0;
  socklen_t size = sizeof accepts;
  return getsockopt(fd, SOL_SOCKET, SO_ACCEPTCONN, &accepts, &size) == 0 && accepts;
}

/// The port of a socket of the internet, otherwise 0.
int port_of(int fd) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  if (getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size) != 0) return 0;
  if (address.ss_family == AF_INET) return ntohs(reinterpret_cast<sockaddr_in&>(address).sin_port);
  if (address.ss_family == AF_INET6) return ntohs(reinterpret_cast<sockaddr_in6&>(address).sin6_port);
  return 0;
}

}  // namespace

void widen_xmlrpc_backlog() {
  // roscpp hides the socket, but not its port.
  const int port = ros::XMLRPCManager::instance()->getServerPort();
  std::error_code problem;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", problem)) {
    const int fd = std::stoi(entry.path().filename());
    if (!listens(fd) || port_of(fd) != port) continue;
    // listen() on a socket that listens already changes its backlog.
    if (listen(fd, SOMAXCONN) == 0) return;
    problem.assign(errno, std::generic_category());
  }
  ROS_WARN("Only five clients at a time can wait for the XML-RPC server on port %d: %s.", port,
           problem ? problem.message().c_str() : "its socket was not found");
}

}  // namespace desert_sim
