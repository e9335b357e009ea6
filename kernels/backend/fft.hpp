#pragma once
/// Two-dimensional Fourier transforms. Kernels that transform short lines by themselves do not need it
/// (kernels/backend/line_transform.hpp).

#include <cstddef>

namespace desert_sim {

/// Layout-compatible with fftwf_complex and cufftComplex.
struct alignas(8) Complex {
  float re, im;
};

/// library: FFTW on a CPU, cuFFT on a GPU, whose results differ in their last digits.
/// The others go line by line (LineTransform), with the same bits on all machines. The order of the axes is
/// that of a forward transform; the inverse has the other one.
/// mirrored_rows_first: the second half of the rows mirrors the first, as on a terrain that is open in the
/// north and south (row j is row height − 1 − j), and of an inverse transform only the first half is wanted.
enum class FftMethod { library, rows_first, mirrored_rows_first, columns_first };

/// The longest axis that is transformed by lines.
constexpr int longest_line = 4096;

/// The method for what enters the state of a simulation: `by_lines` where both axes are short enough. It does
/// not ask which machine this is.
constexpr FftMethod method_of_states(int width, int height, FftMethod by_lines) {
  return width <= longest_line && height <= longest_line ? by_lines : FftMethod::library;
}

class Fft {
 public:
  virtual ~Fft() = default;
  /// Forward transform, in place on device memory of width × height values for each field, one field after
  /// the other:
  ///
  ///   X̂(k) = Σ_n x(n) e^(−2πi k·n/N)
  virtual void forward(Complex* values) = 0;
  /// Inverse transform, without the factor 1/N:
  ///
  ///   x(n) = Σ_k X̂(k) e^(+2πi k·n/N)
  virtual void inverse(Complex* values) = 0;
  /// Rows that forward() reads, from the first on: all, or half of them where the others mirror these.
  virtual int rows_given() const = 0;
  /// Device memory of its work area, besides the values [bytes].
  virtual std::size_t bytes() const { return 0; }
};

}  // namespace desert_sim
