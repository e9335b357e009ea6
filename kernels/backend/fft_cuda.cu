/// Fourier transforms on the GPU.
#include <cufft.h>

#include <string>

#include "kernels/backend/buffer.hpp"
#include "kernels/backend/fft.hpp"
#include "kernels/backend/for_each_cuda.cuh"
#include "kernels/backend/lines_fft.hpp"
#include "src/core/error.hpp"

namespace desert_sim {

namespace {

// ---- cuFFT ----

void check_cufft(cufftResult status, const char* what) {
  if (status != CUFFT_SUCCESS)
    throw CudaError(std::string("cuFFT: ") + what + ": error " + std::to_string(status));
}

class CufftTransform final : public Fft {
 public:
  CufftTransform(cudaStream_t stream, int width, int height, int fields) : height_(height) {
    int size[] = {height, width};
    const int values = width * height;
    check_cufft(cufftPlanMany(&plan_, 2, size, nullptr, 1, values, nullptr, 1, values, CUFFT_C2C, fields),
                "plan");
    check_cufft(cufftSetStream(plan_, stream), "stream");
  }
  ~CufftTransform() override { cufftDestroy(plan_); }
  void forward(Complex* values) override { execute(values, CUFFT_FORWARD); }
  void inverse(Complex* values) override { execute(values, CUFFT_INVERSE); }
  int rows_given() const override { return height_; }
  std::size_t bytes() const override {
    std::size_t bytes = 0;
    check_cufft(cufftGetSize(plan_, &bytes), "size");
    return bytes;
  }

 private:
  void execute(Complex* values, int direction) {
    auto* v = reinterpret_cast<cufftComplex*>(values);
    check_cufft(cufftExecC2C(plan_, v, v, direction), "transform");
  }
  int height_;
  cufftHandle plan_ = 0;
};

// ---- lines ----

/// All lines along one axis. A thread block has `teams` teams of threads, each of which transforms
/// `lines_per_team` lines, one after the other. A stage reads one place of shared memory and writes another,
/// so that a team has one place more than lines. Numbers of teams, lines and threads are powers of two.
struct LinesPass {
  LineTransform law;
  const Complex* roots;
  Complex* values;
  int field_values;           ///< from a field to the next
  bool exchanged;             ///< real and imaginary parts, for an inverse transform
  int count;                  ///< of lines
  int from_line, from_value;  ///< distances in memory from a line, and from a value, to the next
  int given, wanted;          ///< values of a line: those after `given` mirror these
  int teams, lines_per_team;

  __host__ __device__ int team_size() const {
    return law.length <= 512 ? 64 : law.length <= 1024 ? 128 : 256;
  }
  __host__ __device__ int lines_per_block() const { return teams * lines_per_team; }
  __host__ __device__ int places() const { return lines_per_team + 1; }
  std::size_t shared_bytes() const {
    return sizeof(Complex) * static_cast<std::size_t>(teams * places()) *
           static_cast<std::size_t>(law.length);
  }
};

extern __shared__ Complex shared_lines[];

/// A line in shared memory, as LineTransform::PrimeButterfly asks for it.
struct SharedLine {
  Complex* values;
  __device__ Complex get(int i) const { return values[i]; }
  __device__ void set(int i, Complex value) const { values[i] = value; }
};

/// A stage of one line by a team; all teams of a block call it together.
__device__ void transform_stage(const LinesPass& p, const LineTransform::Stage& stage, SharedLine in,
                                SharedLine out, int thread) {
  const LineTransform& law = p.law;
  const int threads = p.team_size();
  if (stage.in_registers()) return law.butterflies(stage, thread, threads, p.roots, in.values, out.values);
  const int pairs = (stage.radix - 1) / 2, butterflies = law.length / stage.radix;
  for (int n = thread; n < pairs * butterflies; n += threads)
    LineTransform::PrimeButterfly(law, stage, n % butterflies).fold(1 + n / butterflies, p.roots, in);
  __syncthreads();
  for (int n = thread; n < (pairs + 1) * butterflies; n += threads)
    LineTransform::PrimeButterfly(law, stage, n % butterflies).modes(n / butterflies, p.roots, in, out);
}

/// The lines of a team begin in its first places. In each stage the line before the free place moves there,
/// then the line before that one into the place that it left, and so on: after n stages line l lies in the
/// place l + n modulo their number.
__device__ void transform_lines(const LinesPass& p, Complex* team_lines, int thread) {
  const auto line = [&](int place) { return SharedLine{team_lines + place * p.law.length}; };
  int free = p.lines_per_team;
  for (int s = 0; s < p.law.count; ++s)
    for (int n = 0; n < p.lines_per_team; ++n) {
      const int from = free > 0 ? free - 1 : p.lines_per_team;
      transform_stage(p, p.law.stages[s], line(from), line(free), thread);
      free = from;
      __syncthreads();
    }
}

/// Calls body(line, i) for `length` values of each line of the block. Adjacent threads have adjacent places
/// in memory (coalesced).
template <class Body>
__device__ void for_each_value(const LinesPass& p, int length, const Body& body) {
  const int lines = p.lines_per_block(), thread = static_cast<int>(threadIdx.x),
            threads = static_cast<int>(blockDim.x);
  if (p.from_value == 1) {
    for (int line = 0; line < lines; ++line)
      for (int i = thread; i < length; i += threads) body(line, i);
  } else {
    for (int i = thread / lines; i < length; i += threads / lines) body(thread % lines, i);
  }
}

__global__ void lines_kernel(const LinesPass p) {
  const int first = static_cast<int>(blockIdx.x) * p.lines_per_block(), length = p.law.length;
  Complex* const field = p.values + static_cast<std::ptrdiff_t>(blockIdx.y) * p.field_values;
  const auto shared_value = [&](int line, int i, int moved) -> Complex& {
    const int place = (line % p.lines_per_team + moved) % p.places();
    return shared_lines[(line / p.lines_per_team * p.places() + place) * length + i];
  };
  for_each_value(p, length, [&](int line, int i) {
    if (first + line >= p.count) return;
    const int value = i < p.given ? i : 2 * p.given - 1 - i;
    const Complex v = field[(first + line) * p.from_line + value * p.from_value];
    shared_value(line, i, 0) = p.exchanged ? swap_re_im(v) : v;
  });
  __syncthreads();
  const int size = p.team_size(), team = static_cast<int>(threadIdx.x) / size;
  transform_lines(p, shared_lines + team * p.places() * length, static_cast<int>(threadIdx.x) % size);
  for_each_value(p, p.wanted, [&](int line, int i) {
    if (first + line >= p.count) return;
    const Complex v = shared_value(line, i, p.law.count);
    field[(first + line) * p.from_line + i * p.from_value] = p.exchanged ? swap_re_im(v) : v;
  });
}

class LinesTransform final : public LinesFft {
 public:
  LinesTransform(CudaExec& exec, int width, int height, int fields, FftMethod method)
      : LinesFft(width, height, method),
        exec_(exec),
        fields_(fields),
        roots_x_(exec, static_cast<std::size_t>(width)),
        roots_y_(exec, static_cast<std::size_t>(height)) {
    roots_x_.upload(along_x_.roots());
    roots_y_.upload(along_y_.roots());
  }
  std::size_t bytes() const override { return roots_x_.bytes() + roots_y_.bytes(); }

 private:
  /// With several lines a block, because those of columns lie beside each other in memory.
  void pass(Complex* values, bool exchanged, const LineTransform& law, const Lines& along) override {
    LinesPass p{law,
                (&law == &along_x_ ? roots_x_ : roots_y_).data(),
                values,
                width_ * height_,
                exchanged,
                along.count,
                along.from_line,
                along.from_value,
                along.given,
                along.wanted,
                0,
                0};
    p.teams = p.law.length <= 512 ? 4 : p.law.length <= 1024 ? 2 : 1;
    p.lines_per_team = p.law.length <= 512 ? 2 : 4;
    while (p.shared_bytes() > exec_.shared_memory_of_a_block() && p.lines_per_block() > 1)
      (p.lines_per_team > 1 ? p.lines_per_team : p.teams) /= 2;
    // All that there is, because a simulation in another thread asks for the same kernel.
    check_cuda(cudaFuncSetAttribute(lines_kernel, cudaFuncAttributeMaxDynamicSharedMemorySize,
                                    static_cast<int>(exec_.shared_memory_of_a_block())),
               "asking for the shared memory of lines");
    const int lines = p.lines_per_block();
    lines_kernel<<<dim3((p.count + lines - 1) / lines, fields_), p.teams * p.team_size(), p.shared_bytes(),
                   cuda::stream(exec_)>>>(p);
    check_cuda(cudaGetLastError(), "launch of a transform by lines");
  }

  CudaExec& exec_;
  int fields_;
  Buffer<Complex> roots_x_, roots_y_;
};

}  // namespace

std::unique_ptr<Fft> CudaExec::make_fft(int width, int height, int fields, FftMethod method) {
  if (method == FftMethod::library)
    return std::make_unique<CufftTransform>(cuda::stream(*this), width, height, fields);
  return std::make_unique<LinesTransform>(*this, width, height, fields, method);
}

}  // namespace desert_sim
