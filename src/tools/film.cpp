#include "src/tools/film.hpp"

#include <cstdio>
#include <filesystem>

#include "src/core/error.hpp"
#include "src/core/files.hpp"
#include "src/core/lower_case.hpp"
#include "src/tools/outputs.hpp"
#if DESERT_WITH_IO
#include "src/io/picture.hpp"
#endif

namespace desert_sim {

namespace {

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

std::string frame_name(int number) {
  char name[32];
  std::snprintf(name, sizeof name, "frame_%06d.png", number);
  return name;
}

#if DESERT_WITH_IO
constexpr bool has_pictures = true;

void write_picture(const std::string& path, const render::Picture& picture) {
  write_png(path, bgr_of(picture));
}
#else
constexpr bool has_pictures = false;

void write_picture(const std::string&, const render::Picture&) {}
#endif

/// A folder's name has no extension that films and pictures have elsewhere.
void require_kind_that_is_made(const std::string& path) {
  const std::string extension = lower_case(std::filesystem::path(path).extension().string());
  for (const char* other : {".gif", ".avi", ".mov", ".mkv", ".webm", ".m4v", ".mpg", ".mpeg", ".wmv", ".ogv",
                            ".apng", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp", ".webp", ".svg", ".pdf"})
    if (extension == other)
      throw ConfigError("--film " + path + ": " + other +
                        " is not made here (allowed: .mp4, .png, or a folder for the pictures)");
  for (const char* right : {".mp4", ".png"})
    if (extension == right && !ends_with(path, right))
      throw ConfigError("--film " + path + ": write the extension as " + right);
}

}  // namespace

bool Film::is_picture(const std::string& path) { return ends_with(path, ".png"); }

Film::Film(const std::string& path, const ViewParameters& view)
    : path_((require_kind_that_is_made(path), path)),
      kind_(ends_with(path, ".mp4") ? Kind::film : (is_picture(path) ? Kind::picture : Kind::folder)),
      view_(view) {
  if (!has_pictures && kind_ != Kind::film)
    throw ConfigError("--film " + path +
                      ": this build writes no pictures: it was made without OpenCV (allowed: .mp4)");
  if (kind_ == Kind::picture) require_writable_file(path);
  if (kind_ == Kind::folder) create_output_folder(path, "--film", frame_name(0));
  if (kind_ == Kind::film) start_encoder(view);
}

void Film::start_encoder(const ViewParameters& view) {
  if (view.width % 2 != 0 || view.height % 2 != 0)
    throw ConfigError("--view: a film of " + std::to_string(view.width) + " x " +
                      std::to_string(view.height) + " pixels cannot be made (allowed: even numbers)");
  file_ = std::make_unique<TemporaryFile>(path_);
  const std::string size = std::to_string(view.width) + "x" + std::to_string(view.height);
  encoder_ =
      std::make_unique<ChildProcess>("--film " + path_,
                                     std::vector<std::string>{"ffmpeg",
                                                              "-loglevel",
                                                              "error",
                                                              "-xerror",
                                                              "-y",
                                                              "-f",
                                                              "rawvideo",
                                                              "-pixel_format",
                                                              "rgba",
                                                              "-video_size",
                                                              size,
                                                              "-framerate",
                                                              std::to_string(view.fps),
                                                              "-i",
                                                              "-",
                                                              "-pix_fmt",
                                                              "yuv420p",
                                                              "-movflags",
                                                              "+faststart",
                                                              "-f",
                                                              "mp4",
                                                              path_for_children(file_->library_path())},
                                     ChildProcess::Input::piped);
}

void Film::add(Simulation& simulation) {
  // Where the camera stands and how much it exaggerates follows from the first state, for one picture, too.
  if (kind_ == Kind::picture && frames_ > 0) return;
  const render::Picture picture = view_.draw(simulation);
  if (kind_ == Kind::film) encoder_->write(picture.pixels.data(), 4 * picture.pixels.size());
  if (kind_ == Kind::folder) write_picture(path_ + "/" + frame_name(frames_), picture);
  ++frames_;
}

void Film::finish(Simulation& simulation) {
  if (kind_ == Kind::picture) write_picture(path_, view_.draw(simulation));
  if (kind_ != Kind::film) return;
  encoder_->finish();
  file_->publish();
}

}  // namespace desert_sim
