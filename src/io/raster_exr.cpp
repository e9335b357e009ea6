/// EXR files, which OpenCV writes, and reads where GDAL has no driver for them.
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "src/core/error.hpp"
#include "src/core/files.hpp"
#include "src/core/input_file.hpp"
#include "src/io/raster_file.hpp"
#include "src/io/raster_geometry.hpp"

namespace desert_sim {

namespace {

/// Width and height by the header of an EXR file: magic number, version, then attributes (name, type, size,
/// value) until an empty name (https://openexr.com/en/latest/OpenEXRFileLayout.html). OpenCV would only tell
/// them after it has decoded all pixels.
void read_exr_size(const InputFile& file, std::int64_t& width, std::int64_t& height) {
  std::string bytes(1 << 16, '\0');
  bytes.resize(file.read(0, bytes.data(), bytes.size()));
  const auto fail = [&file] { throw_raster_error(file.path(), "is not an EXR file that can be read"); };
  if (bytes.compare(0, 4, "\x76\x2f\x31\x01") != 0) fail();
  for (std::size_t at = 8; at < bytes.size() && bytes[at] != '\0';) {
    const std::string name(bytes.c_str() + at);
    const std::size_t type = at + name.size() + 1;
    if (type >= bytes.size()) fail();
    const std::size_t size_at = type + std::strlen(bytes.c_str() + type) + 1;
    std::uint32_t size = 0;
    std::int32_t window[4];  // x and y of the first pixel, then of the last one
    if (size_at + sizeof size + sizeof window > bytes.size()) fail();
    std::memcpy(&size, bytes.data() + size_at, sizeof size);
    at = size_at + sizeof size;
    if (name == "dataWindow") {
      std::memcpy(window, bytes.data() + at, sizeof window);
      width = std::int64_t{window[2]} - window[0] + 1;
      height = std::int64_t{window[3]} - window[1] + 1;
      return;
    }
    at += size;
  }
  fail();
}

/// OpenCV reads this variable once, at its first EXR file.
void let_opencv_have_exr() {
  static std::once_flag once;
  std::call_once(once, [] { setenv("OPENCV_IO_ENABLE_OPENEXR", "1", 0); });
}

class ExrFile final : public RasterFile {
 public:
  ExrFile(const std::string& path, const RasterOptions& options, const RasterAccess& access)
      : RasterFile(path, options), file_(path, access.folder) {
    std::int64_t width = 0, height = 0;
    read_exr_size(file_, width, height);
    check_raster_shape(path, width, height, most_channels, options.band);
    header_.width = static_cast<int>(width);
    header_.height = static_cast<int>(height);
    set_geotransform(header_, default_geotransform(header_.height));
  }

 private:
  static constexpr int most_channels = 4;

  /// Decodes the picture; a band that it lacks is only known then.
  void decode() {
    let_opencv_have_exr();
    try {
      picture_ = cv::imread(file_.descriptor_path(), cv::IMREAD_UNCHANGED);
    } catch (const cv::Exception& error) {
      throw_raster_error(path(), "OpenCV cannot read this EXR file: " + error.err);
    }
    if (picture_.empty()) throw_raster_error(path(), "is not an EXR file that OpenCV can read");
    check_raster_shape(path(), picture_.cols, picture_.rows, picture_.channels(), options_.band);
    if (picture_.cols != header_.width || picture_.rows != header_.height)
      throw_raster_error(
          path(), concatenate("has ", picture_.cols, " x ", picture_.rows, " pixels, but its header says ",
                              header_.width, " x ", header_.height));
  }

  void prepare() override {
    if (options_.encoding == RasterEncoding::terrarium || options_.encoding == RasterEncoding::mapbox)
      throw_raster_error(path(), "cannot be of that encoding, which pictures of bytes have");
  }

  void read_row(int row, int x, int width, double* raw, unsigned char*) override {
    if (picture_.empty()) decode();
    const int channels = picture_.channels();
    // OpenCV orders the channels B, G, R, A.
    const int channel = channels >= 3 && options_.band <= 3 ? 3 - options_.band : options_.band - 1;
    cv::Mat numbers;
    picture_.row(header_.height - 1 - row).convertTo(numbers, CV_64F);
    for (int i = 0; i < width; ++i) raw[i] = numbers.ptr<double>(0)[(x + i) * channels + channel];
  }

  double bytes_besides() const override {
    return static_cast<double>(header_.width) * header_.height * most_channels * sizeof(float);
  }

  const InputFile file_;
  cv::Mat picture_;
};

}  // namespace

void write_exr(const std::string& path, const Raster& raster) {
  let_opencv_have_exr();
  const cv::Mat view(raster.height, raster.width, CV_32F,
                     const_cast<float*>(raster.values.data()));  // not written to
  cv::Mat picture;
  cv::flip(view, picture, 0);
  if (!cv::haveImageWriter("a.exr")) throw_raster_error(path, "this OpenCV does not write EXR files");
  std::vector<unsigned char> bytes;
  std::string reason;
  try {
    if (cv::imencode(".exr", picture, bytes, {cv::IMWRITE_EXR_TYPE, cv::IMWRITE_EXR_TYPE_FLOAT}))
      return write_file(path, std::string(bytes.begin(), bytes.end()));
  } catch (const cv::Exception& error) {
    reason = ": " + error.err;
  }
  throw WriteError(path + ": OpenCV cannot make an EXR file in the folder of temporary files" + reason);
}

std::unique_ptr<RasterFile> open_exr(const std::string& path, const RasterOptions& options,
                                     const RasterAccess& access) {
  return std::make_unique<ExrFile>(path, options, access);
}

}  // namespace desert_sim
