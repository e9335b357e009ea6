#include "src/ros/support/thread_priority.hpp"

#include <pthread.h>
#include <ros/console.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace desert_sim {

void set_name_and_niceness(const char* name, int niceness) {
  pthread_setname_np(pthread_self(), name);
  const auto thread = static_cast<id_t>(syscall(SYS_gettid));  // Linux has a niceness for each thread
  errno = 0;
  const int now = getpriority(PRIO_PROCESS, thread);
  if (errno == 0 && now >= niceness) return;
  if (setpriority(PRIO_PROCESS, thread, niceness) != 0)
    ROS_WARN("The niceness of the threads %s cannot be set to %d: %s", name, niceness, std::strerror(errno));
}

}  // namespace desert_sim
