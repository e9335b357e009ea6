#pragma once
/// Execution on a backend: device memory, copies, the order of work and, in for_each.hpp, loops over cells.
/// CpuExec runs laws as OpenMP loops; CudaExec runs them as kernels on a non-blocking stream of its own. A
/// second stream copies results to the host while the simulation goes on.

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include "desert_sim/config.hpp"
#include "kernels/backend/fft.hpp"

namespace desert_sim {

/// Recorded work that can be replayed with the same arguments.
class Recording {
 public:
  virtual ~Recording() = default;
  virtual void replay() = 0;
};

/// An asynchronous copy to the host.
class HostCopy {
 public:
  virtual ~HostCopy() = default;
  /// Waits until the copy is complete. Throws CudaError if it, or work before it, failed. May be called from
  /// any thread.
  virtual void wait() = 0;
  /// Copies more data, of the same state as this copy, and waits for it. May be called from any thread, but
  /// only from one at a time.
  virtual void fetch(void* to, const void* from, std::size_t bytes) = 0;
};

/// Whose work goes first where several Execs share a GPU. (On the CPU the operating system decides, by the
/// priority of threads.)
enum class Precedence { first, last };

/// Where work is done. Memory that is only planned is nowhere.
enum class Device : int { cpu, cuda, none };
constexpr const char* device_names[] = {"cpu", "cuda", "none"};

class Exec {
 public:
  virtual ~Exec() = default;
  Exec() = default;
  Exec(const Exec&) = delete;
  Exec& operator=(const Exec&) = delete;

  virtual Device device() const = 0;
  const char* backend() const { return device_names[static_cast<int>(device())]; }  ///< "cpu" or "cuda"
  virtual std::string device_name() const = 0;       ///< name of the device for display
  virtual std::size_t memory_available() const = 0;  ///< free memory [bytes]

  /// Allocates uninitialised memory on the device; throws ConfigError if there is not enough. Not for use
  /// inside a step. release() must be given the same number of bytes.
  void* allocate(std::size_t bytes) {
    void* memory = allocate_memory(bytes);
    bytes_held_ += bytes;
    return memory;
  }
  void release(void* memory, std::size_t bytes) noexcept {
    free_memory(memory);
    bytes_held_ -= bytes;
  }
  /// Memory that is allocated on the device [bytes], not counting what FFT libraries allocate for themselves.
  std::size_t bytes_held() const { return bytes_held_; }
  /// Host memory for fast copies to and from the device (pinned on a GPU).
  virtual void* allocate_host(std::size_t bytes) = 0;
  virtual void release_host(void* memory) noexcept = 0;
  /// Whether allocate() returns host memory, so that results can be read without a copy.
  virtual bool shares_memory() const { return false; }

  /// These run in order with the work that was started before them.
  virtual void set_zero(void* memory, std::size_t bytes) = 0;
  virtual void copy(void* to, const void* from, std::size_t bytes) = 0;  ///< device to device
  virtual void upload(void* to, const void* from,
                      std::size_t bytes) = 0;  ///< returns when `from` may be reused
  virtual void download(void* to, const void* from, std::size_t bytes) = 0;  ///< returns when `to` is filled

  /// Starts a copy to memory of allocate_host(). The copy waits for all work started before it; work started
  /// later does not wait for the copy. Where memory is shared, `to` may be `from`, and nothing is copied. Not
  /// for use inside a step. By default, the copy is complete when this returns.
  virtual std::unique_ptr<HostCopy> start_download(void* to, const void* from, std::size_t bytes);
  /// Makes all work that is started from here on wait for `copy`, which must be of this Exec.
  virtual void wait_on_device_for(const HostCopy&) {}

  /// Whether recording work is worthwhile on this backend.
  virtual bool can_record() const { return false; }
  /// Calls `work`, and records the laws, device copies, transforms and loops that it starts instead of
  /// executing them. `work` must not read results back. Only where can_record() is true.
  virtual std::unique_ptr<Recording> record(const std::function<void()>& work);

  /// Repeats `body` while the word `*go_on` on the device, which `body` changes, is not 0. `body` must start
  /// the same work each time, no transforms, and must not read results back. The host reads the word before
  /// each repetition; in a recording the device does.
  virtual void repeat_while(const long long* go_on, const std::function<void()>& body);
  /// Whether a recording may contain repeat_while().
  virtual bool can_record_loops() const { return false; }

  /// Waits for all work except the copies of start_download(); throws CudaError if any of it failed.
  virtual void synchronise() = 0;

  /// A complex 2-D transform of width × height values (x fastest), in place and unnormalised, of `fields`
  /// fields at once.
  virtual std::unique_ptr<Fft> make_fft(int width, int height, int fields, FftMethod method) = 0;
  /// Shared memory available to a kernel that transforms lines by itself (wind::Workspace::in_one_kernel)
  /// [bytes]; 0 if the device does not support such kernels.
  virtual std::size_t memory_for_lines() const { return 0; }

 protected:
  virtual void* allocate_memory(std::size_t bytes) = 0;
  virtual void free_memory(void* memory) noexcept = 0;

 private:
  std::atomic<std::size_t> bytes_held_{0};
};

class CpuExec : public Exec {
 public:
  /// `threads` ≥ 1, or 0 for one thread per processor.
  explicit CpuExec(int threads = 0);
  int threads() const { return threads_; }

  Device device() const override { return Device::cpu; }
  std::string device_name() const override;
  std::size_t memory_available() const override;
  void* allocate_host(std::size_t bytes) override { return allocate_memory(bytes); }
  void release_host(void* memory) noexcept override { free_memory(memory); }
  void set_zero(void* memory, std::size_t bytes) override;
  void copy(void* to, const void* from, std::size_t bytes) override;
  void upload(void* to, const void* from, std::size_t bytes) override { copy(to, from, bytes); }
  void download(void* to, const void* from, std::size_t bytes) override { copy(to, from, bytes); }
  bool shares_memory() const override { return true; }
  void synchronise() override {}
  std::unique_ptr<Fft> make_fft(int width, int height, int fields, FftMethod method) override;

 protected:
  void* allocate_memory(std::size_t bytes) override;
  void free_memory(void* memory) noexcept override;

 private:
  int threads_;
};

#if DESERT_WITH_CUDA
class CudaExec final : public Exec {
 public:
  /// Uses the current device; throws CudaError if there is none.
  explicit CudaExec(Precedence precedence = Precedence::first);
  ~CudaExec() override;
  /// The stream (a cudaStream_t) of all work except the copies of start_download(). While a loop is being
  /// recorded, it is the stream of the loop's body.
  void* stream() const { return stream_; }

  Device device() const override { return Device::cuda; }
  std::string device_name() const override;
  std::size_t memory_available() const override;
  void* allocate_host(std::size_t bytes) override;
  void release_host(void* memory) noexcept override;
  void set_zero(void* memory, std::size_t bytes) override;
  void copy(void* to, const void* from, std::size_t bytes) override;
  void upload(void* to, const void* from, std::size_t bytes) override;
  void download(void* to, const void* from, std::size_t bytes) override;
  std::unique_ptr<HostCopy> start_download(void* to, const void* from, std::size_t bytes) override;
  void wait_on_device_for(const HostCopy& copy) override;
  void synchronise() override;
  bool can_record() const override { return true; }
  std::unique_ptr<Recording> record(const std::function<void()>& work) override;
  void repeat_while(const long long* go_on, const std::function<void()>& body) override;
  bool can_record_loops() const override;
  std::unique_ptr<Fft> make_fft(int width, int height, int fields, FftMethod method) override;
  std::size_t memory_for_lines() const override;
  /// The most shared memory that a thread block may ask for [bytes].
  std::size_t shared_memory_of_a_block() const;

  /// A 64-bit word on the device for results of reductions, with a pinned mirror on the host.
  long long* reduction_word() const { return reduction_word_; }
  long long read_reduction_word();

 protected:
  void* allocate_memory(std::size_t bytes) override;
  void free_memory(void* memory) noexcept override;

 private:
  void* make_stream() const;

  const Precedence precedence_;
  void* stream_ = nullptr;
  void* copy_stream_ = nullptr;
  void* before_copy_ = nullptr;  ///< a cudaEvent_t behind the work that a copy waits for
  long long* reduction_word_ = nullptr;
  long long* reduction_host_ = nullptr;
};
#endif

/// Calls body(exec) with the backend's concrete type, for which the processes are compiled.
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

/// Makes the Exec for `backend` = "auto", "cpu" or "cuda". "auto" uses CUDA where possible; "cuda" without a
/// usable device throws ConfigError. `why`, if given, receives the reason for the choice.
std::unique_ptr<Exec> make_exec(const std::string& backend, int threads = 0, std::string* why = nullptr,
                                Precedence precedence = Precedence::first);

}  // namespace desert_sim
