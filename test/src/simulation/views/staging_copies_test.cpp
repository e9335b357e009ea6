// Staging memory of a device that has memory of its own and copies late, played by the host.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <future>
#include <map>
#include <string>
#include <thread>

#include "kernels/backend/fft.hpp"
#include "src/core/error.hpp"
#include "src/simulation/views/staging.hpp"

namespace desert_sim {
namespace {

/// Copies one after the other, each some time after it was started.
class LateDevice final : public Exec {
 public:
  std::size_t allocated = 0, copied = 0;  ///< allocations now, bytes ever
  bool fails = false;

  const char* backend() const override { return "late"; }
  std::string device() const override { return "the host, late"; }
  std::size_t memory_available() const override { return 1 << 30; }
  void* allocate_host(std::size_t bytes) override { return allocate_memory(bytes); }
  void release_host(void* memory) noexcept override { free_memory(memory); }
  void set_zero(void* memory, std::size_t bytes) override { std::memset(memory, 0, bytes); }
  void copy(void* to, const void* from, std::size_t bytes) override { std::memcpy(to, from, bytes); }
  void upload(void* to, const void* from, std::size_t bytes) override { copy(to, from, bytes); }
  void download(void* to, const void* from, std::size_t bytes) override { copy(to, from, bytes); }
  void synchronise() override {}
  std::unique_ptr<Fft> make_fft(int, int, int) override { throw Error("no transforms here"); }

  std::unique_ptr<HostCopy> start_download(void* to, const void* from, std::size_t bytes) override {
    auto copy = std::make_unique<LateCopy>(*this);
    copied += bytes;
    copy->done = std::async(std::launch::async, [=, before = last_] {
                   if (before.valid()) before.wait();
                   std::this_thread::sleep_for(std::chrono::milliseconds(2));
                   std::memcpy(to, from, bytes);
                 }).share();
    last_ = copy->done;
    return copy;
  }
  void wait_on_device_for(const HostCopy& copy) override { static_cast<const LateCopy&>(copy).done.wait(); }

 protected:
  void* allocate_memory(std::size_t bytes) override {
    ++allocated;
    return ::operator new(bytes);
  }
  void free_memory(void* memory) noexcept override {
    --allocated;
    ::operator delete(memory);
  }

 private:
  struct LateCopy final : HostCopy {
    explicit LateCopy(LateDevice& device) : exec(device) {}
    void wait() override {
      done.wait();
      if (exec.fails) throw CudaError("the copy failed");
    }
    void fetch(void* to, const void* from, std::size_t bytes) override {
      exec.copied += bytes;
      std::memcpy(to, from, bytes);
    }
    LateDevice& exec;
    std::shared_future<void> done;
  };
  std::shared_future<void> last_;
};

/// Text that is on its way in pieces of 100, of which only the first ten bytes are sent at once.
Pending<std::string> send(Staging& staging, char letter, int pieces) {
  const auto text = std::make_shared<std::string>();
  const auto readback = std::make_shared<Readback>();
  for (int n = 0; n < pieces; ++n) {
    Staging::Slot& slot = staging.acquire(100);
    std::memset(slot.device(), letter + n, 100);
    staging.send(slot, 10, readback, [waited = std::weak_ptr<std::string>(text)](Staging::Slot& arrived) {
      if (const auto all = waited.lock()) all->append(arrived.host(100), 100);
    });
  }
  return {text, readback};
}

std::string expected(char letter, int pieces) {
  std::string text;
  for (int n = 0; n < pieces; ++n) text += std::string(100, static_cast<char>(letter + n));
  return text;
}

TEST(StagingCopies, EachReaderGetsItsOwnHoweverLateItComes) {
  LateDevice device;
  Staging staging(device);
  std::map<char, Pending<std::string>> pending;
  for (char letter = 'a'; letter < 'k'; ++letter) {
    pending[letter] = send(staging, letter, 1 + letter % 3);
    if (letter % 4 == 1) pending.erase(letter);  // nobody comes for it
  }
  EXPECT_EQ(staging.bytes(), 200u);
  for (const auto& [letter, text] : pending) EXPECT_EQ(*text.get(), expected(letter, 1 + letter % 3));
}

TEST(StagingCopies, NoMoreIsCopiedThanSomebodyAsksFor) {
  LateDevice device;
  Staging staging(device);
  const auto read = send(staging, 'a', 1);
  EXPECT_EQ(*read.get(), expected('a', 1));
  EXPECT_EQ(device.copied, 100u);
  send(staging, 'b', 1);  // dropped
  staging.release();
  EXPECT_EQ(device.copied, 110u);
}

TEST(StagingCopies, MemoryIsGivenBackAndTakenAnew) {
  LateDevice device;
  {
    Staging staging(device);
    const auto first = send(staging, 'a', 2);
    EXPECT_EQ(device.allocated, 4u) << "two slots, on both sides";
    staging.release();
    EXPECT_EQ(device.allocated, 0u);
    EXPECT_EQ(*first.get(), expected('a', 2)) << "it was brought home before";
    EXPECT_EQ(*send(staging, 'c', 3).get(), expected('c', 3));
    send(staging, 'd', 1);  // under way when the staging memory goes
  }
  EXPECT_EQ(device.allocated, 0u);
}

TEST(StagingCopies, AFailedCopyIsToldToItsReader) {
  LateDevice device;
  Staging staging(device);
  const auto lost = send(staging, 'a', 1);
  device.fails = true;
  EXPECT_THROW(lost.get(), CudaError);
  EXPECT_THROW(lost.get(), CudaError);
  device.fails = false;
  EXPECT_EQ(*send(staging, 'b', 3).get(), expected('b', 3));
}

}  // namespace
}  // namespace desert_sim
