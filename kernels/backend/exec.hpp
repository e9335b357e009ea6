#pragma once
/// Where a simulation runs: memory, order of work, and (in for_each.hpp) loops over cells. CpuExec runs laws
/// as OpenMP loops; CudaExec as kernels on one non-blocking stream of its own. A second stream carries what
/// others want to see to the host, while the work goes on.

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include "desert_sim/config.hpp"

namespace desert_sim {

class Fft;

/// Work that was recorded and can be done again, with the same arguments.
class Recording {
 public:
  virtual ~Recording() = default;
  virtual void replay() = 0;
};

/// A copy to the host that runs beside other work.
class HostCopy {
 public:
  virtual ~HostCopy() = default;
  /// Returns when the copy is there; throws CudaError if it, or work before it, failed. From any thread.
  virtual void wait() = 0;
  /// Copies more of what was there when this copy began, likewise, and waits for it. From any thread, but one
  /// at a time.
  virtual void fetch(void* to, const void* from, std::size_t bytes) = 0;
};

class Exec {
 public:
  virtual ~Exec() = default;
  Exec() = default;
  Exec(const Exec&) = delete;
  Exec& operator=(const Exec&) = delete;

  virtual const char* backend() const = 0;           ///< "cpu" or "cuda"
  virtual std::string device() const = 0;            ///< what a person would call it
  virtual std::size_t memory_available() const = 0;  ///< bytes that an allocation may hope for

  /// Uninitialised memory on the device; throws ConfigError if there is not enough. Not for use inside a
  /// step. `release` is told as many bytes as were allocated.
  void* allocate(std::size_t bytes) {
    void* memory = take(bytes);
    bytes_held_ += bytes;
    return memory;
  }
  void release(void* memory, std::size_t bytes) noexcept {
    give_back(memory);
    bytes_held_ -= bytes;
  }
  /// What was allocated on the device and not released, less what transforms take for themselves.
  std::size_t bytes_held() const { return bytes_held_; }
  /// Host memory that copies to and from the device fast (pinned on a GPU).
  virtual void* allocate_host(std::size_t bytes) = 0;
  virtual void release_host(void* memory) noexcept = 0;
  /// Whether the memory of allocate() is the host's own: what laws write there can be read without a copy.
  virtual bool shares_memory() const { return false; }

  /// In order with the laws that were started before.
  virtual void set_zero(void* memory, std::size_t bytes) = 0;
  virtual void copy(void* to, const void* from, std::size_t bytes) = 0;  ///< device to device
  virtual void upload(void* to, const void* from,
                      std::size_t bytes) = 0;  ///< returns when `from` may be reused
  virtual void download(void* to, const void* from, std::size_t bytes) = 0;  ///< returns when `to` is filled

  /// Starts a copy to memory of allocate_host() (or, where memory is shared, none from a place to itself),
  /// which waits for all that was started before, and which all that is started later does not wait for. Not
  /// for use inside a step. Unless a backend has another way, it is done when this returns.
  virtual std::unique_ptr<HostCopy> start_download(void* to, const void* from, std::size_t bytes);
  /// What is started from here on waits for `copy`, which is one of this Exec's.
  virtual void follow(const HostCopy&) {}

  /// Whether recording work is worth it here.
  virtual bool records() const { return false; }
  /// Calls `work` and notes the laws, copies on the device, transforms and loops that it starts, instead of
  /// doing them. It must not read anything back. Only where records().
  virtual std::unique_ptr<Recording> record(const std::function<void()>& work);

  /// Calls `body`, which starts the same each time, no transforms, and reads nothing back, again and again
  /// while the word `*go_on` on the device, which it changes, is not 0. The host looks before each turn, or in
  /// a recording the device itself.
  virtual void repeat_while(const long long* go_on, const std::function<void()>& body);
  /// Whether a recording may hold that.
  virtual bool records_repeats() const { return false; }

  /// Waits for all that was started but copies of start_download(); throws CudaError if any of it failed.
  virtual void synchronise() = 0;

  /// A complex 2-D transform of width × height (x fastest), in place, unnormalised; of `fields` of them at once.
  virtual std::unique_ptr<Fft> make_fft(int width, int height, int fields = 1) = 0;
  /// Shared memory that a kernel may take which transforms lines by itself (wind::by_lines()) [bytes]; 0 where
  /// there is none.
  virtual std::size_t memory_for_lines() const { return 0; }

 protected:
  virtual void* take(std::size_t bytes) = 0;
  virtual void give_back(void* memory) noexcept = 0;

 private:
  std::atomic<std::size_t> bytes_held_{0};
};

/// What the host's memory can still take [bytes], within the limit of its control group.
std::size_t host_memory_available();

class CpuExec final : public Exec {
 public:
  /// `threads` ≥ 1, or 0 for as many as there are processors.
  explicit CpuExec(int threads = 0);
  int threads() const { return threads_; }

  const char* backend() const override { return "cpu"; }
  std::string device() const override;
  std::size_t memory_available() const override { return host_memory_available(); }
  void* allocate_host(std::size_t bytes) override { return take(bytes); }
  void release_host(void* memory) noexcept override { give_back(memory); }
  void set_zero(void* memory, std::size_t bytes) override;
  void copy(void* to, const void* from, std::size_t bytes) override;
  void upload(void* to, const void* from, std::size_t bytes) override { copy(to, from, bytes); }
  void download(void* to, const void* from, std::size_t bytes) override { copy(to, from, bytes); }
  bool shares_memory() const override { return true; }
  void synchronise() override {}
  std::unique_ptr<Fft> make_fft(int width, int height, int fields) override;

 protected:
  void* take(std::size_t bytes) override;
  void give_back(void* memory) noexcept override;

 private:
  int threads_;
};

#if DESERT_WITH_CUDA
class CudaExec final : public Exec {
 public:
  /// Takes the current device; throws CudaError if there is none.
  CudaExec();
  ~CudaExec() override;
  /// The stream that all work but copies of start_download() goes to (a cudaStream_t); in a loop that is being
  /// recorded, the loop's.
  void* stream() const { return stream_; }

  const char* backend() const override { return "cuda"; }
  std::string device() const override;
  std::size_t memory_available() const override;
  void* allocate_host(std::size_t bytes) override;
  void release_host(void* memory) noexcept override;
  void set_zero(void* memory, std::size_t bytes) override;
  void copy(void* to, const void* from, std::size_t bytes) override;
  void upload(void* to, const void* from, std::size_t bytes) override;
  void download(void* to, const void* from, std::size_t bytes) override;
  std::unique_ptr<HostCopy> start_download(void* to, const void* from, std::size_t bytes) override;
  void follow(const HostCopy& copy) override;
  void synchronise() override;
  bool records() const override { return true; }
  std::unique_ptr<Recording> record(const std::function<void()>& work) override;
  void repeat_while(const long long* go_on, const std::function<void()>& body) override;
  bool records_repeats() const override;
  std::unique_ptr<Fft> make_fft(int width, int height, int fields) override;
  std::size_t memory_for_lines() const override;

  /// One 64-bit word on the device and its pinned mirror, for reductions.
  long long* reduction_word() const { return reduction_word_; }
  long long read_reduction_word();

 protected:
  void* take(std::size_t bytes) override;
  void give_back(void* memory) noexcept override;

 private:
  void* stream_ = nullptr;
  void* copy_stream_ = nullptr;
  void* before_copy_ = nullptr;  ///< a cudaEvent_t: the work that a copy waits for
  long long* reduction_word_ = nullptr;
  long long* reduction_host_ = nullptr;
};
#endif

/// Calls body(exec) with the backend's own type, for which the processes are compiled.
template <class Body>
auto with_backend(Exec& exec, Body&& body) {
#if DESERT_WITH_CUDA
  if (auto* cuda = dynamic_cast<CudaExec*>(&exec)) return body(*cuda);
#endif
  return body(static_cast<CpuExec&>(exec));
}

/// Whether a CUDA device can be used, and if not, why.
struct CudaStatus {
  bool usable = false;
  std::string reason;
};
CudaStatus cuda_status();

/// "auto", "cpu" or "cuda". `auto` takes CUDA where it is usable; `cuda` without a device throws ConfigError.
/// `why`, if given, gets a sentence on what was taken.
std::unique_ptr<Exec> make_exec(const std::string& backend, int threads = 0, std::string* why = nullptr);

}  // namespace desert_sim
