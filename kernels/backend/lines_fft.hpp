#pragma once
/// Two-dimensional transforms by lines: the passes along both axes, which are alike on a CPU and on a GPU.

#include "kernels/backend/fft.hpp"
#include "kernels/backend/line_transform.hpp"

namespace desert_sim {

class LinesFft : public Fft {
 public:
  LinesFft(int width, int height, FftMethod method)
      : width_(width),
        height_(height),
        along_x_(LineTransform::for_length(width)),
        along_y_(LineTransform::for_length(height)),
        distinct_rows_(method == FftMethod::mirrored_rows_first ? height / 2 : height),
        columns_first_(method == FftMethod::columns_first) {}

  void forward(Complex* values) final {
    if (columns_first_) columns(values, false, height_, height_);
    rows(values, false);
    if (!columns_first_) columns(values, false, distinct_rows_, height_);
  }
  /// A forward transform of values whose real and imaginary parts are exchanged.
  void inverse(Complex* values) final {
    if (!columns_first_) columns(values, true, height_, distinct_rows_);
    rows(values, true);
    if (columns_first_) columns(values, true, height_, height_);
  }
  int rows_given() const final { return distinct_rows_; }

 protected:
  /// Lines along an axis, as they lie in the memory of a field.
  struct Lines {
    int count;
    int from_line, from_value;  ///< distances in memory from a line, and from a value, to the next
    int given, wanted;          ///< values of a line: those after `given` mirror these
  };
  /// Transforms all lines of all fields. `exchanged`: real and imaginary parts, before and afterwards.
  virtual void pass(Complex* values, bool exchanged, const LineTransform& law, const Lines& lines) = 0;

  int width_, height_;
  LineTransform along_x_, along_y_;

 private:
  void rows(Complex* values, bool exchanged) {
    pass(values, exchanged, along_x_, {distinct_rows_, width_, 1, width_, width_});
  }
  void columns(Complex* values, bool exchanged, int given, int wanted) {
    pass(values, exchanged, along_y_, {width_, 1, width_, given, wanted});
  }

  int distinct_rows_;
  bool columns_first_;
};

}  // namespace desert_sim
