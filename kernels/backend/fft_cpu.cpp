/// Fourier transforms on the CPU.
#include <fftw3.h>
#include <omp.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <vector>

#include "kernels/backend/fft.hpp"
#include "kernels/backend/for_each_cpu.hpp"
#include "kernels/backend/line_block.hpp"
#include "kernels/backend/lines_fft.hpp"
#include "src/core/error.hpp"

namespace desert_sim {

namespace {

// ---- FFTW ----

/// FFTW's planner is not thread-safe.
std::mutex& planner() {
  static std::mutex mutex;
  return mutex;
}

/// Transforms each field with one thread, however many the Exec has: FFTW's plans for other numbers of
/// threads may add in another order, and the hash of a run must not depend on that.
class FftwTransform final : public Fft {
 public:
  FftwTransform(int width, int height, int fields, int threads)
      : height_(height), values_(width * height), fields_(fields), threads_(threads) {
    const std::lock_guard<std::mutex> lock(planner());
    auto* memory = static_cast<fftwf_complex*>(fftwf_malloc(sizeof(fftwf_complex) * values_ * fields));
    if (!memory)
      throw ConfigError("no memory for a transform of " + std::to_string(width) + " x " +
                        std::to_string(height));
    const bool alike = fields == 1 || fftwf_alignment_of(memory[0]) == fftwf_alignment_of(memory[values_]);
    const unsigned flags = FFTW_ESTIMATE | (alike ? 0u : FFTW_UNALIGNED);
    forward_ = fftwf_plan_dft_2d(height, width, memory, memory, FFTW_FORWARD, flags);
    inverse_ = fftwf_plan_dft_2d(height, width, memory, memory, FFTW_BACKWARD, flags);
    fftwf_free(memory);
    if (!forward_ || !inverse_)
      throw Error("FFTW made no plan for " + std::to_string(width) + " x " + std::to_string(height));
  }
  ~FftwTransform() override {
    const std::lock_guard<std::mutex> lock(planner());
    fftwf_destroy_plan(forward_);
    fftwf_destroy_plan(inverse_);
  }
  void forward(Complex* values) override { execute(forward_, values); }
  void inverse(Complex* values) override { execute(inverse_, values); }
  int rows_given() const override { return height_; }

 private:
  void execute(fftwf_plan plan, Complex* values) const {
#pragma omp parallel for schedule(static) num_threads(threads_) if (fields_ > 1)
    for (int n = 0; n < fields_; ++n) {
      auto* v = reinterpret_cast<fftwf_complex*>(values + static_cast<std::ptrdiff_t>(n) * values_);
      fftwf_execute_dft(plan, v, v);
    }
  }
  int height_, values_, fields_, threads_;
  fftwf_plan forward_ = nullptr, inverse_ = nullptr;
};

// ---- lines ----

/// All lines along one axis, by all threads. The arithmetic of a line does not depend on which thread has it,
/// nor on its lane, so that the bits do not depend on the number of threads.
class LinesTransform final : public LinesFft {
 public:
  LinesTransform(int width, int height, int fields, FftMethod method, int threads)
      : LinesFft(width, height, method),
        fields_(fields),
        threads_(threads),
        roots_x_(along_x_.roots()),
        roots_y_(along_y_.roots()) {}

 private:
  void pass(Complex* values, bool exchanged, const LineTransform& law, const Lines& lines) override {
    const std::vector<Complex>& roots = &law == &along_x_ ? roots_x_ : roots_y_;
    const int blocks = (lines.count + lanes - 1) / lanes;
    WorkStealingRange all(threads_, blocks * fields_);
#pragma omp parallel num_threads(threads_) if (width_ * height_ >= min_parallel_cells)
    {
      LineBlock block(law.length);
      all.work([&](int n) {
        Complex* const field = values + static_cast<std::ptrdiff_t>(n / blocks) * width_ * height_;
        const int first = n % blocks * lanes, count = std::min(lanes, lines.count - first);
        Complex* const begin = field + static_cast<std::ptrdiff_t>(first) * lines.from_line;
        with_widest_instructions([&]() DESERT_INLINE {
          load(block, begin, exchanged, count, lines);
          if (lines.given < law.length) block.mirror(lines.given);
          block.transform(law, roots.data());
          store(block, begin, exchanged, count, lines);
        });
      });
    }
  }
  DESERT_HD static void load(LineBlock& block, const Complex* values, bool exchanged, int count,
                             const Lines& lines) {
    const Lane lane = exchanged_if(exchanged, block.lane(0));
    for_each_value(lines.given, count, lines, [=](int i, int n, int from) DESERT_INLINE {
      lane.re[place(i) + n] = values[from].re;
      lane.im[place(i) + n] = values[from].im;
    });
  }
  DESERT_HD static void store(LineBlock& block, Complex* values, bool exchanged, int count,
                              const Lines& lines) {
    const Lane lane = exchanged_if(exchanged, block.lane(0));
    for_each_value(lines.wanted, count, lines, [=](int i, int n, int to) DESERT_INLINE {
      values[to] = {lane.re[place(i) + n], lane.im[place(i) + n]};
    });
  }
  /// Calls body(i, n, place) for value i of line n, which lies at values[place]; neighbours in memory follow
  /// each other.
  template <class Body>
  DESERT_HD static void for_each_value(int length, int count, const Lines& lines, const Body& body) {
    if (lines.from_value == 1) {
      constexpr int cache_line = 64 / sizeof(Complex);
      for (int first = 0; first < length; first += cache_line)
        for (int n = 0; n < count; ++n)
          for (int i = first; i < std::min(first + cache_line, length); ++i)
            body(i, n, n * lines.from_line + i);
    } else if (count == lanes) {
      for (int i = 0; i < length; ++i) {
#pragma omp simd
        for (int n = 0; n < lanes; ++n) body(i, n, n + i * lines.from_value);
      }
    } else {
      for (int i = 0; i < length; ++i)
        for (int n = 0; n < count; ++n) body(i, n, n + i * lines.from_value);
    }
  }
  DESERT_HD static Lane exchanged_if(bool exchanged, Lane lane) {
    return exchanged ? Lane{lane.im, lane.re} : lane;
  }

  int fields_, threads_;
  std::vector<Complex> roots_x_, roots_y_;
};

}  // namespace

std::unique_ptr<Fft> CpuExec::make_fft(int width, int height, int fields, FftMethod method) {
  if (method == FftMethod::library) return std::make_unique<FftwTransform>(width, height, fields, threads_);
  return std::make_unique<LinesTransform>(width, height, fields, method, threads_);
}

}  // namespace desert_sim
