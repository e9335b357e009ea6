// The coarse wind in one kernel against the same laws and lines, one after the other on the host.

#include <algorithm>
#include <cmath>

#include "kernels/wind/tuned/coarse_wind.hpp"
#include "kernels/wind/wind_laws.hpp"
#include "test/support/bench_terrain.hpp"
#include "test/support/lines.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

using Values = test::Line;

struct Axis {
  LineTransform transform;
  Values roots;
};

void transform_lines_of(Values& values, const Axis& axis, int lines, int from_line, int from_value) {
  Values line(static_cast<std::size_t>(axis.transform.length));
  for (int l = 0; l < lines; ++l) {
    const auto value = [&](std::size_t i) -> Complex& {
      return values[static_cast<std::size_t>(l * from_line) + i * static_cast<std::size_t>(from_value)];
    };
    for (std::size_t i = 0; i < line.size(); ++i) line[i] = value(i);
    const Values modes = test::transformed(axis.transform, axis.roots, line);
    for (std::size_t i = 0; i < modes.size(); ++i) value(i) = modes[i];
  }
}

class CoarseWind : public test::OnBoth {
 protected:
  /// What the GPU makes of the wind over `t`, and the host of the same workspace's laws.
  void expect_same(const test::BenchTerrain& on_cpu, const test::BenchTerrain& on_gpu,
                   const WindParameters& p) {
    const wind::Vector above{3, -4};
    wind::Workspace host = wind::make_workspace(on_cpu.exec(), on_cpu.grid(), p);
    wind::Workspace device = wind::make_workspace(on_gpu.exec(), on_gpu.grid(), p);
    ASSERT_TRUE(device.in_one_kernel)
        << "lines of " << device.coarse.width << " and " << device.coarse.height;
    with_backend(on_gpu.exec(), [&](auto& e) {
      wind::step(e, on_gpu.terrain.view(), p, {above, on_gpu.heights}, {}, device);
    });
    on_gpu.exec().synchronise();
    by_lines(on_cpu, p, above, device, host);
    const auto values = static_cast<std::size_t>(host.coarse.values());
    expect_same(host.warped, device.warped, values, "the warped wind");
    if (p.projection) expect_same(host.responses, device.responses, values, "the flux");
  }

 private:
  static void by_lines(const test::BenchTerrain& t, const WindParameters& p, wind::Vector above,
                       const wind::Workspace& lines, wind::Workspace& work) {
    const wind::CoarseGrid& coarse = work.coarse;
    const wind::CoarseLaws laws =
        wind::coarse_laws(t.terrain.view(), p, above, hypotenuse(above.x, above.y), work);
    const Axis x{lines.lines_along_x, lines.roots_x.download()},
        y{lines.lines_along_y, lines.roots_y.download()};
    const auto all = [](const Grid& g, const auto& law) {
      for (int j = 0; j < g.height; ++j)
        for (int i = 0; i < g.width; ++i) law(i, j);
    };
    const auto transform = [&](Complex* field, bool back) {
      Values values(field, field + coarse.values());
      const auto exchange = [&] {
        for (Complex& v : values) v = swap_re_im(v);
      };
      if (back) exchange();
      if (back) transform_lines_of(values, x, coarse.height, coarse.width, 1);
      transform_lines_of(values, y, coarse.width, 1, coarse.width);
      if (!back) transform_lines_of(values, x, coarse.height, coarse.width, 1);
      if (back) exchange();
      std::copy(values.begin(), values.end(), field);
    };
    const wind::CoarsenRows rows{coarse, t.heights.cell_heights.data(), 0.0f, work.row_means.data()};
    all(rows.grid(), rows);
    all(coarse.transformed(), laws.columns);
    if (laws.response.fields() > 0) {
      transform(work.spectrum.data(), false);
      all(laws.response.grid(), laws.response);
      for (int r = 0; r < laws.response.fields(); ++r)
        transform(work.responses.data() + r * coarse.values(), true);
    }
    all(coarse.transformed(), laws.warp);
    if (!laws.projected) return;
    transform(work.spectrum.data(), false);
    all(coarse.transformed(), laws.project);
    transform(work.responses.data(), true);
    if (!laws.mean.sums) return;
    work.mean_sums.set_zero();
    all(laws.mean.grid(), laws.mean);
  }
  static void expect_same(const Buffer<Complex>& a, const Buffer<Complex>& b, std::size_t count,
                          const char* what) {
    Values x = a.download(), y = b.download();
    ASSERT_EQ(x.size(), y.size());
    x.resize(count);
    int different = 0;
    double size = 0;
    for (std::size_t n = 0; n < x.size(); ++n) {
      if (x[n].re != y[n].re || x[n].im != y[n].im) ++different;
      size += std::abs(x[n].re) + std::abs(x[n].im);
    }
    EXPECT_EQ(different, 0) << what << ", of " << x.size();
    EXPECT_TRUE(std::isfinite(size)) << what;
  }
};

TEST_F(CoarseWind, IsBitForBitThatOfLinesOneAfterTheOther) {
  if (cuda().memory_for_lines() < 100000) GTEST_SKIP() << "this GPU has the library's transforms";
  struct Case {
    int width, height, coarsening;
    bool periodic, warping, projection;
    int radii;
  };
  for (const SpeedUpLaw law : {SpeedUpLaw::jackson_hunt, SpeedUpLaw::venturi})
    for (const Case& c : {Case{180, 64, 1, true, true, true, 2}, Case{90, 75, 1, false, true, true, 2},
                          Case{200, 300, 2, true, true, true, 4}, Case{128, 96, 0, true, true, true, 3},
                          Case{81, 125, 1, true, false, true, 2}, Case{162, 160, 1, true, true, false, 1},
                          Case{512, 45, 1, true, true, true, 1}, Case{2, 500, 1, true, true, true, 2}}) {
      SCOPED_TRACE(std::to_string(c.width) + " x " + std::to_string(c.height));
      WindParameters p;
      p.speedup_law = law;
      p.coarsening = c.coarsening;
      p.warping = c.warping;
      p.projection = c.projection;
      p.radii = ShortList{{50, 9, 20, 5}, c.radii};
      p.weights = ShortList{{0.5f, 0.2f, 0.2f, 0.1f}, c.radii};
      p.deflections = ShortList{{30, 5, 10, 3}, c.radii};
      test::BenchTerrain on_cpu(cpu(), c.width, c.height, 1, c.periodic),
          on_gpu(cuda(), c.width, c.height, 1, c.periodic);
      for (test::BenchTerrain* t : {&on_cpu, &on_gpu}) {
        t->set(Layer::bedrock, [](int x, int y) {
          return 5 * std::sin(0.3 * x) * std::cos(0.2 * y) + 0.01 * ((x * 7 + y * 13) % 31);
        });
        t->surface();
      }
      expect_same(on_cpu, on_gpu, p);
    }
}

}  // namespace
}  // namespace desert_sim
