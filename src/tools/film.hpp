#pragma once
/// Films and pictures of a run: desert_run --film.

#include <memory>
#include <string>

#include "src/core/temporary_file.hpp"
#include "src/tools/child_process.hpp"
#include "src/tools/oblique_view.hpp"

namespace desert_sim {

/// `path` names a film (.mp4, which takes ffmpeg), one picture (.png: that of the last state), or a folder,
/// which gets frame_000000.png, frame_000001.png …
class Film {
 public:
  /// Throws ConfigError if that cannot be written, or if ffmpeg is needed and missing.
  Film(const std::string& path, const ViewParameters& view);
  /// Whether a path names one picture.
  static bool is_picture(const std::string& path);
  /// Adds the present state, from the first one on. Throws ConfigError or WriteError.
  void add(Simulation& simulation);
  /// Writes what is left to write: the picture of the last state; a film appears under its name when it is
  /// complete.
  void finish(Simulation& simulation);

 private:
  enum class Kind { film, picture, folder };
  void start_encoder(const ViewParameters& view);

  const std::string path_;
  const Kind kind_;
  ObliqueView view_;
  int frames_ = 0;
  std::unique_ptr<TemporaryFile> file_;
  std::unique_ptr<ChildProcess> encoder_;
};

}  // namespace desert_sim
