/// The nodelet in a manager, which is this process: what subscribers beside it are given, and how it ends.
#include <desert_sim/ElevationGrid.h>
#include <desert_sim/SetWind.h>
#include <desert_sim/SimulationStatus.h>
#include <diagnostic_msgs/DiagnosticArray.h>
#include <nodelet/loader.h>

#include <atomic>
#include <cstdlib>
#include <map>
#include <new>

#include "test/support/full_disk.hpp"
#include "test/support/ros/service_tests.hpp"
#include "test/support/temporary_folder.hpp"

// ---- who allocates large memory, in this process ----------------------------------------------------------
namespace {

constexpr int width = 300, height = 200;
constexpr std::size_t grid_bytes = width * height * sizeof(float);

struct Allocation {
  void* memory;
  pthread_t thread;
};
Allocation allocations[4096];
std::atomic<std::size_t> allocation_count{0};

void note(void* memory, std::size_t bytes) {
  if (bytes < grid_bytes) return;
  const std::size_t n = allocation_count++;
  if (n < std::size(allocations)) allocations[n] = {memory, pthread_self()};
}

}  // namespace

#if defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define DESERT_THREAD_SANITIZER
#endif
#endif
#ifdef DESERT_THREAD_SANITIZER
// It has operators of its own, which cannot be replaced, and tells of all allocations.
#include <sanitizer/allocator_interface.h>
namespace {
const int told = __sanitizer_install_malloc_and_free_hooks(
    [](const volatile void* memory, std::size_t bytes) { note(const_cast<void*>(memory), bytes); },
    [](const volatile void*) {});
}  // namespace
#else
// Out of line: the compiler takes free() in place of delete for a mistake.
#define DESERT_APART __attribute__((noinline))
DESERT_APART void* operator new(std::size_t bytes) {
  void* memory = std::malloc(bytes ? bytes : 1);
  if (!memory) throw std::bad_alloc();
  note(memory, bytes);
  return memory;
}
DESERT_APART void* operator new[](std::size_t bytes) { return operator new(bytes); }
DESERT_APART void operator delete(void* memory) noexcept { std::free(memory); }
DESERT_APART void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
DESERT_APART void operator delete[](void* memory) noexcept { std::free(memory); }
DESERT_APART void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
#endif

namespace {

using namespace desert_sim;
using namespace node_test;

/// Keeps the messages themselves, not copies, and which thread they came on.
class SharedListener {
 public:
  SharedListener()
      : subscriber_(ros::NodeHandle().subscribe<ElevationGrid>(
            "/desert_sim/elevation", 10,
            boost::function<void(const ElevationGridConstPtr&)>([this](const ElevationGridConstPtr& m) {
              const std::lock_guard<std::mutex> lock(mutex_);
              by_step_[m->step] = m;
              threads_.push_back(pthread_self());
            }))) {}
  ElevationGridConstPtr at(std::uint64_t step) {
    EXPECT_TRUE(wait_until([&] { return has(step); })) << "no keyframe of step " << step;
    const std::lock_guard<std::mutex> lock(mutex_);
    return by_step_[step];
  }
  std::vector<pthread_t> threads() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return threads_;
  }

 private:
  bool has(std::uint64_t step) {
    const std::lock_guard<std::mutex> lock(mutex_);
    return by_step_.count(step) > 0;
  }
  std::mutex mutex_;
  std::map<std::uint64_t, ElevationGridConstPtr> by_step_;
  std::vector<pthread_t> threads_;
  ros::Subscriber subscriber_;
};

class Nodelets : public testing::Test {
 protected:
  void TearDown() override { loader_.clear(); }

  bool load(const XmlRpc::XmlRpcValue& extra = {}, const std::string& name = "/desert_sim") {
    XmlRpc::XmlRpcValue p = extra;
    p["backend"] = "cpu";
    p["threads"] = 1;
    p["keyframe_rate"] = 0;
    if (!p.hasMember("scenario")) p["scenario"] = "barchan";
    if (!p.hasMember("paused")) p["paused"] = true;
    p["settings"][0] = "grid.width=" + std::to_string(width);
    p["settings"][1] = "grid.height=" + std::to_string(height);
    ros::param::set(name, p);
    return loader_.load(name, "desert_sim/DesertSimNodelet", {}, {});
  }
  nodelet::Loader loader_{false};
  std::mutex mutex_;
};

TEST_F(Nodelets, SubscribersBesideItSeeThePublishersBuffer) {
  ASSERT_TRUE(load());
  // What a step and its keyframe allocate for one subscriber, and for three: three layers for the hash, the
  // words and the heights of the surface, and the message.
  std::size_t allocated[2];
  for (int round = 0; round < 2; ++round) {
    SharedListener first;
    first.at(static_cast<std::uint64_t>(round));
    std::unique_ptr<SharedListener> more[2];
    if (round == 1)
      for (auto& listener : more) listener = std::make_unique<SharedListener>();
    allocation_count = 0;
    const std::uint64_t now = step(1).step;
    const ElevationGridConstPtr message = first.at(now);
    ASSERT_EQ(message->elevation.size() * sizeof(float), grid_bytes);
    for (auto& listener : more)
      if (listener) {
        EXPECT_EQ(listener->at(now)->elevation.data(), message->elevation.data());
      }
    allocated[round] = allocation_count;
    bool found = false;
    for (std::size_t n = 0; n < allocated[round]; ++n) {
      for (const pthread_t thread : first.threads())
        EXPECT_FALSE(pthread_equal(thread, allocations[n].thread)) << "a subscriber's thread made a copy";
      found |= allocations[n].memory == message->elevation.data();
    }
    EXPECT_TRUE(found) << "the buffer is not one that the publishing thread made";
  }
  EXPECT_EQ(allocated[0], allocated[1]) << "subscribers cost copies";
  EXPECT_LE(allocated[0], 6u) << "copies on the way from the terrain to the message";
}

TEST_F(Nodelets, APublishedMessageNeverChanges) {
  ASSERT_TRUE(load());
  SharedListener listener;
  const ElevationGridConstPtr message = listener.at(0);
  const ElevationGrid copy = *message;
  const std::uint64_t now = step(5).step;
  EXPECT_NE(listener.at(now)->elevation, copy.elevation) << "the terrain moved";
  EXPECT_EQ(message->elevation, copy.elevation);
  EXPECT_EQ(message->header.seq, copy.header.seq);
}

TEST_F(Nodelets, RefusedInputIsNoEndOfTheManager) {
  XmlRpc::XmlRpcValue bad;
  bad["scenario"] = "no_such_desert";
  EXPECT_FALSE(load(bad, "/refused"));
  EXPECT_TRUE(load());
  EXPECT_EQ(step(2).step, 2u);
}

TEST_F(Nodelets, AFailureStopsItAloneAndIsTold) {
  const desert_sim::test::TemporaryFolder folder;
  XmlRpc::XmlRpcValue with_journal;
  with_journal["journal"] = folder.path("journal");
  with_journal["diagnostic_period"] = 0.05;
  ASSERT_TRUE(load(with_journal));
  EXPECT_TRUE(call<SetWind>("set_wind").success);
  std::string diagnosed;
  const auto diagnostics = ros::NodeHandle().subscribe<diagnostic_msgs::DiagnosticArray>(
      "/diagnostics", 10,
      boost::function<void(const diagnostic_msgs::DiagnosticArrayConstPtr&)>([&](const auto& message) {
        const std::lock_guard<std::mutex> lock(mutex_);
        for (const auto& status : message->status)
          if (status.level == diagnostic_msgs::DiagnosticStatus::ERROR)
            diagnosed = status.name + " " + status.message;
      }));
  {
    const desert_sim::test::FullDisk disk(1);
    EXPECT_FALSE(call<SetWind>("set_wind").success);
  }
  Listener<SimulationStatus> late("status");
  ASSERT_TRUE(wait_until([&] { return late.last().state == "error"; }));
  EXPECT_NE(late.last().message.find("the journal cannot be written"), std::string::npos)
      << late.last().message;
  const SetWind::Response refused = call<SetWind>("set_wind");
  EXPECT_FALSE(refused.success);
  EXPECT_NE(refused.message.find("the journal cannot be written"), std::string::npos) << refused.message;
  EXPECT_TRUE(wait_until([&] {
    const std::lock_guard<std::mutex> lock(mutex_);
    return diagnosed.find("the journal cannot be written") != std::string::npos;
  })) << "/diagnostics says: "
      << diagnosed;
  ASSERT_TRUE(loader_.unload("/desert_sim"));
  ASSERT_TRUE(load()) << "the manager lives, and takes it again";
  EXPECT_EQ(step(1).step, 1u);
}

TEST_F(Nodelets, UnloadsWhileItRunsAndServes) {
  XmlRpc::XmlRpcValue running;
  running["paused"] = false;
  running["step_rate"] = 1e-6;  // one step of its own; all others are of the request
  running["status_rate"] = 100;
  ASSERT_TRUE(load(running));
  Listener<SimulationStatus> statuses("status");
  std::thread client([] {
    Step exchange;
    exchange.request.steps = 4000000000u;  // more than there is time for
    EXPECT_FALSE(call_service("/desert_sim/step", exchange) && exchange.response.success);
  });
  const bool serves =
      statuses.wait_for([](const SimulationStatus& s) { return s.state == "running" && s.step > 1; });
  EXPECT_TRUE(serves);
  EXPECT_TRUE(loader_.unload("/desert_sim"));
  client.join();
}

}  // namespace

int main(int argc, char** argv) { return node_test::run_tests(argc, argv, "nodelets"); }
