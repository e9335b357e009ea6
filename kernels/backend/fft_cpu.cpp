/// Fourier transforms on the CPU.
#include <fftw3.h>
#include <omp.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <vector>

#include "kernels/backend/fft.hpp"
#include "kernels/backend/for_each_cpu.hpp"
#include "kernels/backend/line_transform.hpp"
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
/// threads may add in another order, and the hash of a run must not depend on that. The wind's grid is
/// coarse, so this costs little.
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

// ---- lines beside each other ----

/// Lines that are transformed beside each other, as the lanes of vectors.
constexpr int lanes = 16;

/// Where value i of a lane begins. A butterfly's values are a power of two apart: without the gaps, all of
/// them would compete for a few places of the cache.
DESERT_HD int place(int i) { return (i + (i >> 5)) * lanes; }

/// Value i of a lane, as real and imaginary parts in memory of their own.
struct Lane {
  float *re, *im;
  DESERT_HD Complex get(int i) const { return {re[place(i)], im[place(i)]}; }
  DESERT_HD void set(int i, Complex value) const {
    re[place(i)] = value.re;
    im[place(i)] = value.im;
  }
};

/// `lanes` lines of up to `longest` values, and room for those of the next stage.
class LineBlock {
 public:
  explicit LineBlock(int longest) : half_(static_cast<std::size_t>(place(longest + 8))), memory_(4 * half_) {}

  DESERT_HD Lane lane(int n, bool next = false) {
    float* const re = memory_.data() + (next != swapped_ ? 2 * half_ : 0) + n;
    return {re, re + half_};
  }
  /// Values `half` … 2 half − 1 of each line become the mirror image of its first half.
  DESERT_HD void mirror(int half) {
    const Lane lines = lane(0);
    for (int i = 0; i < half; ++i)
      for (float* const part : {lines.re, lines.im})
        std::copy_n(part + place(i), lanes, part + place(2 * half - 1 - i));
  }
  DESERT_HD void transform(const LineTransform& transform, const Complex* roots) {
    for (int s = 0; s < transform.count; ++s) {
      const LineTransform::Stage& stage = transform.stages[s];
      const Lane in = lane(0), out = lane(0, true);
      transform.with_radix(stage, [&](auto radix, auto turned) DESERT_INLINE {
        for (int b = 0; b < transform.length / radix; ++b) {
          const LineTransform::Butterfly<radix> butterfly(transform, stage, b, roots);
#pragma omp simd
          for (int n = 0; n < lanes; ++n)
            run<turned>(butterfly, Lane{in.re + n, in.im + n}, Lane{out.re + n, out.im + n});
        }
      });
      swapped_ = !swapped_;
    }
  }

 private:
  /// A function of its own, because what is declared in a loop over lanes is not kept in registers.
  template <bool turned, int radix>
  DESERT_HD static void run(const LineTransform::Butterfly<radix>& butterfly, Lane in, Lane out) {
    Complex v[radix];
    unrolled<radix>([&](auto q) DESERT_INLINE { v[q] = in.get(butterfly.from + q * butterfly.from_stride); });
    butterfly.template run<turned>(v);
    unrolled<radix>([&](auto q) DESERT_INLINE { out.set(butterfly.to + q * butterfly.to_stride, v[q]); });
  }

  std::size_t half_;
  std::vector<float> memory_;
  bool swapped_ = false;
};

/// All lines along one axis, by all threads. The arithmetic of a line does not depend on which thread has it,
/// nor on its lane, so that the bits do not depend on the number of threads.
class LinesTransform final : public Fft {
 public:
  LinesTransform(int width, int height, int fields, bool mirrored_rows, int threads)
      : width_(width),
        height_(height),
        fields_(fields),
        distinct_rows_(mirrored_rows ? height / 2 : height),
        threads_(threads),
        along_x_(LineTransform::for_length(width)),
        along_y_(LineTransform::for_length(height)),
        roots_x_(along_x_.roots()),
        roots_y_(along_y_.roots()) {}

  void forward(Complex* values) override {
    pass(values, false, along_x_, roots_x_, {distinct_rows_, width_, 1, width_, width_});
    pass(values, false, along_y_, roots_y_, {width_, 1, width_, distinct_rows_, height_});
  }
  /// A forward transform of values whose real and imaginary parts are exchanged.
  void inverse(Complex* values) override {
    pass(values, true, along_y_, roots_y_, {width_, 1, width_, height_, distinct_rows_});
    pass(values, true, along_x_, roots_x_, {distinct_rows_, width_, 1, width_, width_});
  }
  int rows_given() const override { return distinct_rows_; }

 private:
  struct Lines {
    int count;
    int from_line, from_value;  ///< distances in memory from a line, and from a value, to the next
    int given, wanted;          ///< values of a line: those after `given` mirror these
  };
  void pass(Complex* values, bool exchanged, const LineTransform& law, const std::vector<Complex>& roots,
            const Lines& lines) const {
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

  int width_, height_, fields_, distinct_rows_, threads_;
  LineTransform along_x_, along_y_;
  std::vector<Complex> roots_x_, roots_y_;
};

}  // namespace

std::unique_ptr<Fft> CpuExec::make_fft(int width, int height, int fields, FftMethod method) {
  if (method == FftMethod::library || !LineTransform::supports_length(width) ||
      !LineTransform::supports_length(height))
    return std::make_unique<FftwTransform>(width, height, fields, threads_);
  const bool mirrored = method == FftMethod::lines_of_mirrored_rows;
  return std::make_unique<LinesTransform>(width, height, fields, mirrored, threads_);
}

}  // namespace desert_sim
