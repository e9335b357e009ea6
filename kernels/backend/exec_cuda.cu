#include <cuda_runtime.h>

#include <cstdio>
#include <cstring>
#include <utility>

#include "kernels/backend/for_each_cuda.cuh"
#include "src/core/error.hpp"
#include "src/core/log.hpp"

namespace desert_sim {

namespace {

cudaStream_t as_stream(void* stream) { return static_cast<cudaStream_t>(stream); }
cudaEvent_t as_event(void* event) { return static_cast<cudaEvent_t>(event); }

/// Logs a failure; for destructors and release functions, which must not throw.
void log_failure(cudaError_t status, const char* what) noexcept {
  if (status != cudaSuccess) log_error(std::string("CUDA: ") + what + ": " + cudaGetErrorString(status));
}

/// A copy on the stream for copies. A thread that waits for its event sleeps instead of spinning, because it
/// is not in a hurry.
class CudaCopy final : public HostCopy {
 public:
  explicit CudaCopy(cudaStream_t stream) : stream_(stream) {
    check_cuda(cudaEventCreateWithFlags(&done_, cudaEventDisableTiming | cudaEventBlockingSync),
               "making an event");
  }
  ~CudaCopy() override { log_failure(cudaEventDestroy(done_), "ending an event"); }
  void start(void* to, const void* from, std::size_t bytes) {
    check_cuda(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToHost, stream_), "copy to the host");
    check_cuda(cudaEventRecord(done_, stream_), "marking a copy's end");
  }
  void wait() override { check_cuda(cudaEventSynchronize(done_), "waiting for a copy"); }
  void fetch(void* to, const void* from, std::size_t bytes) override {
    start(to, from, bytes);
    wait();
  }
  cudaEvent_t done() const { return done_; }

 private:
  cudaStream_t stream_;
  cudaEvent_t done_ = nullptr;
};

/// A CUDA graph, captured from a stream.
class GraphRecording final : public Recording {
 public:
  GraphRecording(cudaStream_t stream, const std::function<void()>& work) : stream_(stream) {
    check_cuda(cudaStreamBeginCapture(stream, cudaStreamCaptureModeThreadLocal), "beginning a recording");
    cudaGraph_t graph = nullptr;
    try {
      work();
    } catch (...) {
      cudaStreamEndCapture(stream, &graph);  // the exception that is under way is what is reported
      if (graph) cudaGraphDestroy(graph);
      throw;
    }
    check_cuda(cudaStreamEndCapture(stream, &graph), "ending a recording");
    const cudaError_t made = cudaGraphInstantiateWithFlags(&executable_, graph, 0);
    cudaGraphDestroy(graph);
    check_cuda(made, "making a graph");
  }
  ~GraphRecording() override {
    log_failure(cudaStreamSynchronize(stream_), "waiting for a graph");
    log_failure(cudaGraphExecDestroy(executable_), "ending a graph");
  }
  void replay() override { check_cuda(cudaGraphLaunch(executable_, stream_), "launch of a graph"); }

 private:
  cudaStream_t stream_;
  cudaGraphExec_t executable_ = nullptr;
};

#if CUDART_VERSION >= 13000  // the first version in which these functions have these arguments
__global__ void set_loop_condition(cudaGraphConditionalHandle condition, const long long* go_on) {
  cudaGraphSetConditional(condition, *go_on != 0);
}

/// Adds a while loop (a conditional node) to the graph that is captured from `stream`. The loop's body is
/// what `body` sends to `body_stream`.
void add_while_node(cudaStream_t stream, cudaStream_t body_stream, const long long* go_on,
                    const std::function<void()>& body) {
  const char* const what = "recording a loop";
  cudaStreamCaptureStatus status;
  unsigned long long id = 0;
  cudaGraph_t graph = nullptr;
  const auto info = [&](const cudaGraphNode_t** before, const cudaGraphEdgeData** edges, std::size_t* count) {
    check_cuda(cudaStreamGetCaptureInfo(stream, &status, &id, &graph, before, edges, count), what);
  };
  info(nullptr, nullptr, nullptr);
  cudaGraphConditionalHandle condition;
  check_cuda(cudaGraphConditionalHandleCreate(&condition, graph, 0, cudaGraphCondAssignDefault), what);
  set_loop_condition<<<1, 1, 0, stream>>>(condition, go_on);
  check_cuda(cudaGetLastError(), what);
  const cudaGraphNode_t* before = nullptr;
  const cudaGraphEdgeData* edges = nullptr;
  std::size_t count = 0;
  info(&before, &edges, &count);
  cudaGraphNodeParams loop{};
  loop.type = cudaGraphNodeTypeConditional;
  loop.conditional.handle = condition;
  loop.conditional.type = cudaGraphCondTypeWhile;
  loop.conditional.size = 1;
  cudaGraphNode_t node = nullptr;
  check_cuda(cudaGraphAddNode(&node, graph, before, edges, count, &loop), what);
  check_cuda(cudaStreamBeginCaptureToGraph(body_stream, loop.conditional.phGraph_out[0], nullptr, nullptr, 0,
                                           cudaStreamCaptureModeThreadLocal),
             what);
  cudaGraph_t body_graph = nullptr;
  try {
    body();
    set_loop_condition<<<1, 1, 0, body_stream>>>(condition, go_on);
    check_cuda(cudaGetLastError(), what);
  } catch (...) {
    cudaStreamEndCapture(body_stream, &body_graph);  // the exception that is under way is what is reported
    throw;
  }
  check_cuda(cudaStreamEndCapture(body_stream, &body_graph), what);
  check_cuda(cudaStreamUpdateCaptureDependencies(stream, &node, nullptr, 1, cudaStreamSetCaptureDependencies),
             what);
}
#endif

}  // namespace

CudaStatus cuda_status() {
  int count = 0;
  const cudaError_t status = cudaGetDeviceCount(&count);
  if (status != cudaSuccess) {
    cudaGetLastError();
    return {false, std::string("CUDA is not usable: ") + cudaGetErrorString(status)};
  }
  if (count == 0) return {false, "there is no CUDA device"};
  return {true, ""};
}

/// A stream whose kernels go before those of streams of a lower precedence.
void* CudaExec::make_stream() const {
  int lowest = 0, highest = 0;
  check_cuda(cudaDeviceGetStreamPriorityRange(&lowest, &highest), "asking for the priorities of streams");
  cudaStream_t stream = nullptr;
  check_cuda(cudaStreamCreateWithPriority(&stream, cudaStreamNonBlocking,
                                          precedence_ == Precedence::first ? highest : lowest),
             "making a stream");
  return stream;
}

CudaExec::CudaExec(Precedence precedence) : precedence_(precedence) {
  stream_ = make_stream();
  copy_stream_ = make_stream();
  cudaEvent_t event = nullptr;
  check_cuda(cudaEventCreateWithFlags(&event, cudaEventDisableTiming), "making an event");
  before_copy_ = event;
  reduction_word_ = static_cast<long long*>(allocate(sizeof(long long)));
  reduction_host_ = static_cast<long long*>(allocate_host(sizeof(long long)));
}

CudaExec::~CudaExec() {
  release(reduction_word_, sizeof(long long));
  release_host(reduction_host_);
  log_failure(cudaEventDestroy(as_event(before_copy_)), "ending an event");
  log_failure(cudaStreamDestroy(as_stream(copy_stream_)), "ending the stream for copies");
  log_failure(cudaStreamDestroy(as_stream(stream_)), "ending a stream");
}

std::string CudaExec::device_name() const {
  int device = 0;
  cudaDeviceProp properties;
  check_cuda(cudaGetDevice(&device), "asking for the device");
  check_cuda(cudaGetDeviceProperties(&properties, device), "asking for the device's properties");
  return properties.name;
}

std::size_t CudaExec::memory_available() const {
  std::size_t available = 0, total = 0;
  check_cuda(cudaMemGetInfo(&available, &total), "asking for memory");
  return available;
}

void* CudaExec::allocate_memory(std::size_t bytes) {
  void* memory = nullptr;
  const cudaError_t status = cudaMalloc(&memory, bytes ? bytes : 1);
  if (status == cudaErrorMemoryAllocation) {
    cudaGetLastError();
    throw ConfigError("no memory on the GPU for " + std::to_string(bytes) + " bytes");
  }
  check_cuda(status, "allocation");
  return memory;
}

void CudaExec::free_memory(void* memory) noexcept { log_failure(cudaFree(memory), "releasing memory"); }

void* CudaExec::allocate_host(std::size_t bytes) {
  void* memory = nullptr;
  const cudaError_t status = cudaMallocHost(&memory, bytes ? bytes : 1);
  if (status == cudaErrorMemoryAllocation) {
    cudaGetLastError();
    throw ConfigError("no pinned memory for " + std::to_string(bytes) + " bytes");
  }
  check_cuda(status, "allocation of pinned memory");
  return memory;
}

void CudaExec::release_host(void* memory) noexcept {
  log_failure(cudaFreeHost(memory), "releasing pinned memory");
}

void CudaExec::set_zero(void* memory, std::size_t bytes) {
  check_cuda(cudaMemsetAsync(memory, 0, bytes, as_stream(stream_)), "clearing memory");
}

void CudaExec::copy(void* to, const void* from, std::size_t bytes) {
  check_cuda(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToDevice, as_stream(stream_)), "copy");
}

void CudaExec::upload(void* to, const void* from, std::size_t bytes) {
  check_cuda(cudaMemcpyAsync(to, from, bytes, cudaMemcpyHostToDevice, as_stream(stream_)), "upload");
  synchronise();
}

void CudaExec::download(void* to, const void* from, std::size_t bytes) {
  check_cuda(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToHost, as_stream(stream_)), "download");
  synchronise();
}

std::unique_ptr<HostCopy> CudaExec::start_download(void* to, const void* from, std::size_t bytes) {
  auto copy = std::make_unique<CudaCopy>(as_stream(copy_stream_));
  check_cuda(cudaEventRecord(as_event(before_copy_), as_stream(stream_)), "marking what a copy waits for");
  check_cuda(cudaStreamWaitEvent(as_stream(copy_stream_), as_event(before_copy_), 0),
             "a copy's wait for work");
  copy->start(to, from, bytes);
  return copy;
}

void CudaExec::wait_on_device_for(const HostCopy& copy) {
  check_cuda(cudaStreamWaitEvent(as_stream(stream_), static_cast<const CudaCopy&>(copy).done(), 0),
             "waiting for a copy on the device");
}

void CudaExec::synchronise() {
  check_cuda(cudaStreamSynchronize(as_stream(stream_)), "waiting for the device");
}

std::unique_ptr<Recording> CudaExec::record(const std::function<void()>& work) {
  return std::make_unique<GraphRecording>(as_stream(stream_), work);
}

bool CudaExec::can_record_loops() const { return CUDART_VERSION >= 13000; }

void CudaExec::repeat_while(const long long* go_on, const std::function<void()>& body) {
#if CUDART_VERSION >= 13000
  cudaStreamCaptureStatus status;
  check_cuda(cudaStreamIsCapturing(as_stream(stream_), &status), "asking whether work is recorded");
  if (status == cudaStreamCaptureStatusActive) {
    cudaStream_t inner = as_stream(make_stream());  // each nested loop needs another one
    void* const outer = std::exchange(stream_, inner);
    try {
      add_while_node(as_stream(outer), inner, go_on, body);
    } catch (...) {
      stream_ = outer;
      log_failure(cudaStreamDestroy(inner), "ending a stream");
      throw;
    }
    stream_ = outer;
    check_cuda(cudaStreamDestroy(inner), "ending a stream");
    return;
  }
#endif
  Exec::repeat_while(go_on, body);
}

namespace {
int limit_of_device(cudaDeviceAttr what) {
  int device = 0, value = 0;
  check_cuda(cudaGetDevice(&device), "asking for the device");
  check_cuda(cudaDeviceGetAttribute(&value, what, device), "asking for the device's limits");
  return value;
}
}  // namespace

std::size_t CudaExec::shared_memory_of_a_block() const {
  return static_cast<std::size_t>(limit_of_device(cudaDevAttrMaxSharedMemoryPerBlockOptin));
}

std::size_t CudaExec::memory_for_lines() const {
  // Cooperative kernels in graphs, with __grid_constant__ parameters, need at least these versions.
  if (CUDART_VERSION < 12000 || limit_of_device(cudaDevAttrComputeCapabilityMajor) < 7 ||
      !limit_of_device(cudaDevAttrCooperativeLaunch))
    return 0;
  return shared_memory_of_a_block();
}

long long CudaExec::read_reduction_word() {
  download(reduction_host_, reduction_word_, sizeof(long long));
  return *reduction_host_;
}

}  // namespace desert_sim
