#pragma once
/// Interface to FFTW3 (CPU) and cuFFT (GPU). Kernels that transform short lines by themselves do not need it
/// (kernels/wind/tuned/line_transform.hpp).

#include <cstddef>

namespace desert_sim {

/// Layout-compatible with fftwf_complex and cufftComplex.
struct alignas(8) Complex {
  float re, im;
};

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
  /// Device memory of its work area, besides the values [bytes].
  virtual std::size_t bytes() const { return 0; }
};

}  // namespace desert_sim
