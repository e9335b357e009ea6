// Staging memory of a device that has memory of its own and copies late, played by the host.

#include <gtest/gtest.h>

#include <cstring>
#include <deque>
#include <map>
#include <string>

#include "kernels/backend/fft.hpp"
#include "src/core/error.hpp"
#include "src/simulation/views/staging.hpp"

namespace desert_sim {
namespace {

/// Copies as late as it may: once somebody waits for a copy, after all that were started before.
class LateDevice final : public Exec {
 public:
  std::size_t allocated = 0, copied = 0;  ///< allocations now, bytes ever
  bool fails = false;

  Device device() const override { return Device::cpu; }
  std::string device_name() const override { return "the host, late"; }
  std::size_t memory_available() const override { return 1 << 30; }
  void* allocate_host(std::size_t bytes) override { return allocate_memory(bytes); }
  void release_host(void* memory) noexcept override { free_memory(memory); }
  void set_zero(void* memory, std::size_t bytes) override { std::memset(memory, 0, bytes); }
  void copy(void* to, const void* from, std::size_t bytes) override { std::memcpy(to, from, bytes); }
  void upload(void* to, const void* from, std::size_t bytes) override { copy(to, from, bytes); }
  void download(void* to, const void* from, std::size_t bytes) override { copy(to, from, bytes); }
  void synchronise() override {}
  std::unique_ptr<Fft> make_fft(int, int, int, FftMethod) override { throw Error("no transforms here"); }

  std::unique_ptr<HostCopy> start_download(void* to, const void* from, std::size_t bytes) override {
    copied += bytes;
    under_way_.push_back({to, from, bytes});
    return std::make_unique<LateCopy>(*this, ++started_);
  }
  void wait_on_device_for(const HostCopy& copy) override {
    finish(static_cast<const LateCopy&>(copy).number);
  }

 protected:
  void* allocate_memory(std::size_t bytes) override {
    ++allocated;
    return ::operator new(bytes);
  }
  void free_memory(void* memory) noexcept override {
    --allocated;
    for (const Transfer& t : under_way_)
      EXPECT_FALSE(t.to == memory || t.from == memory) << "it is freed while a copy of it is under way";
    ::operator delete(memory);
  }

 private:
  struct Transfer {
    void* to;
    const void* from;
    std::size_t bytes;
  };
  struct LateCopy final : HostCopy {
    LateCopy(LateDevice& device, std::size_t which) : exec(device), number(which) {}
    void wait() override {
      exec.finish(number);
      if (exec.fails) throw CudaError("the copy failed");
    }
    void fetch(void* to, const void* from, std::size_t bytes) override {
      exec.copied += bytes;
      std::memcpy(to, from, bytes);
    }
    LateDevice& exec;
    const std::size_t number;
  };

  /// All copies up to the one of this number.
  void finish(std::size_t number) {
    for (; finished_ < number; ++finished_) {
      const Transfer& t = under_way_.front();
      std::memcpy(t.to, t.from, t.bytes);
      under_way_.pop_front();
    }
  }

  std::deque<Transfer> under_way_;
  std::size_t started_ = 0, finished_ = 0;
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
