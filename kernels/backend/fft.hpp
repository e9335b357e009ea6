#pragma once
/// The one small interface to FFTW3 (CPU) and cuFFT (GPU). Kernels that transform short lines by themselves do
/// not need it (line_transform.hpp).

#include <cstddef>

namespace desert_sim {

/// Layout-compatible with fftwf_complex and cufftComplex.
struct alignas(8) Complex {
  float re, im;
};

class Fft {
 public:
  virtual ~Fft() = default;
  /// X̂(k) = Σ x e^(−2πi k·n/N), in place on device memory of width × height values; of as many fields as it
  /// was made for, one behind the other.
  virtual void forward(Complex* values) = 0;
  /// x = Σ X̂ e^(+2πi k·n/N), without the factor 1/N.
  virtual void inverse(Complex* values) = 0;
  /// Device memory that it works in besides the values.
  virtual std::size_t bytes() const { return 0; }
};

}  // namespace desert_sim
