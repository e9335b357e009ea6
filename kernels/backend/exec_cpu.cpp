#include <omp.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <new>

#include "kernels/backend/exec.hpp"
#include "kernels/backend/instruction_set.hpp"
#include "src/core/error.hpp"
#include "src/core/host_memory.hpp"

namespace desert_sim {

namespace {

/// A copy that was complete when it was started.
class CompletedCopy final : public HostCopy {
 public:
  explicit CompletedCopy(Exec& exec) : exec_(exec) {}
  void wait() override {}
  void fetch(void* to, const void* from, std::size_t bytes) override {
    if (to != from) exec_.download(to, from, bytes);
  }

 private:
  Exec& exec_;
};

constexpr std::size_t alignment = 64;  // a cache line, and a vector of AVX-512

/// Calls work(begin, size) for parts of 64 KiB; all threads take part if there is more than one part.
template <class Work>
void for_each_chunk(std::size_t bytes, int threads, const Work& work) {
  const std::ptrdiff_t part = 1 << 16, parts = (static_cast<std::ptrdiff_t>(bytes) + part - 1) / part;
#pragma omp parallel for schedule(static) num_threads(threads) if (parts > 1)
  for (std::ptrdiff_t n = 0; n < parts; ++n) {
    const std::size_t begin = static_cast<std::size_t>(n * part);
    work(begin, std::min(static_cast<std::size_t>(part), bytes - begin));
  }
}

}  // namespace

CpuExec::CpuExec(int threads) : threads_(threads > 0 ? threads : omp_get_num_procs()) {
  const std::string problem = problem_with_instructions();
  if (!problem.empty()) throw ConfigError(problem);
}

std::string CpuExec::device_name() const {
  std::ifstream info("/proc/cpuinfo");
  std::string line, name = "CPU";
  while (std::getline(info, line))
    if (line.rfind("model name", 0) == 0) {
      name = line.substr(line.find(':') + 2);
      break;
    }
  return name + ", " + std::to_string(threads_) + (threads_ == 1 ? " thread" : " threads");
}

std::size_t CpuExec::memory_available() const { return host_memory_available(); }

void* CpuExec::allocate_memory(std::size_t bytes) {
  void* memory = ::operator new(bytes, std::align_val_t(alignment), std::nothrow);
  if (!memory) throw ConfigError("no memory for " + std::to_string(bytes) + " bytes");
  return memory;
}

void CpuExec::free_memory(void* memory) noexcept { ::operator delete(memory, std::align_val_t(alignment)); }

void CpuExec::set_zero(void* memory, std::size_t bytes) {
  for_each_chunk(bytes, threads_, [=](std::size_t begin, std::size_t size) {
    std::memset(static_cast<char*>(memory) + begin, 0, size);
  });
}

void CpuExec::copy(void* to, const void* from, std::size_t bytes) {
  for_each_chunk(bytes, threads_, [=](std::size_t begin, std::size_t size) {
    std::memcpy(static_cast<char*>(to) + begin, static_cast<const char*>(from) + begin, size);
  });
}

std::unique_ptr<HostCopy> Exec::start_download(void* to, const void* from, std::size_t bytes) {
  auto done = std::make_unique<CompletedCopy>(*this);
  done->fetch(to, from, bytes);
  return done;
}

void Exec::repeat_while(const long long* go_on, const std::function<void()>& body) {
  for (;;) {
    long long word = 0;
    download(&word, go_on, sizeof word);
    if (word == 0) return;
    body();
  }
}

std::unique_ptr<Recording> Exec::record(const std::function<void()>&) {
  throw Error(std::string("backend ") + backend() + " records nothing");
}

std::unique_ptr<Exec> make_exec(const std::string& backend, int threads, std::string* why,
                                [[maybe_unused]] Precedence precedence) {
  const auto say = [&](const std::string& reason) {
    if (why) *why = reason;
  };
  if (backend != "auto" && backend != "cpu" && backend != "cuda")
    throw ConfigError("backend '" + backend + "' is not one of auto, cpu, cuda");
  if (backend == "cpu") {
    say("cpu, as asked");
    return std::make_unique<CpuExec>(threads);
  }
  const CudaStatus cuda = cuda_status();
#if DESERT_WITH_CUDA
  if (cuda.usable) {
    say(backend == "auto" ? "cuda, because there is a device" : "cuda, as asked");
    return std::make_unique<CudaExec>(precedence);
  }
#endif
  if (backend == "cuda") throw ConfigError("backend cuda: " + cuda.reason);
  say("cpu, because " + cuda.reason);
  return std::make_unique<CpuExec>(threads);
}

#if !DESERT_WITH_CUDA
CudaStatus cuda_status() { return {false, "this build has no CUDA"}; }
#endif

}  // namespace desert_sim
