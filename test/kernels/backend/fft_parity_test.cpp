/// Transforms by lines: the same bits on the CPU and on the GPU.
#include <cmath>
#include <cstring>
#include <vector>

#include "kernels/backend/buffer.hpp"
#include "kernels/backend/fft.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

using Values = std::vector<Complex>;

class FftParity : public test::OnBoth {
 protected:
  static Values transformed(Exec& exec, int width, int height, int fields, FftMethod method, bool inverse,
                            const Values& values) {
    const auto fft = exec.make_fft(width, height, fields, method);
    Buffer<Complex> buffer(exec, values.size());
    buffer.upload(values);
    if (inverse)
      fft->inverse(buffer.data());
    else
      fft->forward(buffer.data());
    exec.synchronise();
    return buffer.download();
  }
};

TEST_F(FftParity, HasTheSameBits) {
  struct Case {
    int width, height, fields;
  };
  // Lines of each length class of the GPU's blocks, of prime lengths and of their products, single ones, and
  // more columns than fit into whole blocks.
  for (const Case& c : {Case{64, 48, 1}, Case{360, 360, 2}, Case{301, 130, 1}, Case{97, 83, 3},
                        Case{1, 40, 1}, Case{40, 1, 1}, Case{513, 20, 1}, Case{1021, 34, 1},
                        Case{36, 2048, 1}, Case{4096, 12, 2}, Case{18, 4095, 1}, Case{30, 4093, 1}})
    for (const FftMethod method :
         {FftMethod::rows_first, FftMethod::mirrored_rows_first, FftMethod::columns_first})
      for (const bool inverse : {false, true}) {
        const bool mirrored = method == FftMethod::mirrored_rows_first;
        if (mirrored && c.height % 2 != 0) continue;
        SCOPED_TRACE(testing::Message() << c.width << " x " << c.height << ", method "
                                        << static_cast<int>(method) << (inverse ? ", inverse" : ""));
        Values values(static_cast<std::size_t>(c.width) * c.height * c.fields);
        for (std::size_t n = 0; n < values.size(); ++n)
          values[n] = {std::sin(0.7f * static_cast<float>(n)),
                       std::cos(0.3f * static_cast<float>(n % 10007))};
        const Values host = transformed(cpu(), c.width, c.height, c.fields, method, inverse, values),
                     device = transformed(cuda(), c.width, c.height, c.fields, method, inverse, values);
        // Of mirrored rows the inverse transform gives the first half alone.
        const std::size_t field = static_cast<std::size_t>(c.width) * c.height,
                          wanted = mirrored && inverse ? field / 2 : field;
        for (int n = 0; n < c.fields; ++n)
          EXPECT_EQ(std::memcmp(host.data() + n * field, device.data() + n * field, sizeof(Complex) * wanted),
                    0)
              << "field " << n;
      }
}

}  // namespace
}  // namespace desert_sim
